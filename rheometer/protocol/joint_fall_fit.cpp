#include "rheometer/protocol/joint_fall_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <stdexcept>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

constexpr double most_factor = 100.0;  ///< between two modes
constexpr double least_factor = 3.0;   ///< less, and the rows hardly tell them apart
constexpr double least_share = 0.02;

/// Where a model's parameters stand, and what they say.
struct Layout {
  const FallRows& rows;
  FallModel model;

  std::size_t falls() const { return rows.falls.size(); }
  std::size_t modes() const { return static_cast<std::size_t>(model.modes); }
  std::size_t amplitude(std::size_t s, std::size_t mode) const { return rows.speeds + s * modes() + mode; }
  std::size_t first_of_rate() const { return amplitude(falls(), 0); }
  std::size_t rates() const {
    return model.rate == RateOfFalls::of_each ? falls() : model.rate == RateOfFalls::power ? 2 : 1;
  }
  std::size_t first_of_shape() const { return first_of_rate() + rates(); }
  std::size_t size() const { return first_of_shape() + (model.exponent ? 1 : modes() - 1); }
  double log_rate(std::span<const double> p, std::size_t s) const {
    const std::size_t at = first_of_rate();
    if (model.rate == RateOfFalls::of_each) return p[at + s];
    return p[at] + (model.rate == RateOfFalls::power ? p[at + 1] : 1.0) * std::log(rows.shear_rate[s]);
  }
  double factor(std::span<const double> p, std::size_t mode) const {
    return mode == 0 ? 1.0 : std::exp(p[first_of_shape() + mode - 1]);
  }
};

double largest_excess(const Layout& l, std::span<const double> p) {
  double largest = 0.0;
  for (std::size_t s = 0; s < l.falls(); ++s) largest = std::max(largest, p[l.amplitude(s, 0)]);
  return largest;
}

double torque_of(const Layout& l, std::span<const double> p, std::size_t s, double time, double rate) {
  double torque = p[l.rows.speed[s]];
  if (l.model.exponent) {
    const double q = p[l.first_of_shape()], excess = p[l.amplitude(s, 0)], c = excess / largest_excess(l, p);
    return torque + excess * std::pow(1.0 + q * std::pow(c, q) * rate * time, -1.0 / q);
  }
  for (std::size_t j = 0; j < l.modes(); ++j)
    torque += p[l.amplitude(s, j)] * std::exp(-l.factor(p, j) * rate * time);
  return torque;
}

void fill(const Layout& l, std::span<const double> p, std::span<double> fitted) {
  for (std::size_t s = 0, i = 0; s < l.falls(); ++s) {
    const double rate = std::exp(l.log_rate(p, s));
    for (const double t : l.rows.falls[s].time) fitted[i++] = torque_of(l, p, s, t, rate);
  }
}

/// A row's derivatives by the parameters of its rate, from the one by ln r_s.
void fill_by_rate(const Layout& l, std::size_t s, double by_log_rate, std::span<double> row) {
  const std::size_t at = l.first_of_rate();
  row[at + (l.model.rate == RateOfFalls::of_each ? s : 0)] = by_log_rate;
  if (l.model.rate == RateOfFalls::power) row[at + 1] = by_log_rate * std::log(l.rows.shear_rate[s]);
}

void fill_jacobian(const Layout& l, std::span<const double> p, std::span<double> jacobian) {
  std::fill(jacobian.begin(), jacobian.end(), 0.0);
  for (std::size_t s = 0, i = 0; s < l.falls(); ++s) {
    const double rate = std::exp(l.log_rate(p, s));
    for (const double t : l.rows.falls[s].time) {
      const std::span<double> row = jacobian.subspan(l.size() * i++, l.size());
      row[l.rows.speed[s]] = 1.0;
      double by_log_rate = 0.0;
      for (std::size_t j = 0; j < l.modes(); ++j) {
        const double gone = l.factor(p, j) * rate * t, left = std::exp(-gone);
        row[l.amplitude(s, j)] = left;
        const double by_factor = -p[l.amplitude(s, j)] * gone * left;
        if (j > 0) row[l.first_of_shape() + j - 1] = by_factor;
        by_log_rate += by_factor;
      }
      fill_by_rate(l, s, by_log_rate, row);
    }
  }
}

