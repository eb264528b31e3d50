#pragma once

// The least squares of one law to the readings of a flow curve. Private to rheometer/.

#include <vector>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/regression/least_squares.hpp"

namespace tremie::fitting {

/// A law with all of its parameters, given or fitted.
struct FittedLaw {
  const FlowLaw* law = nullptr;
  std::vector<double> all;
  std::vector<std::size_t> free;  ///< of `all`: those in fit.parameters
  LeastSquaresFit fit;

  double yield_stress() const { return all[0]; }
  FlowTorque at(double omega, const Instrument& in) const { return law->torque(all, omega, in); }
};

/// The parameter's value where the input gives it.
std::optional<double> given_value(const FitInput& input, const LawParameter& parameter);

bool several_speeds(const Readings& readings);

enum class Outliers { found, kept };

/// Fits the parameters of the law that are not given. Residuals that correlate in the order of the file's lines widen the
/// intervals.
FittedLaw least_squares(const Readings& readings, const FitInput& input, const FlowLaw& law,
                        Outliers outliers = Outliers::found);

/// The parameter that lies at an end of its law's range, which is no measurement of it; null where none does.
const LawParameter* at_bound(const FittedLaw& fitted);

/// Root mean square of the relative residuals of the readings that are no outliers.
double misfit(const FittedLaw& fitted);

}  // namespace tremie::fitting
