// Explicit steps: rigid motions, rest, points alone, and the largest stable step.

#include <gtest/gtest.h>
#include <omp.h>

#include <random>

#include "libmpm/explicit/wall_fill.hpp"
#include "tests/libmpm/explicit_schemes.hpp"

namespace tremie {
namespace {

using namespace test;
using namespace bodies;

/// Steps a body from here to there; returns the reports' worst.
template <class Geometry>
ExplicitReport advance(Body<Geometry>& body, const ExplicitSettings& settings,
                       const Shape<Geometry::dim>& shape, int steps, const Papanastasiou& of = law) {
  auto state = start_explicit(body, of, settings, shape);
  ExplicitReport worst;
  for (int i = 0; i < steps && !worst.failed; ++i) {
    const ExplicitReport one = explicit_step(body, of, settings, state);
    worst.max_speed = std::max(worst.max_speed, one.max_speed);
    worst.beyond_limit = worst.beyond_limit || one.beyond_limit;
    worst.failed = one.failed;
  }
  write_back(state, body);
  return worst;
}

template <class Geometry>
class ExplicitSpaces : public testing::Test {
 protected:
  void SetUp() override { omp_set_num_threads(1); }
};
using SpaceTypes = testing::Types<Axisymmetric, PlaneStrain, ThreeD>;
TYPED_TEST_SUITE(ExplicitSpaces, SpaceTypes);

/// A body in free fall, and how far its points are at most from where they belong.
template <class Geometry>
void expect_free_fall(const Scheme& scheme, double off_v, double off_x, double off_ln_J) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  const double dt = 5e-4, t = 400 * dt;
  Body<Geometry> body;
  body.mix = concrete(54.0, 35.8);
  body.gravity[up] = -g;
  for (Axis& a : body.grid.axes) a.h = 0.05;
  if (std::is_same_v<Geometry, Axisymmetric>) body.grid.axes[0].low = FaceKind::free_slip;
  fill_box<Geometry>(body, Vec<D>::Zero(), Vec<D>::Constant(0.1), 2);
  const Points<D> start = body.points;
  EXPECT_FALSE(advance(body, settings_of(scheme, dt), shape_of<D>(scheme.shape), 400).failed);
  for (std::size_t p = 0; p < start.size(); ++p) {
    Vec<D> v = Vec<D>::Zero(), x = start.x[p];
    v[up] = -g * t, x[up] -= 0.5 * g * t * (t + dt);
    EXPECT_LE((body.points.v[p] - v).norm(), off_v * g * t);
    EXPECT_LE((body.points.x[p] - x).norm(), off_x);
    EXPECT_LE(std::abs(body.points.ln_J[p]), off_ln_J);
  }
  EXPECT_EQ(total_mass(body.points), total_mass(start));
}

// v = g t and, with points moved by the velocity at the end of a step, z = -g t (t + dt)/2. Nothing deforms,
// in no scheme; mass stays to the bit. 400 steps take the body through several cells and sortings.
TYPED_TEST(ExplicitSpaces, FreeFall) {
  for (const Scheme& scheme : schemes) expect_free_fall<TypeParam>(scheme, 1e-10, 1e-11, 1e-11);
}

// The same with sums in single precision. A step brings the velocities to the grid and back by a dozen sums,
// each rounded by up to 2^-24 of them; all in one direction that is 400 x 12 x 6e-8 of the velocity, of the
// way g t^2, and, over a cell in 400 steps of dt, of its volume.
TYPED_TEST(ExplicitSpaces, FreeFallInSinglePrecision) {
  const double t = 0.2, rounding = 400 * 12 * 6e-8;
  for (Scheme scheme : schemes) {
    if (scheme.flip || scheme.stress == StressUpdate::last) continue;
    scheme.single = true;
    expect_free_fall<TypeParam>(scheme, rounding, rounding * g * t * t, rounding * g * t * t / 0.05);
  }
}

/// A block that turns and is deformed by nothing but its own inertia.
template <class Geometry>
Body<Geometry> turning(const Eigen::Vector3d& omega) {
  constexpr int D = Geometry::dim;
  Body<Geometry> body;
  body.mix = concrete(54.0, 35.8);
  for (Axis& a : body.grid.axes) a.h = 0.05;
  fill_box<Geometry>(body, Vec<D>::Constant(-0.1), Vec<D>::Constant(0.1), 2);
  Eigen::Matrix3d W;
  W << 0, -omega[2], omega[1], omega[2], 0, -omega[0], -omega[1], omega[0], 0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    body.points.C[p] = W.topLeftCorner<D, D>();
    body.points.v[p] = W.topLeftCorner<D, D>() * body.points.x[p];
  }
  return body;
}