/// Of the power of lambda, by central differences.
void fill_jacobian_of_power(const Layout& l, std::span<const double> p, std::span<double> jacobian) {
  std::vector<double> moved(p.begin(), p.end());
  const std::size_t n = l.rows.begin.back();
  std::vector<double> above(n), below(n);
  const double top = largest_excess(l, p);
  for (std::size_t k = 0; k < moved.size(); ++k) {
    const double step = 1e-6 * (k < l.first_of_rate() ? std::max(std::abs(p[k]), 1e-6 * top) : 1.0);
    moved[k] = p[k] + step, fill(l, moved, above);
    moved[k] = p[k] - step, fill(l, moved, below);
    moved[k] = p[k];
    for (std::size_t i = 0; i < n; ++i) jacobian[i * moved.size() + k] = (above[i] - below[i]) / (2.0 * step);
  }
}

struct Bounds {
  std::vector<double> start, lower, upper;
  void add(double value, double low, double high) {
    start.push_back(std::clamp(value, low, high)), lower.push_back(low), upper.push_back(high);
  }
};

/// A mode that `from` has not got takes a third of the fall's first one.
void add_amplitudes(const Layout& l, const FallFit* from, Bounds& b) {
  std::vector<double> end(l.rows.speeds, HUGE_VAL);
  double top = 0.0;
  for (std::size_t s = 0; s < l.falls(); ++s) {
    const auto& torque = l.rows.falls[s].torque;
    double& lowest = end[l.rows.speed[s]];
    lowest = std::min(lowest, 0.9 * *std::min_element(torque.begin(), torque.end()));
    top = std::max(top, *std::max_element(torque.begin(), torque.end()));
  }
  for (std::size_t g = 0; g < l.rows.speeds; ++g)
    b.add(from ? from->fit.parameters[g] : end[g], 1e-4 * end[g], top);
  const std::size_t known = from ? static_cast<std::size_t>(from->model.modes) : 0;
  for (std::size_t s = 0; s < l.falls(); ++s) {
    const double* before = from ? &from->fit.parameters[l.rows.speeds + s * known] : nullptr;
    const double first = before ? before[0] : l.rows.falls[s].torque.front() - end[l.rows.speed[s]];
    b.add(first, 1e-6 * top, 100.0 * top);
    for (std::size_t j = 1; j < l.modes(); ++j) b.add(j < known ? before[j] : 0.3 * first, -top, 100.0 * top);
  }
}

/// ln of the rates by the half times, or the line through them.
void add_rates(const Layout& l, const FallFit* from, Bounds& b) {
  std::vector<double> x, y;
  for (std::size_t s = 0; s < l.falls(); ++s) {
    const Fall& f = l.rows.falls[s];
    x.push_back(std::log(l.rows.shear_rate[s]));
    y.push_back(from ? Layout{l.rows, from->model}.log_rate(from->fit.parameters, s)
                     : std::log(std::numbers::ln2 / excess_half_time(f).value_or(0.3 * f.time.back())));
  }
  constexpr double widest = 30.0;
  if (l.model.rate == RateOfFalls::of_each) {
    for (const double rate : y) b.add(rate, -widest, widest);
    return;
  }
  const StraightLine line = straight_line(x, y);
  const bool power = l.model.rate == RateOfFalls::power;
  b.add(power ? line.at(0.0) : line.mean_y - line.mean_x, -widest, widest);
  if (power) b.add(line.slope, -3.0, 3.0);
}

Bounds bounds_of(const Layout& l, const FallFit* from, double factor) {
  Bounds b;
  add_amplitudes(l, from, b);
  add_rates(l, from, b);
  if (l.model.exponent) {
    b.add(0.5, 1e-3, 10.0);
    return b;
  }
  const std::size_t known = from ? static_cast<std::size_t>(from->model.modes) : 1;
  for (std::size_t j = 1; j < l.modes(); ++j)
    b.add(j < known ? from->fit.parameters[from->first_of_shape + j - 1] : std::log(factor),
          -std::log(most_factor), std::log(most_factor));
  return b;
}

/// Of a fall's residuals: the largest weight is 1.
double weight_of(const std::vector<double>& scatter, std::size_t s) {
  return scatter.empty() ? 1.0 : *std::min_element(scatter.begin(), scatter.end()) / scatter[s];
}

