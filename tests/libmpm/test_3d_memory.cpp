// What a large body in space costs in memory, in bytes that the process held at most.

#include <gtest/gtest.h>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/step.hpp"
#include "tests/peak_memory.hpp"

namespace tremie {
namespace {

/// Two steps of a thixotropic block of n^3 full cells, 8 points each, that slumps on a floor.
bool slumps(int n) {
  ImplicitBody<ThreeD> body;
  body.mix = bodies::concrete(54.0, 35.8, 1e6);
  body.gravity[2] = -9.81;
  const double h = 0.3 / n;
  for (Axis& a : body.grid.axes) a.h = h;
  body.grid.axes[2].low = FaceKind::no_slip;
  bodies::fill_box<ThreeD>(body, Vec<3>::Zero(), Vec<3>::Constant(0.3), 2,
                           [&](const auto& x) { return 2400.0 * 9.81 * (0.3 - x[2]); });
  body.mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.01}};
  shrink(body.points);
  body.points.lambda.assign(body.points.size(), 0.0);
  body.points.gamma_dot.assign(body.points.size(), 0.0);
  StepSettings settings;
  settings.particle_shifting.on = true;
  settings.time_error = 0.005;
  settings.admm.tolerance = 4e-3;
  for (int i = 0; i < 2; ++i)
    if (!implicit_step(body, ExactBingham{}, settings).converged) return false;
  return true;
}

// From 64,000 to 140,608 points the peak grows by what a point costs, all told: its state of 160 bytes, grid,
// solver, evening-out. It is 333; the aim is 400.
TEST(Memory3D, BytesAPointOfALargeBody) {
  if (!test::memory_can_be_measured) GTEST_SKIP() << "the sanitizer's own memory is most of it";
  const double small = test::peak_memory_of([] { return slumps(20); }),
               large = test::peak_memory_of([] { return slumps(26); });
  ASSERT_GT(small, 0.0);
  ASSERT_GT(large, 0.0);
  const double bytes = (large - small) / (8.0 * (26 * 26 * 26 - 20 * 20 * 20));
  std::printf("%.0f bytes a point\n", bytes);
  EXPECT_LE(bytes, 400.0);
}

}  // namespace
}  // namespace tremie
