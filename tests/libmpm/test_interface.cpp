// The interface law of a wall, tau_i + k_i u, against a slab that slides down a slope, and flow in a slit and a pipe.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"

namespace tremie::sliding_slab {
namespace {

using namespace bodies;

constexpr double H = 0.1, g = 9.81, rho = 2400.0, theta = 10.0 * std::numbers::pi / 180.0;

/// What drives the slab along the floor [Pa]: 409.
const double driving = rho * g * H * std::sin(theta);

/// A slab without ends on a slope, `cells` deep.
template <class Geometry>
ImplicitBody<Geometry> slab(double tau_0, double mu, int cells) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = concrete(tau_0, mu);
  body.mix.density = rho;
  body.gravity[0] = g * std::sin(theta), body.gravity[up] = -g * std::cos(theta);
  const double h = H / cells;
  for (int d = 0; d < up; ++d) body.grid.axes[d] = {.h = h, .periodic = true, .n_cells = 4};
  body.grid.axes[up] = {.h = h, .low = FaceKind::wall_law};
  Vec<D> high = Vec<D>::Constant(4.0 * h);
  high[up] = H;
  fill_box(body, Vec<D>(Vec<D>::Zero()), high, 2,
           [&](const auto& x) { return rho * g * std::cos(theta) * (H - x[up]); });
  return body;
}

template <class Geometry>
void slide(ImplicitBody<Geometry>& body, const Interface& law, double until,
           YieldMethod method = YieldMethod::automatic) {
  omp_set_num_threads(1);
  StepSettings settings;
  settings.method = method;
  settings.wall_law = law;
  settings.fixed_dt = 0.01;
  while (body.time < until - 1e-9) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
}

template <class Geometry>
double speed(const ImplicitBody<Geometry>& body) {
  return momentum(body.points)[0] / total_mass(body.points);
}

// A slab that does not shear goes faster as u = (driving - tau_i)/k (1 - exp(-k t/(rho H))), in the section and in space, by
// ADMM and by Newton.
TEST(InterfaceLaw, ASlabSlidesAsItsLawSays) {
  const Interface law{100.0, 1000.0};
  const double most = (driving - law.tau_i) / law.k_i, rate = law.k_i / (rho * H);
  const auto check = [&](const auto& body, double t) {
    EXPECT_NEAR(speed(body) / (most * -std::expm1(-rate * t)), 1.0, 0.01) << t;
  };
  for (auto method : {YieldMethod::admm, YieldMethod::newton}) {
    auto body = slab<PlaneStrain>(5e4, 50.0, 4);
    slide(body, law, 0.5, method);
    check(body, 0.5);
    slide(body, law, 3.0, method);
    check(body, 3.0);
  }
  auto body = slab<ThreeD>(5e4, 50.0, 4);
  slide(body, law, 3.0);
  check(body, 3.0);
}

// Below tau_i it stays: what moves is less than a thousandth of what would slide without it.
TEST(InterfaceLaw, ASlabStaysBelowTheYieldStress) {
  for (auto method : {YieldMethod::admm, YieldMethod::newton}) {
    auto body = slab<PlaneStrain>(5e4, 50.0, 4);
    slide(body, Interface{1.02 * driving, 1000.0}, 1.0, method);
    EXPECT_LE(speed(body), 1e-3 * g * std::sin(theta));
  }
}

// A Newtonian slab slides and shears: u(y) = (driving - tau_i)/k + rho g sin(theta)/mu (H y - y^2/2).
TEST(InterfaceLaw, ASlabSlidesAndShears) {
  const Interface law{100.0, 1000.0};
  const double mu = 50.0;
  for (int cells : {4, 8, 16}) {
    auto body = slab<PlaneStrain>(0.0, mu, cells);
    slide(body, law, 4.0);
    double error = 0.0, all = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p) {
      const double y = body.points.x[p][1];
      const double u = (driving - law.tau_i) / law.k_i + driving / H / mu * (H * y - 0.5 * y * y);
      error += std::pow(body.points.v[p][0] - u, 2), all += u * u;
    }
    std::printf("%2d cells: error %.2e\n", cells, std::sqrt(error / all));
    EXPECT_LE(std::sqrt(error / all), 0.01);
  }
}