// APIC and stresses that are symmetric keep angular momentum, with pressure by the point. With one row a cell
// a pressure still has no moment: its row is a gradient at one place.
template <class Geometry>
void expect_angular_momentum_kept(const Eigen::Vector3d& omega, StressUpdate stress, bool cell_pressure) {
  omp_set_num_threads(1);
  auto body = turning<Geometry>(omega);
  const auto start = angular_momentum<Geometry::dim>(body);
  const Scheme scheme{stress, false, ShapeFunctions::b_spline, cell_pressure};
  EXPECT_FALSE(advance(body, settings_of(scheme, 5e-4), {}, 400).failed);
  const double drift = (angular_momentum<Geometry::dim>(body) - start).norm() / start.norm();
  std::printf("angular momentum after 400 explicit steps: relative drift %.2g\n", drift);
  EXPECT_LE(drift, 1e-10);
  EXPECT_LE(momentum(body.points).norm(), 1e-10 * start.norm());
}
TEST(ExplicitRotation, InThePlane) {
  for (const bool cell : {false, true}) {
    expect_angular_momentum_kept<PlaneStrain>({0, 0, 2.0}, StressUpdate::last, cell);
    expect_angular_momentum_kept<PlaneStrain>({0, 0, 2.0}, StressUpdate::first, cell);
  }
}
TEST(ExplicitRotation, InSpace) {
  expect_angular_momentum_kept<ThreeD>({0.5, -1.0, 1.5}, StressUpdate::last, true);
}

/// A block that falls apart over a floor.
// Sums in single precision take a collapsing block where sums in double do. In a tenth of a second it falls
// by more than a cell. Roundings grow where points go from one cell into the next, in double precision as
// well: one point may be off by a hundredth of a cell, all of them together by a tenth of that.
TEST(ExplicitSingle, CollapsesAsInDoublePrecision) {
  omp_set_num_threads(1);
  constexpr double h = 0.02;
  for (const ShapeFunctions kind : {ShapeFunctions::b_spline, ShapeFunctions::gimp}) {
    Points<3> ends[2];
    for (const bool single : {false, true}) {
      const Scheme scheme{StressUpdate::first, false, kind, true, single};
      ExplicitSettings settings = settings_of(scheme, 1e-3);
      settings.wall_law = Coulomb{0.3};
      auto body = collapsing_block();
      EXPECT_FALSE(advance(body, settings, shape_of<3>(kind), 100).failed);
      ends[single ? 1 : 0] = body.points;
    }
    const Points<3> start = collapsing_block().points;
    double farthest = 0.0, moved = 0.0;
    Vec<3> together = Vec<3>::Zero();
    for (std::size_t p = 0; p < start.size(); ++p) {
      const Vec<3> off = ends[1].x[p] - ends[0].x[p];
      farthest = std::max(farthest, off.norm()), together += off / static_cast<double>(start.size());
      moved = std::max(moved, (ends[0].x[p] - start.x[p]).norm());
    }
    EXPECT_GT(moved, h);
    EXPECT_GT(farthest, 0.0);
    EXPECT_LE(farthest, 0.01 * h);
    EXPECT_LE(together.norm(), 1e-3 * h);
  }
}

