#pragma once

// A fit of a torque record as a page, from plain data: readings and fitted line, residuals, flow curve or decay,
// parameters and how far they may be trusted.

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tremie::report {

struct FitParameter {
  std::string words, unit, key;     ///< "dynamic yield stress", "Pa", "yield_stress_Pa"
  std::optional<double> value;      ///< empty: not told by the record
  std::optional<double> low, high;  ///< 95 % interval
  bool given = false;               ///< by the user, not by the record
};

struct FitReport {
  std::string record;  ///< the file
  bool decay = false;  ///< torque over time at one speed; else over the speed
  std::string model;   ///< of the fitted line, in words
  std::vector<FitParameter> parameters;
  std::vector<double> x;                                 ///< [s] of a decay, [rev/s] of a flow curve
  std::vector<double> observed, fitted, standard_error;  ///< torque [N m]; the last may be empty
  std::vector<double> line_x, line;  ///< the fitted line at many speeds; empty: at those of the readings
  std::optional<double> plug_below;  ///< speed below which a plug stands at the container [rev/s]
  std::vector<double> rate, stress_observed, stress_fitted;  ///< at the vane [1/s], [Pa]; may be empty
  std::vector<double> lambda_apparent, lambda_line;          ///< over x, as read off the torque; may be empty
  double scatter = 0.0;                                      ///< relative standard deviation about the fit
  double correlation = 0.0;                                  ///< of successive residuals
  long readings = 0;
  std::vector<std::pair<std::string, long>> dropped;  ///< rows that were left out, by their reason
  bool law_in_doubt = false;  ///< another law describes the readings far better; a note tells which
  std::vector<std::string> notes, reasons;
  std::string command;  ///< repeats the fit
};

/// report.html.
std::string fit_html(const FitReport& fit);

/// The charts of that page as files, each a name and an SVG: torque.svg, residuals.svg, and of a flow curve flow_curve.svg,
/// of a decay flocculation.svg.
std::vector<std::pair<std::string, std::string>> fit_chart_files(const FitReport& fit);

}  // namespace tremie::report
