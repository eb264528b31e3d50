// Case 3: a column at rest under its own weight, and a body that rotates freely.

#include <fmt/format.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"
#include "apparatus/verification/suite.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::verification {
namespace {

constexpr double rho = 2400.0, g = gravity, height = 0.3;

/// Worst pressure error in a point after a second, in units of rho g H, of a column `levels` cells high.
template <class Geometry>
Run column_at_rest(int levels, double tau_0) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  const double start = cpu_seconds(), h = height / levels;
  ImplicitBody<Geometry> body;
  body.mix = bodies::concrete(tau_0, 35.8);
  body.gravity[up] = -g;
  Vec<D> low = Vec<D>::Zero(), high = Vec<D>::Constant(2 * h);
  for (Axis& a : body.grid.axes)
    a = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 2};
  body.grid.axes[up] = {.h = h, .low = FaceKind::no_slip};
  high[up] = height;
  bodies::fill_box<Geometry>(body, low, high, 2, [&](const auto& x) { return rho * g * (height - x[up]); });
  StepSettings settings;
  settings.dt_max = 0.05;
  int unconverged_steps = 0;
  while (body.time < 1.0) unconverged_steps += !implicit_step(body, ExactBingham{}, settings).converged;
  double worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double head = pressure(body.points.ln_J[p], body.mix.K) / (rho * g);
    worst = std::max(worst, std::abs(head - (height - body.points.x[p][up])) / height);
  }
  return {fmt::format("{} cells over the height", levels), h, worst, cpu_seconds() - start,
          unconverged(unconverged_steps)};
}

Problem hydrostatic(Depth depth) {
  Problem one{.name = "hydrostatic",
              .title = "Hydrostatic pressure",
              .equation = "∇p = ρg, a column between free-slip walls, 54 Pa; 1 s",
              .reference = "p = ρg(H − z)",
              .norm = "largest |p − p_exact| / ρgH over the points",
              .series = {{"plane strain", {}}, {"axisymmetric", {}}, {"3D", {}}, {"plane, Newtonian", {}}},
              .notes = {"One pressure a cell balances a weight up to a pressure of alternating sign, ρgh/6, "
                        "below a free surface: first order, and 1 % needs 40 cells over the height."}};
  for (int levels : {10, 20, 40, 80}) {
    if (levels == 80 && depth == Depth::quick) break;
    one.series[0].runs.push_back(column_at_rest<PlaneStrain>(levels, 54.0));
    one.series[1].runs.push_back(column_at_rest<Axisymmetric>(levels, 54.0));
    if (levels <= 40) one.series[2].runs.push_back(column_at_rest<ThreeD>(levels, 54.0));
    one.series[3].runs.push_back(column_at_rest<PlaneStrain>(levels, 0.0));
  }
  bound_errors(one, ": error at 40 cells", 0.01, 2);
  return one;
}

/// Drift of the angular momentum of a freely rotating square over steps of 1 ms.
Run free_rotation(int steps) {
  const double start = cpu_seconds(), h = 0.05;
  ImplicitBody<PlaneStrain> body;
  body.mix = bodies::concrete(54.0, 35.8);
  for (Axis& a : body.grid.axes) a.h = h;
  bodies::fill_box(body, Vec<2>(-0.1, -0.1), Vec<2>(0.1, 0.1), 2);
  Mat<2, 2> W;
  W << 0.0, -2.0, 2.0, 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    body.points.C[p] = W;
    body.points.v[p] = W * body.points.x[p];
  }
  const auto before = bodies::angular_momentum<2>(body);
  StepSettings settings;
  settings.fixed_dt = 1e-3;
  for (int i = 0; i < steps; ++i) implicit_step(body, ExactBingham{}, settings);
  const double drift = (bodies::angular_momentum<2>(body) - before).norm() / before.norm();
  return {fmt::format("{} steps", steps), 0.0, drift, cpu_seconds() - start};
}

}  // namespace

Case rest_case(Depth depth) {
  omp_set_num_threads(1);
  Problem rotation{.name = "rotation",
                   .title = "Free rotation",
                   .equation = "d/dt Σ m (x × v + spin) = 0",
                   .reference = "its start",
                   .norm = "relative drift of the angular momentum",
                   .series = {{"APIC, implicit", {free_rotation(1000)}}}};
  rotation.bounds = {
      {.what = "drift over 1000 steps", .value = rotation.series[0].runs[0].error, .limit = 1e-10}};
  return {3, "Bodies at rest and in rigid motion", {hydrostatic(depth), rotation}};
}

}  // namespace tremie::verification
