// The closed loop of a tribometer: a layer tau_i + k_i u along a smooth wall, torques by runs, the layer that their fit gives.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "apparatus/icar_vane/ends.hpp"
#include "rheometer/whole_fit/tribometer.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double pi = std::numbers::pi;

/// The instrument's container; the layer lies along it.
Scene scene_in(SpaceKind space, double cell, double tau_0, const WallLaw& walls) {
  Scene scene;
  scene.model.space = space;
  scene.model.cell = {cell, cell};
  scene.mix.tau_0 = tau_0, scene.mix.mu = 30.0;
  scene.walls = walls;
  scene.pre_shear_time = 2.0;
  return scene;
}

/// A record of the torques of a flow curve.
TribometerSeries series_of(double fill_height, const Outcome& outcome) {
  TribometerSeries s;
  s.fill_height = fill_height;
  for (const CurvePoint& p : outcome.results.flow_curve) {
    s.record.line.push_back(static_cast<long>(s.record.line.size()) + 2);
    s.record.omega.push_back(2.0 * pi * p.speed);
    s.record.torque.push_back(p.torque);
  }
  return s;
}

/// How many of 2 x 40 intervals of 95 % hold the layer that went in, the torques with 1 % of noise.
int intervals_that_hold(const std::vector<TribometerSeries>& series, const FitInput& in, SmoothWall wall,
                        const Interface& layer) {
  int inside = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    std::vector<TribometerSeries> noisy = series;
    for (TribometerSeries& s : noisy)
      for (double& torque : s.record.torque) torque *= 1.0 + 0.01 * normal(generator);
    const FitResult f = fit_tribometer(noisy, in, wall);
    for (std::size_t k = 0; k < 2; ++k) {
      const auto e = value_of(f, interface_parameters()[k]);
      const double truth = k == 0 ? layer.tau_i : layer.k_i;
      inside += e && e->ci95 && e->ci95->low <= truth && truth <= e->ci95->high ? 1 : 0;
    }
  }
  return inside;
}

/// Without noise the fit gives the layer back within `tolerance`; with it the intervals hold, 95 % of 80 (fewer than 68: a
/// chance of 1e-3).
void expect_layer(const std::vector<TribometerSeries>& series, const FitInput& in, SmoothWall wall,
                  const Interface& layer, double tolerance) {
  const FitResult f = fit_tribometer(series, in, wall);
  ASSERT_TRUE(f.reasons.empty()) << f.reasons.front();
  const double tau_i = value_of(f, interface_parameters()[0])->value,
               k_i = value_of(f, interface_parameters()[1])->value;
  const int inside = intervals_that_hold(series, in, wall, layer);
  std::printf("fit: %.3f Pa for %g, %.1f Pa s/m for %g; %d of 80 intervals hold\n", tau_i, layer.tau_i, k_i,
              layer.k_i, inside);
  EXPECT_NEAR(tau_i / layer.tau_i, 1.0, tolerance);
  EXPECT_NEAR(k_i / layer.k_i, 1.0, tolerance);
  EXPECT_GE(inside, 68);
}

const std::vector<double> curve_speeds{0.4, 0.3, 0.2, 0.1, 0.05};

// Torques of a smooth cylinder in concrete of 20 Pa and 30 Pa s, at two fill heights, by the section: the fit takes the
// concrete's own shear off and gives the layer back. 1 %: the section's error.
TEST(TribometerLoop, ATribometersFitGivesTheLayerBack) {
  const Interface layer{30.0, 800.0};
  std::vector<TribometerSeries> series;
  for (const double height : {0.1, 0.2}) {
    Scene s = scene_in(SpaceKind::couette, 0.0025, 20.0, layer);
    s.cylinder_slides = true, s.vane.height = height, s.speeds = curve_speeds;
    series.push_back(series_of(height, run(s)));
  }
  FitInput in;
  in.tau_0 = 20.0, in.mu = 30.0;
  expect_layer(series, in, SmoothWall::cylinder, layer, 0.01);
}

// A vane in a smooth container, in space: stiff concrete turns with the vane as one body, and slides along wall and floor. The
// wall's torque grows with the depth of the concrete, the floor's, 2 pi (tau_i R^3/3 + k_i Omega R^4/4), does not.
TEST(TribometerLoop, AVaneInASmoothContainerGivesTheLayerBack) {
  const Interface layer{30.0, 100.0};
  std::vector<TribometerSeries> series;
  for (const double cover : {0.02, 0.16}) {
    Scene s = scene_in(SpaceKind::cylindrical, 0.02, 2000.0, layer);
    s.vane.bottom_gap = 0.08, s.vane.cover = cover, s.speeds = {0.4, 0.2, 0.1, 0.05};
    const Outcome o = run(s);
    EXPECT_TRUE(o.checks.reasons.empty()) << o.checks.reasons.front();
    const EndsGrid grid(s, true);
    series.push_back(series_of(grid.bottom_gap() + s.vane.height + grid.cover(), o));
  }
  expect_layer(series, {}, SmoothWall::container, layer, 0.01);
}

}  // namespace
}  // namespace tremie::icar_vane
