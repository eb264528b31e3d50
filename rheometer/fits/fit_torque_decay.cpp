#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "rheometer/fits/apparent_alpha.hpp"
#include "rheometer/fits/decay_model.hpp"
#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/statistics.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::fitting {

namespace {

constexpr std::size_t most_readings = 2000;
enum Index : std::size_t { i_tau_0, i_mu, i_lambda, i_alpha };

// --- the record
// ---------------------------------------------------------------------------------------------------

std::vector<double> running_median(const std::vector<double>& v) {
  std::vector<double> result(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::size_t from = i < 2 ? 0 : i - 2, to = std::min(v.size(), i + 3);
    result[i] =
        median({v.begin() + static_cast<std::ptrdiff_t>(from), v.begin() + static_cast<std::ptrdiff_t>(to)});
  }
  return result;
}

/// Scatter of a reading [N m] from second differences, which a smooth decay hardly moves.
double scatter_of(const std::vector<double>& torque) {
  std::vector<double> second;
  for (std::size_t i = 2; i < torque.size(); ++i)
    second.push_back(torque[i] - 2.0 * torque[i - 1] + torque[i - 2]);
  return robust_deviation(second) / std::sqrt(6.0);
}

/// Number of leading rows in which the torque still rises: the vane starts, the material is strained
/// elastically.
std::size_t rising_rows(const Readings& r) {
  if (r.size() < 8) return 0;
  const std::vector<double> smooth = running_median(r.torque);
  const auto peak = std::max_element(smooth.begin(), smooth.end());
  const double low = *peak - std::max(6.0 * scatter_of(r.torque), 0.05 * *peak);
  const auto limit = static_cast<std::size_t>(peak - smooth.begin());
  std::size_t n = 0;
  while (n < limit && smooth[n] < low) ++n;
  return n;
}

/// Rows with a torque from the start of the shear on; times counted from there.
Readings readings_of(const TorqueRecord& record, FitResult& result) {
  Readings all;
  for (std::size_t i = 0; i < record.torque.size(); ++i) {
    if (record.time[i] < 0.0)
      drop(result, record.line[i], record.time[i], record.torque[i], "before time 0");
    else if (record.torque[i] <= 0.0)
      drop(result, record.line[i], record.time[i], record.torque[i], "no torque");
    else
      all.push(record.time[i], record.torque[i], 1.0, record.line[i]);
  }
  const std::size_t rising = rising_rows(all);
  std::vector<char> leave_out(all.size(), 0);
  for (std::size_t i = 0; i < rising; ++i) {
    drop(result, all.line[i], all.x[i], all.torque[i], "before the torque's peak");
    leave_out[i] = 1;
  }
  Readings kept = without(all, leave_out);
  if (kept.size() < 2) return kept;
  const double step = (kept.x.back() - kept.x.front()) / static_cast<double>(kept.size() - 1);
  if (rising > 0 || kept.x.front() > 1.5 * step) {
    const double zero = kept.x.front();
    for (double& t : kept.x) t -= zero;
    result.notes.push_back("time: counted from " + std::to_string(zero) +
                           " s of the record, the first row that is used");
  } else {
    result.notes.push_back("time: the shear is taken to start at time 0 of the record");
  }
  return condense(kept, most_readings, result);
}

// --- the fit
// ------------------------------------------------------------------------------------------------------

/// Mean torque over the first or last part of the readings.
double mean_torque(const Readings& r, double from, double to) {
  const auto n = static_cast<double>(r.size());
  const auto begin = static_cast<std::size_t>(from * n);
  const auto end = std::max(begin + 1, static_cast<std::size_t>(std::ceil(to * n)));
  return median({r.torque.begin() + static_cast<std::ptrdiff_t>(begin),
                 r.torque.begin() + static_cast<std::ptrdiff_t>(end)});
}

/// Which of the four parameters are free, and how a vector of those maps to all of them.
struct Layout {
  std::vector<std::size_t> free;
  DecayParameters all{};

