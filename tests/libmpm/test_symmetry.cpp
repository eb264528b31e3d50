// Planes of symmetry: half a body, or a quarter, is the whole one.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie {
namespace {

using namespace bodies;

/// A block on the floor, free to slump; the whole of it, or the quarter between two planes of symmetry.
ImplicitBody<ThreeD> slumping(bool quarter, FaceKind floor) {
  ImplicitBody<ThreeD> body;
  body.mix = concrete(54.0, 35.8, 1e6);
  body.gravity[2] = -9.81;
  for (int d = 0; d < 2; ++d)
    body.grid.axes[d] = {.h = 0.02, .low = quarter ? FaceKind::symmetry : FaceKind::open};
  body.grid.axes[2] = {.h = 0.015, .low = floor};
  const Vec<3> high(0.06, 0.08, 0.09), low = quarter ? Vec<3>(0, 0, 0) : Vec<3>(-0.06, -0.08, 0.0);
  fill_box(body, low, high, 2);
  return body;
}

/// Largest difference of velocities between points that started at the same place.
template <int D>
double difference(const Points<D>& part, const Points<D>& start, const Points<D>& whole,
                  const Points<D>& whole_start) {
  double worst = 0.0;
  int found = 0;
  for (std::size_t p = 0; p < part.size(); ++p)
    for (std::size_t q = 0; q < whole.size(); ++q)
      if ((start.x[p] - whole_start.x[q]).norm() < 1e-9) {
        worst = std::max(worst, (part.v[p] - whole.v[q]).norm());
        ++found;
      }
  EXPECT_EQ(found, static_cast<int>(part.size()));
  return worst;
}

template <class Geometry>
double difference_after(int steps, ImplicitBody<Geometry> part, ImplicitBody<Geometry> whole,
                        const StepSettings& settings) {
  omp_set_num_threads(1);
  const auto part_start = part.points, whole_start = whole.points;
  for (int i = 0; i < steps; ++i) {
    EXPECT_TRUE(implicit_step(part, ExactBingham{}, settings).converged);
    EXPECT_TRUE(implicit_step(whole, ExactBingham{}, settings).converged);
  }
  return difference(part.points, part_start, whole.points, whole_start);
}

StepSettings settings_with(int direct_below) {
  StepSettings settings;
  settings.admm.direct_below = direct_below;
  settings.admm.max_iterations = 4000;
  settings.particle_shifting.on = true;
  settings.fixed_dt = 0.01;
  settings.wall_law = Coulomb{0.3};
  return settings;
}

// The factorised systems are the same but for the order of their sums. The body slumps at 0.3 m/s.
TEST(Symmetry, QuarterIsTheWholeWithFactorisedSystems) {
  for (const FaceKind floor : {FaceKind::no_slip, FaceKind::wall_law})
    EXPECT_LE(difference_after(2, slumping(true, floor), slumping(false, floor), settings_with(1'000'000)),
              1e-9);
}

// By iteration both are solved to the tolerance alone, 1e-5 of the stresses: 2e-5 m/s, as in
// test_3d_solver.cpp. With the splines of a slippery wall they would differ by 1.6e-3 m/s.
TEST(Symmetry, QuarterIsTheWholeByIteration) {
  StepSettings settings = settings_with(0);
  settings.admm.tolerance = 1e-5;
  const double symmetric =
      difference_after(3, slumping(true, FaceKind::no_slip), slumping(false, FaceKind::no_slip), settings);
  ImplicitBody<ThreeD> walled = slumping(true, FaceKind::no_slip);
  for (int d = 0; d < 2; ++d) walled.grid.axes[d].low = FaceKind::free_slip;
  const double slippery =
      difference_after(3, std::move(walled), slumping(false, FaceKind::no_slip), settings);
  std::printf("quarter and whole differ by %.1e m/s, with slippery walls by %.1e m/s\n", symmetric, slippery);
  EXPECT_LE(symmetric, 2e-5);
  EXPECT_GE(slippery, 5e-4);
}

// In a plane, by Newton's method too, and with the plane of symmetry at the high end.
TEST(Symmetry, HalfIsTheWholeInAPlane) {
  for (const YieldMethod method : {YieldMethod::admm, YieldMethod::newton})
    for (const bool at_high_end : {false, true}) {
      ImplicitBody<PlaneStrain> half, whole;
      for (ImplicitBody<PlaneStrain>* body : {&half, &whole}) {
        body->mix = concrete(54.0, 35.8, 1e6);
        body->gravity[1] = -9.81;
        body->grid.axes[0] = {.h = 0.02};
        body->grid.axes[1] = {.h = 0.015, .low = FaceKind::no_slip};
      }
      const double x = at_high_end ? -0.08 : 0.0;
      Axis& across = half.grid.axes[0];
      across = at_high_end ? Axis{.h = 0.02, .origin = -0.2, .high = FaceKind::symmetry, .n_cells = 10}
                           : Axis{.h = 0.02, .low = FaceKind::symmetry};
      fill_box(half, Vec<2>(x, 0.0), Vec<2>(x + 0.08, 0.09), 2);
      fill_box(whole, Vec<2>(-0.08, 0.0), Vec<2>(0.08, 0.09), 2);
      StepSettings settings = settings_with(0);
      settings.method = method;
      EXPECT_LE(difference_after(2, std::move(half), std::move(whole), settings),
                method == YieldMethod::newton ? 1e-5 : 1e-9);
    }
}

// Beyond some thousand cells the pressures are found by iteration instead of with a factor.
TEST(Symmetry, TwoLevelPcgAgreesWithTheFactor) {
  omp_set_num_threads(1);
  for (const double K : {33e3, 1e6}) {
    ImplicitBody<ThreeD> factorised = slumping(true, FaceKind::no_slip),
                         iterated = slumping(true, FaceKind::no_slip);
    factorised.mix.K = iterated.mix.K = K;
    const auto start = factorised.points;
    StepSettings settings = settings_with(0), by_iteration = settings;
    settings.admm.tolerance = by_iteration.admm.tolerance = 1e-5;
    settings.fixed_dt = by_iteration.fixed_dt = 0.02;
    by_iteration.admm.most_band_operations = 0.0;
    for (int i = 0; i < 2; ++i) {
      EXPECT_TRUE(implicit_step(factorised, ExactBingham{}, settings).converged);
      EXPECT_TRUE(implicit_step(iterated, ExactBingham{}, by_iteration).converged);
    }
    EXPECT_LE(difference(iterated.points, start, factorised.points, start), 2e-5);
    std::printf("K = %.0f kPa: %lld products with a factor, %lld by iteration\n", 1e-3 * K,
                factorised.matrix_free.products, iterated.matrix_free.products);
    EXPECT_LE(iterated.matrix_free.products, 2 * factorised.matrix_free.products);
  }
}

// The node behind the plane: half a cell behind it, the splines those of an axis without an end.
TEST(Symmetry, SplinesAreThoseInside) {
  const Axis axis{
      .h = 0.3, .origin = -1.0, .low = FaceKind::symmetry, .high = FaceKind::symmetry, .n_cells = 2},
      inside{.h = 0.3, .origin = -1.0};
  EXPECT_DOUBLE_EQ(axis.node_position(0), -1.15);
  EXPECT_EQ(axis.mirrored(0), 1);
  EXPECT_EQ(axis.mirrored(1), 1);
  EXPECT_EQ(axis.mirrored(2), 2);
  EXPECT_EQ(axis.mirrored(3), 2);
  for (int c = 0; c < 2; ++c)
    for (const double s : {0.0, 0.3, 1.0}) {
      const SplineValues a = splines(axis, c, s), b = splines(inside, c, s);
      EXPECT_EQ(a.N, b.N);
      EXPECT_EQ(a.dN, b.dN);
    }
}

}  // namespace
}  // namespace tremie
