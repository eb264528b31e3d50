// Thin walls that separate: nothing passes one that is shut, for a minute, on coarse cells and on half of them.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/boundary/openings/outlet.hpp"

namespace tremie::separating_walls {
namespace {

using namespace bodies;

constexpr double tau_0 = 10.0, width = 0.1, height = 0.3, g = 9.81;

/// Settings of the L-box: long steps.
StepSettings long_steps(bool section) {
  StepSettings settings;
  settings.dt_max = section ? 0.3 : 0.1;
  settings.cut_cell_rule = true, settings.moving_surface = section;
  settings.alternating_viscosity = 100.0;
  settings.particle_shifting.on = true;
  return settings;
}

/// A column of a fluid mix, which its walls alone hold, 0.1 m wide and 0.3 m high, with as much room beyond its right
/// side.
template <class Geometry>
ImplicitBody<Geometry> column(double h) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = concrete(tau_0, 30.0, 5e6);
  body.gravity[up] = -g;
  const int n = static_cast<int>(std::lround(width / h));
  if constexpr (D == 3)
    body.grid.axes[1] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 2};
  body.grid.axes[0] = {.h = h, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = 2 * n};
  body.grid.axes[up] = {.h = h, .low = FaceKind::no_slip};
  Vec<D> high = Vec<D>::Constant(2.0 * h);
  high[0] = width, high[up] = height;
  fill_box(body, Vec<D>(Vec<D>::Zero()), high, 4,
           [&](const auto& x) { return body.mix.density * g * (height - x[up]); });
  return body;
}

/// Height of the middle of the mass [m].
template <class Geometry>
double middle(const Points<Geometry::dim>& points) {
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) sum += points.mass[p] * points.x[p][Geometry::up];
  return sum / total_mass(points);
}

template <class Geometry>
void stands_for_a_minute(double h, bool holds) {
  omp_set_num_threads(1);
  auto body = column<Geometry>(h);
  const int face = body.grid.axes[0].n_cells / 2;
  body.grid.axes[0].repeated_knots = {face};
  body.grid.sheets = {{.face = face, .along = Geometry::up, .from = 0.0, .to = 1.0}};
  if (holds) body.grid.sheets[0].contact = FaceKind::no_slip;
  const double before = middle<Geometry>(body.points);
  while (body.time < 60.0)
    ASSERT_FALSE(implicit_step(body, ExactBingham{}, long_steps(Geometry::dim == 2)).failed);
  for (const auto& x : body.points.x) ASSERT_LT(x[0], width);
  std::printf("%dD, cells of %g mm: middle sank by %.2e\n", Geometry::dim, 1e3 * h,
              1.0 - middle<Geometry>(body.points) / before);
  // What had gone through would be missing from the column.
  EXPECT_NEAR(middle<Geometry>(body.points) / before, 1.0, 1e-3);
}

TEST(Sheets, HoldAFluidForAMinuteInASection) {
  for (double h : {0.025, 0.0125})
    for (bool holds : {true, false}) stands_for_a_minute<PlaneStrain>(h, holds);
}
TEST(Sheets, HoldAFluidForAMinuteInSpace) { stands_for_a_minute<ThreeD>(0.025, false); }

// Through the opening below a sheet the fluid flows: after ten seconds more than a third of it is beyond, and it stands
// level to a cell.
TEST(Sheets, LetThroughWhereTheyAreOpen) {
  omp_set_num_threads(1);
  auto body = column<PlaneStrain>(0.0125);
  body.grid.axes[0].repeated_knots = {8};
  body.grid.sheets = {{.face = 8, .along = 1, .from = 0.05, .to = 1.0, .contact = FaceKind::no_slip}};
  while (body.time < 10.0) implicit_step(body, ExactBingham{}, long_steps(true));
  double beyond = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    if (body.points.x[p][0] > width) beyond += body.points.mass[p] / total_mass(body.points);
  std::printf("open: %.3f beyond\n", beyond);
  EXPECT_GT(beyond, 0.4);
  EXPECT_LT(beyond, 0.55);
}

