#include "rheometer/fits/decay_least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/regression/statistics.hpp"

namespace tremie::fitting {

double mean_torque(const Readings& r, double from, double to) {
  const auto n = static_cast<double>(r.size());
  const auto begin = static_cast<std::size_t>(from * n);
  const auto end = std::max(begin + 1, static_cast<std::size_t>(std::ceil(to * n)));
  return median({r.torque.begin() + static_cast<std::ptrdiff_t>(begin),
                 r.torque.begin() + static_cast<std::ptrdiff_t>(end)});
}

namespace {

/// tau_0 and mu from the end of the record, lambda_0 from its start; alpha is looked for later.
Layout first_guess(const Readings& r, const FitInput& in) {
  const double start = mean_torque(r, 0.0, 0.03), end = std::min(start, mean_torque(r, 0.9, 1.0));
  Layout layout;
  double mu = in.mu.value_or(0.0);
  if (!in.mu) {  // what the torque's end leaves for the viscosity, or a third of it
    const double newtonian = reiner_riwlin({0.0, 1.0}, *in.omega, in.instrument).torque;
    mu = end / newtonian / 3.0;
    if (in.tau_0) {
      double low = 1e-6 * mu, high = 3.0 * mu;
      for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (reiner_riwlin({*in.tau_0, middle}, *in.omega, in.instrument).torque < end ? low : high) = middle;
      }
      mu = 0.5 * (low + high);
    }
    layout.free.push_back(i_mu);
  }
  const double tau_end = yield_stress_from_torque(end, mu, in);
  const double tau_start = yield_stress_from_torque(start, mu, in);
  const double smallest = 1e-3 * shear_stress_at(in.instrument.vane_radius, end, in.instrument);
  const double tau_0 = in.tau_0.value_or(std::max(0.6 * tau_end, smallest));
  if (!in.tau_0) layout.free.insert(layout.free.begin(), i_tau_0);
  layout.free.push_back(i_lambda);
  layout.free.push_back(i_alpha);
  if (decay_fit(in.kinetics).free_exponent) layout.free.push_back(i_exponent);
  layout.all = {tau_0, mu, std::max(0.05, tau_start / tau_0 - 1.0), 0.0, 1.0};
  return layout;
}

bool evaluate(const DecayModel& model, const DecayParameters& p, std::span<double> result) {
  try {
    model.torque(p, result);
  } catch (const std::runtime_error&) {
    return false;  // the integrator gave up: the fit takes a smaller step
  }
  return std::all_of(result.begin(), result.end(), [](double t) { return std::isfinite(t) && t > 0.0; });
}

/// Sum of the absolute relative errors: an outlier must not decide.
double absolute_error(const DecayModel& model, const Readings& r, const DecayParameters& p,
                      std::vector<double>& fitted) {
  if (!evaluate(model, p, fitted)) return std::numeric_limits<double>::infinity();
  double sum = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) sum += r.count[i] * std::abs(r.torque[i] / fitted[i] - 1.0);
  return sum;
}

/// The sum of squares has side minima in alpha where nothing breaks down or all does at once: look over five
/// decades; and, where n is free, over it and what its slow tail leaves for the yield stress.
void search_valley(const DecayModel& model, const Readings& r, const FitInput& in, Layout& layout) {
  const double unit = 1.0 / (newtonian_shear_rate(*in.omega, in.instrument) * r.x.back());
  const bool power = decay_fit(in.kinetics).free_exponent;
  const DecayParameters first = layout.all;
  const double static_stress = (1.0 + first[i_lambda]) * first[i_tau_0];
  std::vector<double> fitted(r.size());
  double best = std::numeric_limits<double>::infinity();
  const std::vector<double> exponents = power ? std::vector{1.5, 2.2, 3.5} : std::vector{1.0};
  const std::vector<double> yield_shares =
      power && !in.tau_0 ? std::vector{1.0, 0.2, 0.03} : std::vector{1.0};
  const std::vector<double> viscosity_shares = power && !in.mu ? std::vector{1.0, 0.3} : std::vector{1.0};
  for (const double n : exponents)
    for (const double yield_share : yield_shares)
      for (const double viscosity_share : viscosity_shares)
        for (double factor = power ? 0.3 : 0.03; factor < 2000.0; factor *= 2.5) {
          DecayParameters p = first;
          p[i_tau_0] *= yield_share;
          p[i_mu] *= viscosity_share;
          p[i_lambda] = std::max(0.05, static_stress / p[i_tau_0] - 1.0);
          p[i_alpha] = factor * unit;
          p[i_exponent] = n;
          const double error = absolute_error(model, r, p, fitted);
          if (error >= best) continue;
          best = error;
          layout.all = p;
        }
  if (!std::isfinite(best))
    throw std::runtime_error("the thixotropic Couette model has no solution for this record");
}

/// Forward differences: the model's own error, 1e-6, moves them by 1e-3 of the derivative.
bool fill_jacobian(const DecayModel& model, const Layout& layout, const DecayParameters& p,
                   std::span<const double> fitted, std::span<double> jacobian) {
  std::vector<double> moved(fitted.size());
  const double floors[] = {0.1, 0.1, 0.05, 1e-4, 1.0};
  for (std::size_t k = 0; k < layout.free.size(); ++k) {
    const std::size_t index = layout.free[k];
    const double step = 2e-3 * std::max(p[index], floors[index]);
    DecayParameters q = p;
    q[index] += step;
    if (!evaluate(model, q, moved)) return false;
    for (std::size_t i = 0; i < fitted.size(); ++i)
      jacobian[i * layout.free.size() + k] = (moved[i] - fitted[i]) / step;
  }
  return true;
}

