#pragma once

#include <string>

#include "rheometer/fits/fit.hpp"

namespace tremie::cli {

/// The readings and the fit as CSV: what the charts show.
std::string fit_csv(const FitResult& result, const Instrument& instrument);

/// gnuplot script of the charts, to run beside fit.csv: for a flow curve torque.svg (torque over speed, the
/// plug regime marked), flow_curve.svg (stress over shear rate with its band) and residuals.svg; for a torque
/// decay torque.svg, residuals.svg and flocculation.svg (apparent lambda with the exponential through it).
std::string fit_charts(const FitResult& result, const Instrument& instrument);

}  // namespace tremie::cli
