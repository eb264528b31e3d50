#pragma once

#include <string>

#include "rheometer/fits/fit.hpp"

namespace tremie::cli {

/// The readings and the fit as CSV: what the charts show.
std::string fit_csv(const FitResult& result);

}  // namespace tremie::cli