/// What the model gave before. A fit asks for the same parameters twice or more (residuals, Jacobian, next
/// pass), and for the Jacobian at parameters that hardly differ.
struct Memory {
  DecayParameters at{}, jacobian_at{};
  std::vector<double> torque, jacobian;
};

/// Torque and, where it is asked for, the Jacobian; that of parameters within 0.5 % serves as well, as it
/// differs by as much: the iterations still end where the residuals say, and the intervals move by less than
/// 1 %.
bool recall(const DecayModel& model, const Layout& layout, const DecayParameters& p, Memory& memory,
            std::span<double> fitted, std::span<double> jacobian) {
  if (memory.torque.empty() || p != memory.at) {
    memory.torque.clear();
    if (!evaluate(model, p, fitted)) return false;
    memory.at = p;
    memory.torque.assign(fitted.begin(), fitted.end());
  }
  std::copy(memory.torque.begin(), memory.torque.end(), fitted.begin());
  if (jacobian.empty()) return true;
  const bool near = std::equal(p.begin(), p.end(), memory.jacobian_at.begin(),
                               [](double a, double b) { return std::abs(a - b) <= 5e-3 * std::abs(b); });
  if (!near || memory.jacobian.empty()) {
    memory.jacobian.clear();
    if (!fill_jacobian(model, layout, p, fitted, jacobian)) return false;
    memory.jacobian_at = p;
    memory.jacobian.assign(jacobian.begin(), jacobian.end());
  }
  std::copy(memory.jacobian.begin(), memory.jacobian.end(), jacobian.begin());
  return true;
}

LeastSquaresFit least_squares(const DecayModel& model, const Readings& r, const Layout& layout) {
  const DecayParameters lower{1e-6, 1e-6, 0.0, 0.0, 1.0}, upper{1e6, 1e6, 1e4, 1e5, 12.0};
  LeastSquaresProblem problem;
  problem.observed = r.torque;
  problem.count = r.count;
  for (const std::size_t index : layout.free) {
    problem.start.push_back(layout.all[index]);
    problem.lower.push_back(lower[index]);
    problem.upper.push_back(upper[index]);
  }
  Memory memory;
  problem.model = [&](std::span<const double> p, std::span<double> fitted, std::span<double> jacobian) {
    return recall(model, layout, layout.with(p), memory, fitted, jacobian);
  };
  return fit_least_squares(
      problem, {.readings_in_time_order = true, .parameter_tolerance = 1e-5, .max_iterations = 60});
}

}  // namespace

int intervals_of(const FitInput& in) { return flow_index_of(in) == 1.0 ? 100 : 400; }

DecayFit fit_decay(const Readings& r, const FitInput& in) {
  DecayFit result;
  result.kinetics = in.kinetics;
  result.layout = first_guess(r, in);
  search_valley(DecayModel(in, r.x, 40), r, in, result.layout);  // it only has to tell the valley
  result.fit = least_squares(DecayModel(in, r.x, intervals_of(in)), r, result.layout);
  return result;
}

DecayFit refined(const Readings& r, const FitInput& in, DecayFit fit, int intervals) {
  fit.layout.all = fit.parameters();
  fit.fit = least_squares(DecayModel(in, r.x, intervals), r, fit.layout);
  return fit;
}

namespace {

/// Columns of the lower factor of a covariance; a parameter without a variance of its own has none.
std::vector<std::vector<double>> cholesky_columns(const std::vector<double>& covariance, std::size_t n) {
  std::vector<double> left = covariance;
  std::vector<std::vector<double>> columns;
  for (std::size_t k = 0; k < n; ++k) {
    const double pivot = left[k * n + k];
    if (!(pivot > 1e-9 * covariance[k * n + k])) continue;
    std::vector<double> column(n, 0.0);
    for (std::size_t i = k; i < n; ++i) column[i] = left[i * n + k] / std::sqrt(pivot);
    for (std::size_t i = k; i < n; ++i)
      for (std::size_t j = k; j < n; ++j) left[i * n + j] -= column[i] * column[j];
    columns.push_back(std::move(column));
  }
  return columns;
}

/// The law moved by a column, or against it where that would leave the range of its parameters.
KnownLaw moved_law(const KnownLaw& law, const std::vector<double>& column) {
  const auto& parameters = flow_law(law.name).parameters;
  for (const double sign : {1.0, -1.0}) {
    KnownLaw moved = law;
    bool inside = true;
    for (std::size_t k = 0; k < column.size(); ++k) {
      moved.parameters[k] += sign * column[k];
      inside =
          inside && moved.parameters[k] > parameters[k].lower && moved.parameters[k] < parameters[k].upper;
    }
    if (inside) return moved;
  }
  return law;
}

}  // namespace

std::vector<DecayParameters> moves_by_curve(const Readings& r, const FitInput& in, const DecayFit& fit) {
  std::vector<DecayParameters> moves;
  if (!in.curve || in.curve->covariance.empty()) return moves;
  const DecayParameters at = fit.parameters();
  for (const auto& column : cholesky_columns(in.curve->covariance, in.curve->parameters.size())) {
    FitInput moved = in;
    moved.curve = moved_law(*in.curve, column);
    moved.tau_0 = moved.curve->parameters.front(), moved.mu = viscous_stress(*moved.curve).k;
    DecayFit start = fit;
    start.layout.all = at;
    start.layout.all[i_tau_0] = *moved.tau_0, start.layout.all[i_mu] = *moved.mu;
    DecayParameters move = refined(r, moved, std::move(start), intervals_of(in)).parameters();
    for (std::size_t i = 0; i < move.size(); ++i) move[i] -= at[i];
    moves.push_back(move);
  }
  return moves;
}

}  // namespace tremie::fitting
