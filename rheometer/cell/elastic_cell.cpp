#include "rheometer/cell/elastic_cell.hpp"

#include <algorithm>
#include <cmath>

namespace tremie {

namespace {

constexpr double tolerance = 1e-6;             ///< of a substep, of the stress
constexpr double shortest = 1e-9;              ///< substep, of the step: the law has kinks
constexpr int most_iterations = 50;            ///< of lambda with the rate that breaks it down
constexpr double sdirk = 0.29289321881345248;  ///< 1 - 1/sqrt 2: L-stable

struct Trial {
  ElasticCell cell;
  double error = 0.0;  ///< relative
};

double update_lambda(const ElasticCell& from, const Mix& mix, double plastic_rate, double h,
                     std::vector<double>& parts) {
  if (!mix.thixotropy) return 0.0;
  parts = from.parts;
  return flocculation_step(from.lambda, *mix.thixotropy, mix.tau_0, from.plastic_rate, plastic_rate, h,
                           [&](std::size_t i) -> double& { return parts[i]; });
}

/// One substep; the shear rate goes from g_0 to g_1.
Trial try_substep(const ElasticCell& from, const Mix& mix, const YieldLaw& law, double g_0, double g_1,
                  double h) {
  const double G = mix.G, implicit = sdirk * h * G, g_middle = g_0 + sdirk * (g_1 - g_0);
  const auto tau_y = [&](double lambda) { return static_yield_stress(lambda, mix.tau_0); };
  Trial t{from};
  double rate = from.plastic_rate;
  t.cell.lambda = update_lambda(from, mix, rate, h, t.cell.parts);
  bool settled = false;
  for (int i = 0; i < most_iterations && !settled; ++i) {
    const double at_middle = tau_y(from.lambda + sdirk * (t.cell.lambda - from.lambda));
    const double middle = from.stress + implicit * g_middle;
    const double slope = G * (g_middle - prox(law, middle, at_middle, mix.mu + implicit));
    const double end = from.stress + (1.0 - sdirk) * h * slope + implicit * g_1;
    rate = prox(law, end, tau_y(t.cell.lambda), mix.mu + implicit);
    t.cell.stress = end - implicit * rate;
    const double before = t.cell.lambda;
    t.cell.lambda = update_lambda(from, mix, rate, h, t.cell.parts);
    settled = std::abs(t.cell.lambda - before) <= 1e-13 * (1.0 + before);
  }
  t.cell.plastic_rate = rate;
  const double elastic = from.stress + h * G * g_1;
  const double euler = elastic - h * G * prox(law, elastic, tau_y(t.cell.lambda), mix.mu + h * G);
  t.error = settled ? std::abs(t.cell.stress - euler) / std::max(tau_y(t.cell.lambda), std::abs(euler)) : 1.0;
  return t;
}

}  // namespace

void advance(ElasticCell& cell, const Mix& mix, const YieldLaw& law, double gamma_0, double gamma_1,
             double dt) {
  if (gamma_0 == 0.0 && gamma_1 == 0.0) cell.strain = 0.0;
  const auto rate_at = [&](double t) { return gamma_0 + (gamma_1 - gamma_0) * t / dt; };
  double now = 0.0, h = cell.substep > 0.0 ? cell.substep : dt;
  while (now < dt) {
    const bool last = h >= (dt - now) * (1.0 - 1e-9);
    const double length = last ? dt - now : h, g_0 = rate_at(now), g_1 = last ? gamma_1 : rate_at(now + h);
    Trial t = try_substep(cell, mix, law, g_0, g_1, length);
    const bool good = t.error <= tolerance || length <= shortest * dt;
    const double longer =
        length * std::clamp(0.9 * std::sqrt(tolerance / std::max(t.error, 1e-300)), 0.2, 5.0);
    h = std::max(longer, shortest * dt);
    if (!good) continue;
    t.cell.strain += 0.5 * (g_0 + g_1) * length;
    if (t.cell.stress > t.cell.largest_stress)
      t.cell.largest_stress = t.cell.stress, t.cell.strain_at_largest_stress = t.cell.strain;
    cell = std::move(t.cell);
    now = last ? dt : now + length;
  }
  cell.substep = h;
}

}  // namespace tremie
