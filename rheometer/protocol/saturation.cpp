#include "rheometer/protocol/saturation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

/// Scatter of S_end - C e^(-rest/t) at a time t, by the best S_end and C.
StraightLine bent_line(const std::vector<double>& rest, const std::vector<double>& stress, double time) {
  std::vector<double> left;
  for (const double r : rest) left.push_back(std::exp(-r / time));
  return straight_line(left, stress);
}

/// The time with the least scatter, by the golden section over its logarithm; empty: at an end of the range.
std::optional<double> time_of(const std::vector<double>& rest, const std::vector<double>& stress) {
  const double longest = *std::max_element(rest.begin(), rest.end());
  const double first = std::log(0.1 * longest), last = std::log(20.0 * longest);
  const auto scatter = [&](double u) { return bent_line(rest, stress, std::exp(u)).deviation; };
  double low = first, high = last;
  for (int i = 0; i < 80; ++i) {
    const double step = (high - low) / std::numbers::phi;
    (scatter(high - step) < scatter(low + step) ? high : low) =
        scatter(high - step) < scatter(low + step) ? low + step : high - step;
  }
  const double u = 0.5 * (low + high);
  return u - first < 1e-3 || last - u < 1e-3 ? std::nullopt : std::optional(std::exp(u));
}

}  // namespace

std::optional<Saturation> saturation_of(const std::vector<double>& rest, const std::vector<double>& stress) {
  if (rest.size() < 4) return std::nullopt;
  const auto time = time_of(rest, stress);
  if (!time) return std::nullopt;
  const StraightLine bent = bent_line(rest, stress, *time), line = straight_line(rest, stress);
  const double n = static_cast<double>(rest.size());
  Saturation s;
  s.end_stress = bent.at(0.0);
  s.time = *time;
  const double squares = bent.deviation * bent.deviation * (n - 2.0),
               of_line = line.deviation * line.deviation * (n - 2.0);
  s.scatter = std::sqrt(squares / (n - 3.0)) / bent.mean_y;
  s.chance = fisher_tail((of_line - squares) / std::max(squares / (n - 3.0), 1e-300), 1.0, n - 3.0);
  const auto longest = std::max_element(rest.begin(), rest.end()) - rest.begin();
  std::vector<double> shorter = rest, their_stress = stress;
  shorter.erase(shorter.begin() + longest);
  their_stress.erase(their_stress.begin() + longest);
  if (const auto without = time_of(shorter, their_stress))
    s.forecast_of_longest = bent_line(shorter, their_stress, *without)
                                .at(std::exp(-rest[static_cast<std::size_t>(longest)] / *without));
  return s;
}

std::vector<PeakForecast> forecasts_of(const std::vector<double>& rest, const std::vector<double>& stress) {
  std::vector<std::pair<double, double>> peaks;
  for (std::size_t i = 0; i < rest.size(); ++i) peaks.emplace_back(rest[i], stress[i]);
  std::sort(peaks.begin(), peaks.end());
  std::vector<PeakForecast> forecasts;
  std::vector<double> shorter, their_stress;
  for (const auto& [r, S] : peaks) {
    if (shorter.size() >= 3)
      if (const auto time = time_of(shorter, their_stress))
        forecasts.push_back({r, S, bent_line(shorter, their_stress, *time).at(std::exp(-r / *time))});
    shorter.push_back(r);
    their_stress.push_back(S);
  }
  return forecasts;
}

}  // namespace tremie