// tau_i = k = 0 is free slip: the slab falls freely along the slope. A large k is no slip.
TEST(InterfaceLaw, HasItsLimits) {
  auto free = slab<PlaneStrain>(50.0, 50.0, 8), holds = slab<PlaneStrain>(50.0, 50.0, 8),
       no_slip = slab<PlaneStrain>(50.0, 50.0, 8);
  slide(free, Interface{}, 1.0);
  EXPECT_NEAR(speed(free) / (g * std::sin(theta)), 1.0, 1e-3);
  no_slip.grid.axes[1].low = FaceKind::no_slip;
  slide(holds, Interface{0.0, 1e6}, 1.0);
  slide(no_slip, Interface{}, 1.0);
  EXPECT_NEAR(speed(holds) / speed(no_slip), 1.0, 0.01);  // 409 Pa / k = 0.4 mm/s
}

// Bingham concrete that a body force f drives through a slit or a pipe whose walls slide. The stress at the wall is
// f a/n, with n = 1 for a slit of half width a and 2 for a pipe of radius a; what slides is (stress - tau_i)/k_i, and the
// concrete adds (f/(2n)(a^2 - y^2) - tau_0 (a - y))/mu outside of a plug of y = n tau_0/f.

constexpr double a = 0.05;
constexpr Interface layer{25.0, 500.0};
const Mix sliding = concrete(50.0, 20.0);

template <class Geometry>
constexpr int n_of = std::is_same_v<Geometry, Axisymmetric> ? 2 : 1;

template <class Geometry>
double exact_speed(double at_wall, double y) {
  constexpr int n = n_of<Geometry>;
  const double f = n * at_wall / a, slides = std::max(0.0, at_wall - layer.tau_i) / layer.k_i;
  if (at_wall <= sliding.tau_0) return slides;
  y = std::max(y, n * sliding.tau_0 / f);
  return slides + (f / (2 * n) * (a * a - y * y) - sliding.tau_0 * (a - y)) / sliding.mu;
}

/// Mean error of the speed over the largest, with `cells` over the half width, after 6 s.
template <class Geometry>
double error_between_walls(double at_wall, int cells) {
  omp_set_num_threads(1);
  constexpr bool pipe = n_of<Geometry> == 2;
  ImplicitBody<Geometry> body;
  body.mix = sliding;
  body.gravity[1] = -n_of<Geometry> * at_wall / a / body.mix.density;
  const double h = a / cells, middle = pipe ? 0.0 : a, width = pipe ? a : 2.0 * a;
  body.grid.axes[0] = {.h = h,
                       .low = pipe ? FaceKind::free_slip : FaceKind::wall_law,
                       .high = FaceKind::wall_law,
                       .n_cells = pipe ? cells : 2 * cells};
  body.grid.axes[1] = {.h = h, .periodic = true, .n_cells = 3};
  fill_box<Geometry>(body, {0.0, 0.0}, {width, 3.0 * h}, 2);
  StepSettings settings;
  settings.fixed_dt = 0.1;
  settings.wall_law = layer;
  settings.admm.tolerance = 1e-4;
  for (int i = 0; i < 60; ++i) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  double squares = 0.0, volume = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double exact = exact_speed<Geometry>(at_wall, std::abs(body.points.x[p][0] - middle));
    squares += body.points.volume(p) * std::pow(-body.points.v[p][1] - exact, 2);
    volume += body.points.volume(p);
  }
  return std::sqrt(squares / volume) / exact_speed<Geometry>(at_wall, 0.0);
}

template <class Geometry>
void flows_between_walls(const char* name) {
  for (const double at_wall : {40.0, 150.0}) {  // a plug slides; the concrete shears too
    double before = 0.0;
    for (const int cells : {4, 8, 16}) {
      const double error = error_between_walls<Geometry>(at_wall, cells);
      std::printf("%s, %3.0f Pa, %2d cells: error %.2e, order %.1f\n", name, at_wall, cells, error,
                  before > 0.0 ? std::log2(before / error) : NAN);
      EXPECT_LE(error, 0.01);
      before = error;
    }
  }
}

TEST(InterfaceLaw, ASlitWhoseWallsSlide) { flows_between_walls<PlaneStrain>("slit"); }
TEST(InterfaceLaw, APipeWhoseWallSlides) { flows_between_walls<Axisymmetric>("pipe"); }

}  // namespace
}  // namespace tremie::sliding_slab