std::optional<FallFit> solve(const Layout& l, const std::vector<double>& scatter, Bounds bounds) {
  LeastSquaresProblem p;
  for (std::size_t s = 0; s < l.falls(); ++s)
    for (const double torque : l.rows.falls[s].torque) {
      p.observed.push_back(torque);
      p.count.push_back(std::pow(weight_of(scatter, s), 2));
    }
  p.start = std::move(bounds.start), p.lower = std::move(bounds.lower), p.upper = std::move(bounds.upper);
  p.model = [&](std::span<const double> q, std::span<double> fitted, std::span<double> jacobian) {
    fill(l, q, fitted);
    if (!jacobian.empty()) (l.model.exponent ? fill_jacobian_of_power : fill_jacobian)(l, q, jacobian);
    return std::all_of(fitted.begin(), fitted.end(), [](double f) { return f > 0.0 && std::isfinite(f); });
  };
  FallFit result{l.model, {}, {}, l.rows.speeds, l.first_of_rate(), l.first_of_shape()};
  try {
    result.fit = fit_least_squares(
        p, {.readings_in_time_order = true, .parameter_tolerance = 1e-7, .max_iterations = 200});
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
  for (std::size_t s = 0; s < l.falls(); ++s) {
    double squares = 0.0, n = 0.0;
    for (std::size_t i = l.rows.begin[s]; i < l.rows.begin[s + 1]; ++i)
      if (!result.fit.outlier[i]) squares += result.fit.residual[i] * result.fit.residual[i], n += 1.0;
    result.scatter.push_back(std::max(1e-6, std::sqrt(squares / std::max(1.0, n - 2.0))));
  }
  return result;
}

}  // namespace

std::optional<FallFit> fit_falls(const FallRows& rows, const FallModel& model,
                                 const std::vector<double>& scatter, const FallFit* start) {
  const Layout layout{rows, model};
  if (rows.begin.back() < layout.size() + 4) return std::nullopt;
  std::optional<FallFit> best;
  double least = HUGE_VAL;
  const bool adds_mode = model.modes > (start ? start->model.modes : 1);
  for (const double factor : adds_mode ? std::vector<double>{6.0, 0.1} : std::vector<double>{1.0}) {
    auto found = solve(layout, scatter, bounds_of(layout, start, factor));
    if (!found) continue;
    double misses = 0.0;
    for (std::size_t s = 0; s < rows.falls.size(); ++s)
      for (std::size_t i = rows.begin[s]; i < rows.begin[s + 1]; ++i)
        misses += weight_of(scatter, s) * std::abs(found->fit.residual[i]);
    // a start that ends in modes which the rows tell goes before one that does not
    const bool told = tells_shape(*found), told_before = best && tells_shape(*best);
    if (told == told_before ? misses < least : told) least = misses, best = std::move(found);
  }
  return best;
}

bool tells_shape(const FallFit& f) {
  const auto first = f.fit.told.begin() + static_cast<std::ptrdiff_t>(f.first_of_rate);
  if (!std::all_of(first, f.fit.told.end(), [](char t) { return t != 0; })) return false;
  std::vector<BreakdownMode> modes = modes_of(f);
  std::sort(modes.begin(), modes.end(), [](const auto& x, const auto& y) { return x.factor < y.factor; });
  for (std::size_t j = 0; j < modes.size(); ++j) {
    if (modes.size() > 1 && modes[j].share < least_share) return false;
    if (j > 0 && modes[j].factor < least_factor * modes[j - 1].factor) return false;
  }
  return modes.back().factor < 0.99 * most_factor && modes.front().factor > 1.01 / most_factor;
}

double mean_square(const FallRows& rows, const FallFit& f, const std::vector<double>& scatter,
                   const std::vector<char>& left_out) {
  double squares = 0.0, n = 0.0;
  for (std::size_t s = 0; s < rows.falls.size(); ++s)
    for (std::size_t i = rows.begin[s]; i < rows.begin[s + 1]; ++i) {
      if (left_out[i]) continue;
      squares += std::pow(weight_of(scatter, s) * f.fit.residual[i], 2);
      n += 1.0;
    }
  return squares / std::max(1.0, n);
}

std::vector<BreakdownMode> modes_of(const FallFit& f) {
  const auto n = static_cast<std::size_t>(f.model.modes);
  std::vector<BreakdownMode> modes(n, {0.0, 1.0});
  double sum = 0.0;
  for (std::size_t i = f.speeds; i < f.first_of_rate; ++i) {
    const double amplitude = std::max(0.0, f.fit.parameters[i]);
    modes[(i - f.speeds) % n].share += amplitude;
    sum += amplitude;
  }
  for (BreakdownMode& mode : modes) mode.share /= sum;
  for (std::size_t j = 1; j < n; ++j) modes[j].factor = std::exp(f.fit.parameters[f.first_of_shape + j - 1]);
  return modes;
}

double fitted_torque(const FallRows& rows, const FallFit& f, std::size_t s, double time, double rate) {
  return torque_of({rows, f.model}, f.fit.parameters, s, time, rate);
}

}  // namespace tremie
