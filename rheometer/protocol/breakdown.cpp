#include "rheometer/protocol/breakdown.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <numbers>

#include "rheometer/reference/instrument.hpp"
#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

constexpr double least_ratio_of_speeds = 2.0;

double end_of(const std::vector<double>& torque) {
  const std::size_t n = std::max<std::size_t>(1, torque.size() / 20);
  return median({torque.end() - static_cast<std::ptrdiff_t>(n), torque.end()});
}

/// The line through ln(1/half time) over ln(rate): its slope is a.
void find_exponent(Breakdown& b) {
  std::vector<double> x, y;
  for (const BreakdownTime& t : b.times) {
    x.push_back(std::log(t.rate));
    y.push_back(std::log(std::numbers::ln2 / t.half_time));
  }
  const auto [slowest, fastest] = std::minmax_element(x.begin(), x.end());
  if (x.empty() || *fastest - *slowest < std::log(least_ratio_of_speeds)) {
    b.notes.push_back("rate_exponent: needs decays at two speeds, one at least twice the other");
    return;
  }
  const StraightLine line = straight_line(x, y);
  b.exponent = ParameterEstimate{line.slope, std::nullopt, false};
  b.rate = ParameterEstimate{std::exp(line.at(0.0)), std::nullopt, false};
  if (line.n < 3.0) {
    b.notes.push_back("rate_exponent: two decays tell no interval");
    return;
  }
  const double slope = line.half_width_of_slope(), at_one = line.half_width(0.0);
  b.exponent->ci95 = Interval{line.slope - slope, line.slope + slope};
  b.rate->ci95 = Interval{std::exp(line.at(0.0) - at_one), std::exp(line.at(0.0) + at_one)};
  b.notes.push_back(
      "rate_exponent: by the shear rate of a Newtonian fluid at the vane; where a slow vane shears a thinner "
      "layer, "
      "the rates differ by less and a is larger by that share");
}

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

std::optional<double> excess_half_time(const Fall& f) {
  if (f.torque.size() < 8) return std::nullopt;
  const double end = end_of(f.torque), half = 0.5 * (f.torque.front() + end);
  if (!(f.torque.front() - end > 0.1 * f.torque.front())) return std::nullopt;
  for (std::size_t i = 1; i < f.torque.size(); ++i) {
    if (f.torque[i] > half) continue;
    const double share = (f.torque[i - 1] - half) / (f.torque[i - 1] - f.torque[i]);
    const double time = f.time[i - 1] + share * (f.time[i] - f.time[i - 1]);
    return time > 0.0 ? std::optional(time) : std::nullopt;
  }
  return std::nullopt;
}

std::vector<BreakdownMode> modes_of_gamma(double m, double t_0, double rate) {
  // A mode stands for the rates of a half decade, with their mean; the first and the last for all beyond.
  constexpr int n = RatePowerKinetics::most_modes;
  std::vector<BreakdownMode> modes;
  double from = 0.0, below = 0.0, mean_below = 0.0;
  for (int i = 0; i < n; ++i) {
    from = rate * t_0 * std::pow(10.0, 0.5 * (i - 3));
    const double share = i + 1 < n ? boost::math::gamma_p(m, from) : 1.0;
    const double mean = m * (i + 1 < n ? boost::math::gamma_p(m + 1.0, from) : 1.0);
    modes.insert(modes.begin(), {share - below, (mean - mean_below) / ((share - below) * t_0 * rate)});
    below = share, mean_below = mean;
  }
  std::erase_if(modes, [](const BreakdownMode& mode) { return !(mode.share > 1e-4); });
  double sum = 0.0;
  for (const BreakdownMode& mode : modes) sum += mode.share;
  for (BreakdownMode& mode : modes) mode.share /= sum;
  return modes;
}

Breakdown breakdown_of(const std::vector<Fall>& falls, const Instrument& instrument) {
  Breakdown b;
  for (const Fall& f : falls)
    if (const auto half = excess_half_time(f); half && f.omega > 0.0)
      b.times.push_back({f.section, f.omega, newtonian_shear_rate(f.omega, instrument), *half});
  find_exponent(b);
  return b;
}

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

}  // namespace tremie
