// Every loop of the library that threads share, for the thread sanitizer: some steps of a block that collapses on a
// floor with friction, with a wall that holds it and a bar in its way, implicit by factors and by iteration, and
// explicit. What the sanitizer reports is the test's result; the numbers are checked elsewhere.

#include <omp.h>

#include <cstdio>

#include "apparatus/verification/references/bodies.hpp"
#include "tests/libmpm/explicit_schemes.hpp"

namespace tremie {
namespace {

using namespace bodies;
using namespace test;

/// A rising wall beside the block, to which it must not come nearer.
template <int D>
RigidWall<D> wall_at(double x) {
  return [x](const Vec<D>& at, double) -> std::optional<WallView<D>> {
    WallView<D> view;
    view.gap = x - at[0];
    view.normal = -Vec<D>::Unit(0), view.velocity = Vec<D>::Zero();
    if (view.gap > 0.05) return std::nullopt;
    return view;
  };
}

template <class Geometry>
ImplicitBody<Geometry> block(double h) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = concrete(54.0, 35.8);
  body.mix.thixotropy = Thixotropy{};
  body.gravity[up] = -9.81;
  for (Axis& a : body.grid.axes) a = {.h = h, .low = D == 3 ? FaceKind::symmetry : FaceKind::free_slip};
  body.grid.axes[up] = {.h = h, .low = FaceKind::wall_law};
  Vec<D> high = Vec<D>::Constant(0.08);
  high[up] = 0.12;
  fill_box<Geometry>(body, Vec<D>::Zero(), high, 3);
  return body;
}

/// `direct_below`: unknowns up to which a step is solved by a factor; `band`: by iteration the pressures are solved by a
/// factor, else by two-level conjugate gradients.
template <class Geometry>
void implicit_steps(double h, int direct_below, bool bar, bool band = true) {
  auto body = block<Geometry>(h);
  if constexpr (Geometry::dim == 3)
    if (bar) add_bar(body.grid.axes, Vec<3>(0.09, 0.02, 0.0), 2, 0.1, 0.012, body.bars);
  StepSettings settings;
  settings.admm.direct_below = direct_below;
  settings.admm.max_iterations = 40;
  if (!band) settings.admm.most_band_operations = 0.0;
  settings.fixed_dt = 0.01;
  settings.wall_gap = 0.3 * h, settings.wall_law = Coulomb{0.3};
  for (int i = 0; i < 4; ++i) implicit_step(body, ExactBingham{}, settings, wall_at<Geometry::dim>(0.085));
}

void explicit_steps(bool single) {
  auto body = collapsing_block();
  ExplicitSettings settings =
      settings_of({StressUpdate::first, false, ShapeFunctions::gimp, true, single}, 1e-4);
  settings.wall_law = Coulomb{0.3}, settings.wall_gap = 0.002;
  auto state = start_explicit(body, ExactBingham{}, settings, shape_of<3>(ShapeFunctions::gimp));
  for (int i = 0; i < 20; ++i) explicit_step(body, law, settings, state, wall_at<3>(0.1));
}

}  // namespace
}  // namespace tremie

int main() {
  using namespace tremie;
  omp_set_num_threads(2);
  implicit_steps<Axisymmetric>(0.01, 1'000'000, false);
  implicit_steps<ThreeD>(0.02, 1'000'000, false);
  implicit_steps<ThreeD>(0.01, 0, true);
  implicit_steps<ThreeD>(0.01, 0, true, false);
  explicit_steps(false);
  explicit_steps(true);
  std::puts("every loop ran");
}
