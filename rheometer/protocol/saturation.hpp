#pragma once

// Peaks of start-ups over the rests before them as structure that saturates, and forecasts of a peak by the shorter rests.

#include <optional>
#include <vector>

namespace tremie {

/// Peaks over rests as structure that saturates: S_end - C e^(-rest/t). In the terms of a scene A_thix = (S_end - tau_0)/t
/// and lambda_max = (S_end - tau_0)/tau_0.
struct Saturation {
  double end_stress = 0.0;  ///< S_end [Pa]
  double time = 0.0;        ///< t [s]
  double scatter = 0.0;     ///< relative to the mean stress
  double chance = 1.0;      ///< of so much less scatter than a line's, were the line right (F test)
  std::optional<double> forecast_of_longest;  ///< by the shorter rests alone [Pa]
};

/// A peak by the shorter rests alone, three at least.
struct PeakForecast {
  double rest = 0.0, measured = 0.0, forecast = 0.0;  ///< [s], [Pa], [Pa]
};
std::vector<PeakForecast> forecasts_of(const std::vector<double>& rest, const std::vector<double>& stress);

/// Empty for fewer than four rests, or where the peaks do not bend down.
std::optional<Saturation> saturation_of(const std::vector<double>& rest, const std::vector<double>& stress);

}  // namespace tremie