// A column under its own weight between free-slip walls stays as it is: pressures within 3 % of rho g H (one
// pressure a cell on 10 cells over the height: a quarter of a cell's head), nothing faster than 15 mm/s.
// Rings are another matter: two points across a cell integrate d(rN)/dr, a parabola, with an error of 6 % in
// the cell at the axis, so that a uniform pressure is not in balance there; 15 % are allowed.
TYPED_TEST(ExplicitSpaces, HydrostaticStart) {
  constexpr int D = TypeParam::dim, up = TypeParam::up;
  const double H = 0.2;
  for (const Scheme& scheme : schemes) {
    Body<TypeParam> body;
    body.mix = concrete(54.0, 35.8);
    body.gravity[up] = -g;
    for (Axis& a : body.grid.axes)
      a = {.h = 0.02, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 2};
    body.grid.axes[up] = {.h = 0.02, .low = FaceKind::no_slip};
    Vec<D> high = Vec<D>::Constant(0.04);
    high[up] = H;
    fill_box<TypeParam>(body, Vec<D>::Zero(), high, 2,
                        [&](const auto& x) { return 2400.0 * g * (H - x[up]); });
    const auto worst = advance(body, settings_of(scheme, 2e-4), shape_of<D>(scheme.shape), 500);
    double pressure_error = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p)
      pressure_error = std::max(
          pressure_error,
          std::abs(pressure(body.points.ln_J[p], body.mix.K) / (2400.0 * g) - (H - body.points.x[p][up])) /
              H);
    std::printf("hydrostatic start, explicit: worst pressure error %.2e of rho g H, speed %.1e m/s\n",
                pressure_error, worst.max_speed);
    EXPECT_FALSE(worst.failed);
    const bool rings = std::is_same_v<TypeParam, Axisymmetric>;
    EXPECT_LE(pressure_error, rings ? 0.15 : 0.03);
    EXPECT_LE(worst.max_speed, 15e-3);
  }
}

/// Kinetic energy after 400 steps of `share` times the limit over that at the start, from random velocities,
/// walls all around or free in space; infinite if the points ran away.
template <class Geometry>
double growth_of_energy(const Mix& mix, const Papanastasiou& of, ShapeFunctions kind, bool walls,
                        double share) {
  constexpr int D = Geometry::dim;
  Body<Geometry> body;
  body.mix = mix;
  for (Axis& a : body.grid.axes) {
    a = {.h = 0.02};
    if (walls)
      a = {.h = 0.02, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = D == 3 ? 3 : 5};
  }
  if (std::is_same_v<Geometry, Axisymmetric>) body.grid.axes[0].low = FaceKind::free_slip;
  fill_box<Geometry>(body, Vec<D>::Zero(), Vec<D>::Constant(D == 3 ? 0.06 : 0.1), 2);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> u(-1e-6, 1e-6);  // so slow that no point leaves its place
  for (auto& v : body.points.v)
    for (int d = 0; d < D; ++d) v[d] = u(random);
  const double start = kinetic_energy(body.points);
  ExplicitSettings settings;
  const auto limit = stability_limits(mix, of, mix.tau_0, largest_eigenvalues(kind), 0.02);
  settings.fixed_dt = share * limit.together;
  if (advance(body, settings, shape_of<D>(kind), 400, of).failed) return HUGE_VAL;
  return kinetic_energy(body.points) / start;
}