/// What is left in the column after a door at its foot has stood open, in seconds, at the times of a door that opens and shuts.
struct Emptying {
  ImplicitBody<PlaneStrain> body = column<PlaneStrain>(0.0125);
  Outflow left = {};

  Emptying() { body.grid.axes[0].repeated_knots = {8}; }
  void door(bool open, double until) {
    body.grid.sheets = {{.face = 8, .along = 1, .from = open ? 0.05 : 0.0, .to = 1.0}};
    while (body.time < until - 1e-9) {
      StepSettings settings = long_steps(true);
      settings.dt_max = std::min(0.02, until - body.time);
      ASSERT_FALSE(implicit_step(body, ExactBingham{}, settings).failed);
      let_out<2>({{1.0, 0.0}, width + 0.025}, body.points, left);
    }
  }
  double in_column() const {
    double volume = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p)
      if (body.points.x[p][0] < width) volume += body.points.volume(p);
    return volume;
  }
};

// A slow flow has no memory: a door that is open for twice half a second lets out what one does that is open for a second, but for
// what sets out and settles anew. Nothing passes while it is shut, and what has left and what is left is all that there was.
TEST(Sheets, ADoorThatShutsAndOpensAgain) {
  omp_set_num_threads(1);
  Emptying twice, once;
  const double all = twice.in_column();
  twice.door(true, 0.5);
  const double before = twice.in_column();
  EXPECT_LT(before, 0.95 * all);
  twice.door(false, 3.0);
  EXPECT_NEAR(twice.in_column() / before, 1.0, 1e-3);
  twice.door(true, 3.5);
  once.door(true, 1.0);
  std::printf("left in the column: %.4f, by one opening %.4f\n", twice.in_column() / all,
              once.in_column() / all);
  EXPECT_NEAR(twice.in_column() / all, once.in_column() / all, 0.02);
  double inside = 0.0;
  for (std::size_t p = 0; p < twice.body.points.size(); ++p) inside += twice.body.points.volume(p);
  EXPECT_NEAR((inside + twice.left.volume) / all, 1.0, 1e-3);
  EXPECT_GT(twice.left.points, 0);
}

// A rigid wall as a signed distance that leans, and stands, holds a fluid as well: a funnel's. Points that it pushes in
// and out in long steps take up to a few percent more room on such cells.
TEST(RigidWalls, HoldAFluidForAMinute) {
  omp_set_num_threads(1);
  for (double h : {0.025, 0.0125}) {
    auto body = column<PlaneStrain>(h);
    const Vec<2> normal = Vec<2>(-1.0, 0.2).normalized();
    auto settings = long_steps(true);
    settings.dt_max = 0.05;
    settings.wall_gap = 0.125 * h;
    const RigidWall<2> wall = [&](const Vec<2>& x, double) -> std::optional<WallView<2>> {
      const double gap = normal.dot(x - Vec<2>(width + settings.wall_gap, 0.0));
      if (std::abs(gap) > settings.wall_gap + settings.cfl * h) return std::nullopt;
      return WallView<2>{gap, normal, Vec<2>::Zero()};
    };
    const auto beyond = [&] {
      double sum = 0.0;
      for (std::size_t p = 0; p < body.points.size(); ++p)
        if (normal.dot(body.points.x[p] - Vec<2>(width + settings.wall_gap, 0.0)) < 0.0)
          sum += body.points.mass[p] / total_mass(body.points);
      return sum;
    };
    while (body.time < 5.0) implicit_step(body, ExactBingham{}, settings, wall);  // it leans against the wall
    const double before = middle<PlaneStrain>(body.points);
    while (body.time < 65.0) implicit_step(body, ExactBingham{}, settings, wall);
    std::printf("leaning, %g mm: middle sank by %.2e, beyond %.2e\n", 1e3 * h,
                1.0 - middle<PlaneStrain>(body.points) / before, beyond());
    EXPECT_EQ(beyond(), 0.0);
    EXPECT_NEAR(middle<PlaneStrain>(body.points) / before, 1.0, 1.5 * h);
  }
}

}  // namespace
}  // namespace tremie::separating_walls
