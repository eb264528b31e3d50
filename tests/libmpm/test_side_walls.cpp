// The yield stress of a section shared between its plane and its side walls.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/problem/side_walls.hpp"

namespace tremie {
namespace {

// f is the mean of sqrt(1 - (s zeta)^2) over zeta from 0 to 1, and of all s the one taken dissipates most.
TEST(SideWalls, ShareOutTheYieldStress) {
  for (const double s : {0.0, 0.01, 0.3, 0.9, 1.0}) {
    constexpr int n = 100000;
    double mean = 0.0;
    for (int i = 0; i < n; ++i) mean += std::sqrt(1.0 - std::pow(s * (i + 0.5) / n, 2)) / n;
    EXPECT_NEAR(detail::share_of_plane(s), mean, 1e-7);
  }
  EXPECT_NEAR(detail::share_of_plane(1.0), 0.25 * std::numbers::pi, 1e-15);
  for (const double R : {0.0, 1e-3, 0.1, 0.5, 0.78, 2.0, 1e9}) {
    const auto dissipated = [&](double s) { return detail::share_of_plane(s) + R * s; };
    const double taken = dissipated(detail::share_of_walls(R));
    for (int i = 0; i <= 1000; ++i) EXPECT_LE(dissipated(1e-3 * i), taken * (1.0 + 1e-5));
  }
}

constexpr double tau_0 = 400.0, rho_g = 2400.0 * 9.81, width = 0.2, length = 0.3, height = 0.2;

/// Within which distance nine tenths of the volume come to rest, on a floor without friction [m]. The plane's yield stress f
/// tau_0 bears a front of the height h_f = 4 f tau_0/(rho g), for the pressure rho g h_f^2/2 is the plane's 2 f tau_0 h_f. Behind it
/// the side walls hold 2 tau_0 h/W against (rho g h - 2 f tau_0) dh/dx.
double reach_at_rest(double f) {
  constexpr double dx = 1e-5;
  std::vector<double> volume = {0.0};
  for (double h = 4.0 * f * tau_0 / rho_g; volume.back() < length * height;
       h += dx * 2.0 * tau_0 * h / width / (rho_g * h - 2.0 * f * tau_0))
    volume.push_back(volume.back() + h * dx);
  const auto tenth = std::upper_bound(volume.begin(), volume.end(), 0.1 * length * height);
  return static_cast<double>(volume.end() - tenth) * dx;
}

template <class Geometry>
double reach(double h) {
  constexpr int D = Geometry::dim, up = Geometry::up;
  ImplicitBody<Geometry> body;
  body.mix = bodies::concrete(tau_0, 100.0);
  body.gravity[up] = -9.81;
  for (int d = 0; d < D; ++d) body.grid.axes[d] = {.h = h, .low = FaceKind::free_slip};
  Vec<D> high = Vec<D>::Constant(length);
  high[up] = height;
  if constexpr (D == 3) {
    high[1] = 0.5 * width;
    body.grid.axes[1].high = FaceKind::no_slip,
    body.grid.axes[1].n_cells = static_cast<int>(std::lround(0.5 * width / h));
  }
  bodies::fill_box(body, Vec<D>(Vec<D>::Zero()), high, D == 3 ? 2 : 4,
                   [&](const auto& x) { return rho_g * (height - x[up]); });
  StepSettings settings;
  settings.side_wall_distance = D == 2 ? width : 0.0;
  settings.particle_shifting.on = settings.moving_surface = true;
  settings.alternating_viscosity = D == 2 ? 100.0 : 0.0;
  for (double speed = 1.0; body.time < 20.0 && speed > 2e-4;) {
    speed = implicit_step(body, ExactBingham{}, settings).bulk_speed;
    if (body.time < 1.0) speed = 1.0;
  }
  std::vector<double> x;
  for (const auto& at : body.points.x) x.push_back(at[0]);
  const auto tenth = x.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(x.size()));
  std::nth_element(x.begin(), tenth, x.end());
  std::printf("%dD, %g mm: %.4f m after %.1f s\n", D, 1e3 * h, *tenth, body.time);
  return *tenth;
}

// From the first step on walls that stick hold 2 tau_0/W of the weight per volume, and no more.
TEST(SideWalls, HoldABodyAtRest) {
  for (const double share : {0.95, 1.05}) {
    ImplicitBody<PlaneStrain> body;
    body.mix = bodies::concrete(tau_0, 100.0);
    body.gravity[0] = share * 2.0 * tau_0 / (width * 2400.0);
    body.grid.axes[0] = {.h = 0.02, .periodic = true, .n_cells = 4};
    body.grid.axes[1] = {.h = 0.02, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 4};
    bodies::fill_box(body, Vec<2>(Vec<2>::Zero()), Vec<2>(0.08, 0.08), 4);
    StepSettings settings;
    settings.side_wall_distance = width;
    settings.fixed_dt = 0.1;
    double speed = 0.0;
    for (int i = 0; i < 20; ++i) speed = implicit_step(body, ExactBingham{}, settings).max_speed;
    // Faster, the plug has the viscous drag of a parabola: 12 mu u/W^2 takes the rest.
    const double exact = std::max(0.0, share - 1.0) * 2.0 * tau_0 / width * width * width / (12.0 * 100.0);
    std::printf("%g of what the walls hold: %.4g mm/s, exact %.4g\n", share, 1e3 * speed, 1e3 * exact);
    EXPECT_NEAR(speed, exact, 0.03 * exact + 1e-5);
  }
}

// Sides that stick and a floor that slips: the closed form with f = pi/4.
TEST(SideWalls, HoldAHeapOnASlippingFloor) {
  const double exact = reach_at_rest(0.25 * std::numbers::pi);
  std::printf("exact %.4f m, with the whole yield stress in the plane %.4f m\n", exact, reach_at_rest(1.0));
  EXPECT_NEAR(reach<PlaneStrain>(0.02), exact, 0.05 * exact);
  EXPECT_NEAR(reach<PlaneStrain>(0.01), exact, 0.03 * exact);
}

// In space nothing is averaged.
TEST(SideWalls, HoldAHeapAsInSpace) {
  const double in_space = reach<ThreeD>(0.02);
  EXPECT_NEAR(reach<PlaneStrain>(0.02), in_space, 0.05 * in_space);
}

}  // namespace
}  // namespace tremie
