#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/regression/least_squares.hpp"

namespace tremie {

namespace {

/// The relative scatter of T_end + C shape(t) with two parameters of the shape at most.
template <class Shape>
std::optional<LeastSquaresFit> shape_fit(const std::vector<double>& t, const std::vector<double>& torque,
                                         std::vector<double> start, Shape shape) {
  LeastSquaresProblem p;
  p.observed = torque;
  p.count.assign(torque.size(), 1.0);
  p.start = {0.5 * torque.back(), torque.front() - 0.5 * torque.back()};
  p.start.insert(p.start.end(), start.begin(), start.end());
  p.lower = {0.0, 0.0, 1e-6 * t.back(), 0.01};
  p.upper = {10.0 * torque.front(), 100.0 * torque.front(), 100.0 * t.back(), 20.0};
  p.lower.resize(p.start.size());
  p.upper.resize(p.start.size());
  p.model = [&](std::span<const double> q, std::span<double> fitted, std::span<double> jacobian) {
    const auto value = [&](const std::vector<double>& v, std::size_t i) {
      return v[0] + v[1] * shape(v, t[i]);
    };
    const std::vector<double> at(q.begin(), q.end());
    for (std::size_t i = 0; i < t.size(); ++i) fitted[i] = value(at, i);
    for (std::size_t k = 0; !jacobian.empty() && k < at.size(); ++k) {
      std::vector<double> moved = at;
      const double step = 1e-6 * std::max(std::abs(at[k]), 1e-6 * torque.front());
      moved[k] += step;
      for (std::size_t i = 0; i < t.size(); ++i)
        jacobian[i * at.size() + k] = (value(moved, i) - fitted[i]) / step;
    }
    return std::all_of(fitted.begin(), fitted.end(), [](double f) { return f > 0.0 && std::isfinite(f); });
  };
  try {
    return fit_least_squares(
        p, {.readings_in_time_order = true, .parameter_tolerance = 1e-8, .max_iterations = 200});
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

}  // namespace

DecayShape read_decay_shape(const std::vector<double>& time, const std::vector<double>& torque) {
  DecayShape d;
  d.peak_torque = torque.front();
  d.end_torque = torque.back();
  for (std::size_t i = 1; i < torque.size() && !d.half_time; ++i) {
    const double half = 0.5 * torque.front();
    if (torque[i] > half) continue;
    const double share = (torque[i - 1] - half) / (torque[i - 1] - torque[i]);
    d.half_time = time[i - 1] + share * (time[i] - time[i - 1]);
  }
  if (torque.size() < 8 || !(torque.back() > 0.0) || !(torque.back() < 0.95 * torque.front())) return d;
  std::vector<double> t, T;  // some hundred readings tell a shape
  const std::size_t every = 1 + torque.size() / 400;
  for (std::size_t i = 0; i < torque.size(); i += every)
    if (torque[i] > 0.0) t.push_back(time[i]), T.push_back(torque[i]);
  const double guess = d.half_time.value_or(0.2 * time.back());
  if (const auto e = shape_fit(t, T, {guess}, [](const auto& v, double x) { return std::exp(-x / v[2]); }))
    d.exponential_scatter = e->scatter;
  if (const auto p = shape_fit(t, T, {0.5 * guess, 0.7},
                               [](const auto& v, double x) { return std::pow(1.0 + x / v[2], -v[3]); })) {
    d.power_scatter = p->scatter;
    d.power_m = p->parameters[3];
    d.power_t0 = p->parameters[2];
  }
  return d;
}

}  // namespace tremie