// At the derived limit energy does not grow, for a stiff viscosity (m = 1e4 s) and a stiff volume (K = 2
// GPa), and a step of a few times that runs away: the limit is neither wrong nor idle. The points' velocities
// are smoothed by the transfer in every step, so that more than the limit is borne: how much more is printed.
TYPED_TEST(ExplicitSpaces, StableUpToTheLimit) {
  constexpr int D = TypeParam::dim;
  Mix viscous = concrete(54.0, 35.8, 1e3), stiff = concrete(0.0, 1e-3, 2e9);
  for (const ShapeFunctions kind : {ShapeFunctions::b_spline, ShapeFunctions::gimp})
    for (const bool walls : {false, true})
      for (const bool of_volume : {false, true}) {
        const Mix& mix = of_volume ? stiff : viscous;
        const Papanastasiou of{of_volume ? 1.0 : 1e4};
        const auto growth = [&](double share) {
          return growth_of_energy<TypeParam>(mix, of, kind, walls, share);
        };
        EXPECT_LE(growth(1.0), 1.0);
        double low = 1.0, high = 8.0;
        for (int i = 0; i < (D == 3 ? 3 : 5); ++i) {
          const double middle = std::sqrt(low * high);
          (growth(middle) <= 1.0 ? low : high) = middle;
        }
        std::printf("D = %d %s, %s, %s: stable up to %.2f times the limit\n", D,
                    kind == ShapeFunctions::gimp ? "GIMP" : "splines", walls ? "walls" : "free",
                    of_volume ? "K = 2 GPa" : "m = 1e4 s", low);
        EXPECT_LT(low, 7.0);
      }
}

// Points in a cell at a wall stand for the whole cell where it is inside the body: twice their volume where
// its lower half is empty. In the outermost cells of the body, whose extent the points alone tell, for their
// own.
TEST(ExplicitWalls, HollowCellsHoldAsFullOnes) {
  omp_set_num_threads(1);
  for (const FaceKind floor : {FaceKind::no_slip, FaceKind::wall_law, FaceKind::free_slip}) {
    Body<PlaneStrain> body;
    body.mix = concrete(54.0, 35.8);
    body.grid.axes[0] = {.h = 0.02};
    body.grid.axes[1] = {.h = 0.02, .low = floor};
    fill_box<PlaneStrain>(body, {0.0, 0.01}, {0.1, 0.07}, 4);
    const auto state = start_explicit(body, law, {}, shape_of<2>(ShapeFunctions::gimp, 0.125));
    const detail::CellFills<PlaneStrain> fills(state);
    for (int i = 0; i < 5; ++i) {
      const bool inside = i > 0 && i < 4 && floor != FaceKind::free_slip;
      EXPECT_NEAR(represented_volume<PlaneStrain>(fills, body.grid.axes, {i, 0}), inside ? 2.0 : 1.0, 1e-12);
      EXPECT_EQ(represented_volume<PlaneStrain>(fills, body.grid.axes, {i, 1}), 1.0);
    }
  }
}

/// ln J of a point alone in open space, over what it was at first, after 20 steps of `share` times the step
/// that its own ringing allows. `place`: in its cell, in each direction; `inertia`: the second moment of its
/// weights there, in cells squared.
template <class Geometry>
double ringing_of_one_point(double place, double inertia, double share) {
  constexpr int D = Geometry::dim;
  constexpr double h = 0.02, ln_J = 1e-14;
  Body<Geometry> body;
  body.mix = concrete(0.0, 1e-9, 2e9);
  for (Axis& a : body.grid.axes) a = {.h = h};
  const double V = std::pow(0.5 * h, D);
  add_point<D>(body.points, Vec<D>::Constant(place * h), 2400.0 * V, V, ln_J);
  ExplicitSettings settings;
  settings.stress = StressUpdate::first;
  settings.fixed_dt = share * 2.0 / std::sqrt(D / inertia * body.mix.K / 2400.0) * h;
  advance(body, settings, shape_of<D>(ShapeFunctions::gimp), 20);
  return std::abs(body.points.ln_J[0]) / ln_J;
}

