#pragma once

// A Newtonian patch that spreads on a no-slip floor, followed over a decade of time from a state of Huppert's
// similarity solution: mu = 200 Pa s, radius 300 mm, 30 mm deep (R/h = 10, and rho h^2/mu = 0.01 s, so
// inertia is nothing). No virtual origin of time: the start lies on the solution.

#include <omp.h>

#include "apparatus/parts/cone/spread.hpp"
#include "apparatus/verification/references/bodies.hpp"
#include "apparatus/verification/references/lubrication.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::verification {

/// A round patch on a no-slip floor with depth h(r), in hydrostatic balance.
template <class Depth>
ImplicitBody<Axisymmetric> patch(const Mix& mix, double across, double up, double R, double top,
                                 Depth depth) {
  ImplicitBody<Axisymmetric> body;
  body.mix = mix;
  body.gravity = {0.0, -gravity};
  body.grid.axes[0] = {.h = across, .low = FaceKind::free_slip};
  body.grid.axes[1] = {.h = up, .low = FaceKind::no_slip};
  const std::array<int, 2> n{static_cast<int>(std::ceil(R / across)) * 6,
                             static_cast<int>(std::ceil(top / up)) * 4};
  seed_box<Axisymmetric>(
      {0.0, 0.0}, {n[0] * across / 6, n[1] * up / 4}, n, mix.density, mix.K,
      [&](const Vec<2>& x) { return x[1] < depth(x[0]); },
      [&](const Vec<2>& x) { return mix.density * gravity * (depth(x[0]) - x[1]); }, body.points);
  return body;
}

/// A fit of log R over log t over the whole decade.
struct HuppertFit {
  double exponent, prefactor;  ///< 1/8 and 0.894
  double worst;                ///< relative error of the radius at any step
  double volume_error;         ///< of the points' volume against the patch's
  int steps, unconverged;
};

inline HuppertFit huppert_decade(double across, double up) {
  omp_set_num_threads(1);
  const double R = 0.3, mu = 200.0, V = 0.75 * std::numbers::pi * R * R * 0.03, nu = mu / 2400.0;
  const double start = std::pow(R / huppert_prefactor, 8) * 3.0 * nu / (gravity * V * V * V);
  auto body =
      patch(bodies::concrete(0.0, mu), across, up, R, 0.03, [&](double r) { return huppert_depth(V, R, r); });
  const double V_points = bodies::total_volume(body.points);
  body.time = start;
  StepSettings settings;
  settings.dt_max = 0.5;
  settings.particle_shifting.on = true;  // a body that flows far; without it the exponent comes out 4 % high
  std::vector<double> x, y;
  int unconverged = 0;
  while (body.time < 10.0 * start) {
    unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
    x.push_back(std::log(body.time));
    y.push_back(std::log(0.5 * cone::spread(body.points, across)));
  }
  // Evenly in log t: each sample weighs what its step covers.
  double w = 0, mx = 0, my = 0, sxx = 0, sxy = 0, worst = 0;
  for (std::size_t i = 1; i < x.size(); ++i)
    w += x[i] - x[i - 1], mx += (x[i] - x[i - 1]) * x[i], my += (x[i] - x[i - 1]) * y[i];
  mx /= w, my /= w;
  for (std::size_t i = 1; i < x.size(); ++i) {
    sxx += (x[i] - x[i - 1]) * (x[i] - mx) * (x[i] - mx);
    sxy += (x[i] - x[i - 1]) * (x[i] - mx) * (y[i] - my);
    worst = std::max(worst,
                     std::abs(std::exp(y[i]) / huppert_radius(V_points, nu, gravity, std::exp(x[i])) - 1.0));
  }
  const double prefactor =
      std::exp(my - mx / 8.0) / std::pow(gravity * V_points * V_points * V_points / (3.0 * nu), 0.125);
  return {sxy / sxx, prefactor, worst, V_points / V - 1.0, static_cast<int>(x.size()), unconverged};
}

}  // namespace tremie::verification
