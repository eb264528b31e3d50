#pragma once

// What the fit of a flow curve and of a torque decay share. Private to rheometer/.

#include <span>

#include "rheometer/fits/fit.hpp"
#include "rheometer/regression/least_squares.hpp"

namespace tremie::fitting {

/// Readings in ascending x; where a record has very many rows, each is the mean of its neighbours.
struct Readings {
  std::vector<double> x, torque, count;
  std::vector<double> variance;  ///< of the rows about their mean [(N m)^2]; 0 for a single row
  std::vector<long> line;        ///< of the first row of each

  std::size_t size() const { return x.size(); }
  void push(double x_value, double torque_value, double rows, long line_number, double rows_variance = 0.0);
};

/// Leaves out a row, or the mean of several from this line on.
void drop(FitResult& result, long line, double x, double torque, const std::string& reason, long rows = 1);

/// How many rows were left out for this reason.
long dropped_for(const FitResult& result, const std::string& reason);

/// At most `most` readings: means over runs of neighbours in x, with rows far from a run's median left out.
Readings condense(const Readings& all, std::size_t most, FitResult& result);

/// Without the marked readings.
Readings without(const Readings& all, const std::vector<char>& leave_out);

/// The same; the marked ones are dropped for a reason.
Readings dropping(const Readings& all, const std::vector<char>& leave_out, const std::string& reason,
                  FitResult& result);

/// value with its 95 % interval, cut at 0; empty, not identifiable, where the interval is wider than `scale` to each side.
std::optional<ParameterEstimate> estimate(double value, double variance, double degrees, double scale);

/// The given value as an estimate.
ParameterEstimate given(double value);

/// Relative standard deviation of a row about the fit: of the readings, and where they are means that of their rows too.
double scatter_of_rows(const Readings& readings, const LeastSquaresFit& fit);

/// Names the outliers and fills in the scatter and the curve.
void report(const Readings& readings, const LeastSquaresFit& fit, FitResult& result);

/// The fit's residuals over x, outliers left out.
struct Residuals {
  std::vector<double> x, residual;
};
Residuals kept_residuals(const Readings& readings, const LeastSquaresFit& fit);

/// Why the model does not describe the readings, as a sentence that ends with `what`; empty where it does. Systematic parts
/// below 2 % are within what instruments and models promise.
std::string misfit_of(const Readings& readings, const LeastSquaresFit& fit, const std::string& what);

/// Adds a model to those that were compared; `least`: the chosen one's AICc.
void add_candidate(const std::string& name, const Readings& readings, const LeastSquaresFit& fit, double aicc,
                   double least, bool chosen, FitResult& result);

FitResult fit_flow_curve(const TorqueRecord& record, const FitInput& input);

enum class Stability { judged, taken_for_granted };

/// `stability`: where neither yield stress nor viscosity is given, whether parameters that hang on the record's clock or on
/// its parts are looked for (decay_stability.hpp).
FitResult fit_torque_decay(const TorqueRecord& record, const FitInput& input,
                           Stability stability = Stability::judged);

}  // namespace tremie::fitting
