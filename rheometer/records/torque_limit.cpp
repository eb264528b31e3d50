#include "rheometer/records/torque_limit.hpp"

#include <algorithm>
#include <cmath>

namespace tremie {

namespace {

/// Whether all are multiples of a step, to a hundredth of it.
bool multiples_of(double step, const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [&](double v) { return std::abs(v / step - std::round(v / step)) < 0.01; });
}

/// The step by which the instrument or its export resolves the torque: the smallest between neighbours where all others are
/// multiples of it, or a power of ten of which all torques are multiples; rounding in double precision where neither is.
double resolution_of(const std::vector<double>& torque, double most) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < torque.size(); ++i) {
    const double step = std::abs(torque[i] - torque[i - 1]);
    if (step > 1e-9 * most) steps.push_back(step);
  }
  const double smallest = steps.empty() ? most : *std::min_element(steps.begin(), steps.end());
  if (multiples_of(smallest, steps)) return smallest;
  for (int digits = 0; digits < 7; ++digits) {
    const double step = std::pow(10.0, std::floor(std::log10(most)) - digits);
    if (multiples_of(step, torque)) return step;
  }
  return 1e-9 * most;
}

}  // namespace

std::optional<TorqueLimit> torque_limit(const std::vector<double>& x, const std::vector<double>& torque) {
  constexpr std::size_t fewest = 3;
  const std::size_t n = torque.size();
  if (n < fewest + 2) return std::nullopt;
  const double most = *std::max_element(torque.begin(), torque.end());
  if (!(most > 0.0)) return std::nullopt;
  const double resolution = resolution_of(torque, most);
  std::size_t from = 0, to = 0;  // the longest run at the largest torque
  for (std::size_t i = 0; i < n;) {
    std::size_t end = i;
    while (end < n && torque[end] >= most * (1.0 - 1e-9)) ++end;
    if (end - i > to - from) from = i, to = end;
    i = std::max(end, i + 1);
  }
  const std::size_t rows = to - from;
  std::size_t places = rows > 0;
  for (std::size_t i = from + 1; i < to; ++i) places += x[i] > x[i - 1] * (1.0 + 1e-9);
  if (places < fewest || rows == n) return std::nullopt;
  const auto leaves = [&](std::size_t row) { return most - torque[row] >= 20.0 * resolution; };
  if (from > 0 && !leaves(from > rows ? from - rows : 0)) return std::nullopt;
  if (to < n && !leaves(std::min(n - 1, to + rows - 1))) return std::nullopt;
  return TorqueLimit{most, static_cast<long>(rows)};
}

}  // namespace tremie