// A point that shares its nodes with no other swells and shrinks with its affine velocity C: the pressure
// gives it dt p/(rho D_d) in direction d, D_d the second moment of its weights, so that it rings at omega^2 =
// K/rho sum 1/D_d, and the second step bears omega dt < 2. GIMP's moment is h^2/4 in the middle of a cell and
// half of that at its corner: chi of stability_limits.hpp is 12 and 24 then in space, more than in any body.
TEST(ExplicitAlone, OnePointRingsFasterThanABody) {
  omp_set_num_threads(1);
  const auto expect_limit = [](auto ringing, double place, double inertia) {
    EXPECT_LE(ringing(place, inertia, 0.98), 10.0);
    EXPECT_GE(ringing(place, inertia, 1.05), 1e3);
  };
  expect_limit(ringing_of_one_point<PlaneStrain>, 0.499, 0.25);
  expect_limit(ringing_of_one_point<PlaneStrain>, 0.001, 0.125);
  expect_limit(ringing_of_one_point<ThreeD>, 0.499, 0.25);
  expect_limit(ringing_of_one_point<ThreeD>, 0.001, 0.125);
}

/// Largest of |ln J| over its start, of a few points of a cell that are pressed together at the start, free
/// to fly apart: half of the largest step of a point alone, in as many steps as sound takes to cross ten
/// cells.
double ringing_of_few_points(const std::vector<Vec<3>>& places) {
  constexpr double h = 0.02, ln_J = -1e-5;
  Body<ThreeD> body;
  body.mix = concrete(0.0, 1e-9, 1e6);
  for (Axis& axis : body.grid.axes) axis = {.h = h};
  const double V = std::pow(0.5 * h, 3);
  for (const Vec<3>& place : places) add_point<3>(body.points, place * h, 2400.0 * V, V, ln_J);
  ExplicitSettings settings;
  const double of_one_point = 2.0 / std::sqrt(12.0 * body.mix.K / 2400.0) * h;
  settings.fixed_dt = 0.5 * of_one_point;
  auto state = start_explicit(body, law, settings, {});
  double largest = 0.0;
  for (int i = 0; i < 40; ++i) {
    explicit_step(body, law, settings, state);
    write_back(state, body);
    for (const double now : body.points.ln_J) largest = std::max(largest, std::abs(now / ln_J));
  }
  return largest;
}

// Points at two or three faces of a cell all but leave out the nodes across. One row between them would
// push those all the same, and blow them up at any step.
TEST(ExplicitAlone, AFewPointsAcrossACellRingNoMoreThanOne) {
  omp_set_num_threads(1);
  EXPECT_LE(ringing_of_few_points({{0.5, 0.5, 0.5}}), 2.0);
  EXPECT_LE(ringing_of_few_points({{0.01, 0.9, 0.5}, {0.9, 0.01, 0.5}}), 2.0);
  EXPECT_LE(ringing_of_few_points({{0.01, 0.9, 0.9}, {0.9, 0.01, 0.9}, {0.9, 0.9, 0.01}}), 2.0);
  EXPECT_LE(ringing_of_few_points({{0.01, 0.9, 0.5},
                                   {0.9, 0.01, 0.5},
                                   {0.02, 0.8, 0.3},
                                   {0.8, 0.02, 0.3},
                                   {0.03, 0.7, 0.7},
                                   {0.7, 0.03, 0.7}}),
            2.0);
}

// Longer than a limit is said, and shorter is not; a step that is chosen keeps them.
TEST(ExplicitLimits, AreToldAndKept) {
  omp_set_num_threads(1);
  for (const double share : {0.9, 1.1, 0.0}) {
    auto body = collapsing_block();
    const auto limits = stability_limits(body.mix, law, 3.0 * body.mix.tau_0,
                                         largest_eigenvalues(ShapeFunctions::b_spline), 0.02);
    ExplicitSettings settings;
    if (share > 0.0) settings.fixed_dt = share * std::min(limits.viscous, limits.acoustic);
    EXPECT_EQ(advance<ThreeD>(body, settings, {}, 1).beyond_limit, share > 1.0);
  }
}

}  // namespace
}  // namespace tremie
