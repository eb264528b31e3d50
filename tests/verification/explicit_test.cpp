// Explicit steps against closed forms: the decay of a shear wave and plane Poiseuille flow of a regularised
// Bingham fluid; the volume that USF gains.

#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/explicit/step.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double H = 0.1, rho = 2400.0, mu = 35.8, tau_0 = 54.0;

/// Concrete between two plates a distance H apart, `cells` over the distance, periodic along them.
Body<PlaneStrain> channel(int cells, double yield_stress) {
  Body<PlaneStrain> body;
  body.mix = concrete(yield_stress, mu, 1e5);
  const double h = H / cells;
  body.grid.axes[0] = {.h = h, .periodic = true, .n_cells = 4};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip, .high = FaceKind::no_slip, .n_cells = cells};
  fill_box<PlaneStrain>(body, {0.0, 0.0}, {4 * h, H}, 2);
  return body;
}

Shape<2> shape_of(ShapeFunctions kind) { return {kind, {0.25, 0.25}}; }

/// Error of the amplitude of v = sin(pi y/H) exp(-nu (pi/H)^2 t) after 50 ms, nu = mu/rho, relative.
double wave_error(int cells, ShapeFunctions kind, StressUpdate stress) {
  auto body = channel(cells, 0.0);
  const double k = std::numbers::pi / H, U = 1e-2;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double y = body.points.x[p][1];
    body.points.v[p] = {U * std::sin(k * y), 0.0};
    body.points.C[p] << 0.0, U * k * std::cos(k * y), 0.0, 0.0;
  }
  ExplicitSettings settings;
  settings.stress = stress;
  // A step in proportion to h^2, as the viscous limit has it: its own error falls with the grid's.
  settings.fixed_dt = 0.05 / std::ceil(0.05 / (0.2 * rho * std::pow(H / cells, 2) / mu));
  const Papanastasiou law{1.0};
  auto state = start_explicit(body, law, settings, shape_of(kind));
  while (body.time < 0.05 - 1e-9) explicit_step(body, law, settings, state);
  write_back(state, body);
  double amplitude = 0.0, norm = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double s = std::sin(k * body.points.x[p][1]);
    amplitude += body.points.v[p][0] * s, norm += s * s;
  }
  return std::abs(amplitude / norm / (U * std::exp(-mu / rho * k * k * body.time)) - 1.0);
}

class ShearWave : public testing::TestWithParam<std::pair<ShapeFunctions, StressUpdate>> {};

// Second order in the cell size, the step following its square; below 1 % on 16 cells. With the stress first
// the errors of step and grid have opposite signs: they are smaller (0.1 % on 16 cells), and have no one
// order.
TEST_P(ShearWave, DecaysAtItsRate) {
  omp_set_num_threads(1);
  const auto [kind, stress] = GetParam();
  std::vector<double> errors;
  for (const int cells : {4, 8, 16}) errors.push_back(wave_error(cells, kind, stress));
  const double order = std::log2(errors[0] / errors[2]) / 2.0;
  std::printf("shear wave, %s, stress %s: errors %.2e %.2e %.2e, order %.2f\n",
              kind == ShapeFunctions::gimp ? "GIMP" : "splines",
              stress == StressUpdate::last ? "last" : "first", errors[0], errors[1], errors[2], order);
  EXPECT_LE(errors.back(), stress == StressUpdate::last ? 0.01 : 0.002);
  EXPECT_GE(order, stress == StressUpdate::last ? 1.7 : 1.2);
}
INSTANTIATE_TEST_SUITE_P(Schemes, ShearWave,
                         testing::Values(std::pair{ShapeFunctions::b_spline, StressUpdate::last},
                                         std::pair{ShapeFunctions::b_spline, StressUpdate::first},
                                         std::pair{ShapeFunctions::gimp, StressUpdate::last},
                                         std::pair{ShapeFunctions::gimp, StressUpdate::first}));

/// Shear rate of the law mu g + tau_0 (1 - e^(-m g)) at a shear stress.
double rate_at(double tau, double m) {
  double low = 0.0, high = tau / mu;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (mu * middle - tau_0 * std::expm1(-m * middle) < tau ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

/// Poiseuille profile at y: the shear rate summed up from the wall.
double profile(double y, double g_x, double m) {
  constexpr int n = 2000;
  const double z = std::min(y, H - y);
  double v = 0.0;
  for (int i = 0; i < n; ++i) v += z / n * rate_at(rho * g_x * (0.5 * H - (i + 0.5) * z / n), m);
  return v;
}

// The steady profile at m = 5 s, driven by 2.7 times the gravity that the yield stress would hold. The
// transfer to the points and back in every step takes a little of a curved profile, and the more steps there
// are the more it takes: 2.8 % with GIMP on 8 cells. Splines next to a wall lose 13 %
// (tests/verification/explicit.md).
TEST(Poiseuille, RegularisedProfile) {
  omp_set_num_threads(1);
  const double g_x = 1.2, m = 5.0;
  const Papanastasiou law{m};
  std::vector<double> errors;
  for (const int cells : {4, 8}) {
    auto body = channel(cells, tau_0);
    body.gravity = {g_x, 0.0};
    ExplicitSettings settings;
    auto state = start_explicit(body, law, settings, shape_of(ShapeFunctions::gimp));
    while (body.time < 0.4) explicit_step(body, law, settings, state);  // the slowest decay is e^(-15 t/s)
    write_back(state, body);
    double error = 0.0, norm = 0.0;
    for (std::size_t p = 0; p < body.points.size(); ++p) {
      const double v = profile(body.points.x[p][1], g_x, m);
      error += std::pow(body.points.v[p][0] - v, 2), norm += v * v;
    }
    errors.push_back(std::sqrt(error / norm));
  }
  const double order = std::log2(errors[0] / errors[1]);
  std::printf("Poiseuille, m = 5 s, GIMP: errors %.2e %.2e, order %.2f\n", errors[0], errors[1], order);
  EXPECT_LE(errors.back(), 0.04);
  EXPECT_GE(order, 1.7);
}

}  // namespace
}  // namespace tremie