  DecayParameters with(std::span<const double> p) const {
    DecayParameters result = all;
    for (std::size_t k = 0; k < free.size(); ++k) result[free[k]] = p[k];
    return result;
  }
  std::optional<std::size_t> place_of(std::size_t index) const {
    const auto at = std::find(free.begin(), free.end(), index);
    if (at == free.end()) return std::nullopt;
    return static_cast<std::size_t>(at - free.begin());
  }
};

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
  const double tau_end = yield_stress_from_torque(end, mu, *in.omega, in.instrument);
  const double tau_start = yield_stress_from_torque(start, mu, *in.omega, in.instrument);
  const double smallest = 1e-3 * shear_stress_at(in.instrument.vane_radius, end, in.instrument);
  const double tau_0 = in.tau_0.value_or(std::max(0.6 * tau_end, smallest));
  if (!in.tau_0) layout.free.insert(layout.free.begin(), i_tau_0);
  layout.free.push_back(i_lambda);
  layout.free.push_back(i_alpha);
  layout.all = {tau_0, mu, std::max(0.05, tau_start / tau_0 - 1.0), 0.0};
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

/// The sum of squares has side minima in alpha where nothing breaks down or all does at once: look over five
/// decades.
void search_alpha(const DecayModel& model, const Readings& r, const FitInput& in, Layout& layout) {
  const double unit = 1.0 / (newtonian_shear_rate(*in.omega, in.instrument) * r.x.back());
  std::vector<double> fitted(r.size());
  double best = std::numeric_limits<double>::infinity();
  for (double factor = 0.03; factor < 2000.0; factor *= 2.5) {
    DecayParameters p = layout.all;
    p[i_alpha] = factor * unit;
    if (!evaluate(model, p, fitted)) continue;
    double sum = 0.0;  // absolute values: an outlier must not decide
    for (std::size_t i = 0; i < r.size(); ++i) sum += r.count[i] * std::abs(r.torque[i] / fitted[i] - 1.0);
    if (sum < best) {
      best = sum;
      layout.all[i_alpha] = p[i_alpha];
    }
  }
  if (!std::isfinite(best))
    throw std::runtime_error("the thixotropic Couette model has no solution for this record");
}

/// Forward differences: the model's own error, 1e-6, moves them by 1e-3 of the derivative.
bool fill_jacobian(const DecayModel& model, const Layout& layout, const DecayParameters& p,
                   std::span<const double> fitted, std::span<double> jacobian) {
  std::vector<double> moved(fitted.size());
  const double floors[] = {0.1, 0.1, 0.05, 1e-4};
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
  const DecayParameters lower{1e-6, 1e-6, 0.0, 0.0}, upper{1e6, 1e6, 1e4, 1e3};
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

// --- the report
// ---------------------------------------------------------------------------------------------------

/// Error of a parameter by the model's grid and tolerance, relative: no interval is narrower than this.
constexpr double model_error = 5e-4;

/// Estimates of the parameters and of what follows from them, by the delta method.
struct Teller {
  const Layout& layout;
  const LeastSquaresFit& fit;
  DecayParameters p;

  /// A gradient over the four parameters as a variance; empty where it leans on a parameter that is not told.
  std::optional<double> variance(const DecayParameters& gradient) const {
    const std::size_t n = layout.free.size();
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double g = gradient[layout.free[i]];
      if (g != 0.0 && !fit.told[i]) return std::nullopt;
      for (std::size_t k = 0; k < n; ++k) sum += g * gradient[layout.free[k]] * fit.covariance[i * n + k];
    }
    return sum;
  }

  std::optional<Estimate> operator()(double value, const DecayParameters& gradient, double scale) const {
    const auto v = variance(gradient);
    const double own = model_error * value;
    return v ? tell(value, *v + own * own, fit.degrees_of_freedom, scale) : std::nullopt;
  }
};

void report_parameters(const Readings& r, const Teller& told, const FitInput& in, FitResult& result) {
  const auto& [tau_0, mu, lambda_0, alpha] = told.p;
  const double stress = shear_stress_at(in.instrument.vane_radius, told.fit.fitted.front(), in.instrument);
  const double rate = newtonian_shear_rate(*in.omega, in.instrument);
  result.tau_0 = in.tau_0 ? given(tau_0) : told(tau_0, {1, 0, 0, 0}, tau_0);
  result.mu = in.mu ? given(mu) : told(mu, {0, 1, 0, 0}, mu);
  result.lambda_0 = told(lambda_0, {0, 0, 1, 0}, std::max(lambda_0, 0.5));
  result.static_yield_stress = told((1 + lambda_0) * tau_0, {1 + lambda_0, 0, tau_0, 0}, stress);
  if (lambda_0 > 0.0) result.alpha = told(alpha, {0, 0, 0, 1}, std::max(alpha, 1.0 / (rate * r.x.back())));
  if (in.rest)
    result.A_thix = told(lambda_0 * tau_0 / *in.rest, {lambda_0 / *in.rest, 0, tau_0 / *in.rest, 0},
                         std::max(lambda_0 * tau_0, 0.5 * tau_0) / *in.rest);
  const auto note = [&](const std::optional<Estimate>& e, const char* name, const char* why) {
    if (!e) result.notes.push_back(std::string(name) + ": the record cannot tell it" + why);
  };
  note(result.tau_0, "yield_stress", " at one speed together with the others; --yield-stress gives it");
  note(result.mu, "plastic_viscosity",
       " at one speed together with the others; --plastic-viscosity gives it");
  note(result.lambda_0, "flocculation_start", "");
  note(result.alpha, "alpha", "");
  if (in.rest)
    note(result.A_thix, "structuration_rate", "");
  else
    result.notes.push_back("structuration_rate: needs the rest before the test, --rest");
}

void report_flow(const Readings& r, const DecayParameters& p, const FitInput& in, FitResult& result) {
  CouetteFlow flow;
  flow.bingham = {p[i_tau_0], p[i_mu]};
  flow.omega = *in.omega;
  flow.thixotropy = {in.rest ? p[i_lambda] * p[i_tau_0] / *in.rest : 0.0, p[i_alpha], in.kinetics, in.gamma_c,
                     p[i_lambda]};
  const CouetteDecay d =
      thixotropic_couette(flow, std::vector{0.0, 0.5 * r.x.back(), r.x.back()}, in.instrument);
  result.sheared_radius = *std::min_element(d.sheared_radius.begin(), d.sheared_radius.end());
  result.plug = *result.sheared_radius < in.instrument.container_radius * (1.0 - 1e-9);
}

/// The paper's reading. Its lambda = 0 is the torque of the dynamic material, where tau_0 and mu are known or
/// told.
void report_apparent(const Readings& r, const FitInput& in, const Teller& told, FitResult& result) {
  ApparentReading a;
  const double tau_0 = told.p[i_tau_0], mu = told.p[i_mu];
  const bool dynamic = result.tau_0 && result.mu;
  a.offset_torque =
      dynamic ? reiner_riwlin({tau_0, mu}, *in.omega, in.instrument).torque : mean_torque(r, 0.9, 1.0);
  a.offset = dynamic ? "Reiner-Riwlin torque of the dynamic yield stress and plastic viscosity"
                     : "median of the last tenth of the record";
  a.newtonian_rate = newtonian_shear_rate(*in.omega, in.instrument);
  if (dynamic && result.lambda_0)
    a.rate_at_vane = (shear_stress_at(in.instrument.vane_radius, told.fit.fitted.front(), in.instrument) -
                      static_yield_stress(told.p[i_lambda], tau_0)) /
                     mu;
  for (const double torque : result.curve.observed)
    result.lambda_apparent.push_back(apparent_lambda(torque, a.offset_torque, tau_0, in.instrument));
  const double end = r.x.back();
  for (const double window : {2.0, 5.0, 10.0, 20.0, std::numeric_limits<double>::infinity()}) {
    if (std::isfinite(window) && window >= end) continue;
    const double used = std::min(window, end);
    const auto c = exponential_coefficient(result.curve.x, result.lambda_apparent, used);
    if (!c) continue;
    a.windows.push_back({used, *c, *c / a.newtonian_rate,
                         a.rate_at_vane ? std::optional(*c / *a.rate_at_vane) : std::nullopt});
  }
  if (!a.windows.empty()) result.apparent = a;
}

/// Where a smooth curve through the record would leave far less than the model does, and neighbours miss on the same
/// side, the misfit is the model's. The record's own noise is taken from second differences of the residuals.
bool model_misses(const LeastSquaresFit& fit, FitResult& result) {
  std::vector<double> residual, second;
  double square = 0.0;
  for (std::size_t i = 0; i < fit.residual.size(); ++i) {
    if (fit.outlier[i]) continue;
    residual.push_back(fit.residual[i]);
    square += fit.residual[i] * fit.residual[i];
  }
  if (residual.size() < 10) return false;
  for (std::size_t i = 2; i < residual.size(); ++i)
    second.push_back(residual[i] - 2.0 * residual[i - 1] + residual[i - 2]);
  const double noise = robust_deviation(second) / std::sqrt(6.0);
  const double misfit = std::sqrt(square / static_cast<double>(residual.size()));
  if (misfit < 0.02 || misfit > 0.25 || misfit < 3.0 * noise || result.correlation < 0.5) return false;
  const auto percent = [](double v) {
    return std::to_string(0.1 * static_cast<double>(std::lround(1000.0 * v))).substr(0, 4);
  };
  result.reasons.push_back("the model does not fit: it misses the readings by " + percent(misfit) +
                           " % where they scatter by " + percent(noise) +
                           " % about a smooth curve, and neighbours miss alike (correlation " +
                           std::to_string(result.correlation).substr(0, 4) +
                           "): the decay has another shape than these kinetics give it");
  return true;
}

}  // namespace

