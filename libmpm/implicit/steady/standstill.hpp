#pragma once

// A body that stands.
//
// Stresses that balance the weight of a body and are nowhere beyond its yield stress hold it for good: structure only builds up
// at rest, so the yield stress does not fall (safe theorem of limit analysis). Steps would leave it in place to the tolerance of
// the yield solver alone, and what that leaves carries points through the grid in a long rest.

#include <algorithm>
#include <cmath>

#include "libmpm/implicit/step_size.hpp"

namespace tremie {

/// Whether the last step, by ADMM, left the body below its yield stress: nowhere is the stress of the solver's own rates beyond it
/// by more than the share `tolerance`, and no point moves faster than a cell's width times the rate that the solver
/// takes for rest. Never by a law that flows at all stresses.
template <class Geometry>
bool is_below_yield(const ImplicitBody<Geometry>& body, const YieldLaw& law, double tolerance) {
  static_assert(Geometry::dim < 3, "in space the rates are packed");
  if (!is_exact(law)) return false;
  const auto& quadrature = body.quadrature;
  for (std::size_t c = 0; c < body.admm_state.rate.size(); ++c)
    for (std::size_t k = 0; k < quadrature.V[c].size(); ++k) {
      const double gamma_dot = body.admm_state.rate[c][k].norm(), tau_y = quadrature.tau_y[c][k];
      const double mu = quadrature.mu.empty() ? body.mix.mu : quadrature.mu[c][k];
      if (mu * gamma_dot + stress(law, gamma_dot, tau_y) - tau_y > tolerance * tau_y) return false;
    }
  return detail::max_speed(body.points) < detail::rate_at_rest * body.grid.cell_size_min();
}

/// Lets the structure of points at rest build up over dt. `mix_of(p)` is a point's mix.
template <int D, class MixOf>
void build_up_at_rest(double dt, const MixOf& mix_of, Points<D>& points) {
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < points.lambda.size(); ++p) {
    const Mix& mix = mix_of(p);
    points.lambda[p] = flocculation_step(points.lambda[p], *mix.thixotropy, mix.tau_0, 0.0, 0.0, dt,
                                         [&](std::size_t i) -> double& { return points.lambda_parts[i][p]; });
    points.gamma_dot[p] = 0.0;
  }
}

/// Lets dt pass over a body that stands: lambda builds up, every point keeps its place, its pressure and its volume.
template <class Geometry>
StepReport stand_still(double dt, ImplicitBody<Geometry>& body) {
  auto& points = body.points;
  for (auto& v : points.v) v.setZero();
  for (auto& C : points.C) C.setZero();
  for (auto& v : body.v) v.setZero();
  build_up_at_rest(
      dt, [&](std::size_t p) -> const Mix& { return body.mix_of(p); }, points);
  body.shear_rate = body.time_error = 0.0;
  body.time += dt;
  return {.dt = dt, .converged = true};
}

}  // namespace tremie
