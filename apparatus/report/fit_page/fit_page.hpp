#pragma once

// A fit of a torque record as a page: readings and fitted line, residuals, flow curve or decay, parameters and how far
// they may be trusted.

#include <string>
#include <utility>
#include <vector>

#include "rheometer/fits/parameters.hpp"

namespace tremie::report {

/// report.html. `instrument`: the fit's; `record`: the file; `command` repeats the fit.
std::string fit_html(const FitResult& fit, const Instrument& instrument, const std::string& record,
                     const std::string& command);

/// The charts of that page as files, each a name and an SVG: torque.svg, residuals.svg, and of a flow curve flow_curve.svg,
/// of a decay flocculation.svg.
std::vector<std::pair<std::string, std::string>> fit_chart_files(const FitResult& fit,
                                                                 const Instrument& instrument);

/// Times [s] of a decay, speeds [rev/s] or shear rates [1/s] of a flow curve; the label of torque or shear stress.
std::vector<double> shown_x(const FitResult& fit);
std::string x_label(const FitResult& fit);
std::string y_label(const FitResult& fit);

/// "54.1 (53.2 to 55)", of so many digits.
std::string with_interval(const ParameterEstimate& estimate, int digits);

/// "Pa·sⁿ".
std::string unit_on_page(const FitParameter& parameter);

}  // namespace tremie::report