FitResult fit_torque_decay(const TorqueRecord& record, const FitInput& in) {
  if (!in.omega)
    throw std::invalid_argument("a torque decay needs the speed of the vane: --speed \"0.25 rev/s\"");
  FitResult result;
  result.kind = RecordKind::torque_decay;
  const Readings r = readings_of(record, result);
  const std::size_t unknowns = 2 + !in.tau_0 + !in.mu;
  if (r.size() <= unknowns)
    throw std::invalid_argument("a torque decay needs more than " + std::to_string(unknowns) + " rows for " +
                                std::to_string(unknowns) + " unknowns; " + std::to_string(r.size()) +
                                " found");
  if (!(r.x.back() > 0.0)) throw std::invalid_argument("all rows have the same time");

  Layout layout = first_guess(r, in);
  // so many rows tell more than the usual grid's error of 1e-4 of the torque
  const DecayModel model(in, r.x, record.torque.size() > 20000 ? 200 : 100);
  search_alpha(DecayModel(in, r.x, 40), r, in, layout);  // it only has to tell the valley
  const LeastSquaresFit fit = least_squares(model, r, layout);
  const Teller told{layout, fit, layout.with(fit.parameters)};
  report(r, fit, result);
  // Whatever makes the fit not to be trusted, a record of one speed then splits its torque into neither.
  const bool misses = model_misses(fit, result) || !result.reasons.empty();
  report_parameters(r, told, in, result);
  report_flow(r, told.p, in, result);
  report_apparent(r, in, told, result);
  if (misses && !in.mu) {
    result.mu.reset();
    result.notes.push_back(
        "plastic_viscosity: one speed and a model that does not fit do not tell it; --plastic-viscosity "
        "gives it");
  }
  if (misses && !in.tau_0) {
    result.tau_0.reset();
    result.notes.push_back(
        "yield_stress: one speed and a model that does not fit do not tell it; --yield-stress gives it");
  }
  return result;
}

}  // namespace tremie::fitting
