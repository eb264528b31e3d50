#pragma once

// The slender case: tau_0 = 10 Pa, mu = 35.8 Pa s, the Abrams cone gone at once, against the lubrication
// equation, which takes over from the shape that the body has at 2 s (R/h above 10).

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/slump_flow/engine.hpp"
#include "tests/libmpm/bodies.hpp"
#include "tests/verification/lubrication.hpp"

namespace tremie::verification {

inline double cone_volume() { return slump_flow::volume({}); }

/// Published diameters: [s], [mm].
inline const std::vector<std::pair<int, int>> published_slender{{3, 572},  {6, 619},  {13, 663},
                                                                {26, 707}, {52, 745}, {120, 784}};

/// Depths of the rings as the points fill them.
inline Layer layer_of(const Points<2>& points, double dr, double across) {
  const auto n = static_cast<std::size_t>(0.45 / dr);
  Layer layer{dr, std::vector<double>(n, 0.0)};
  for (std::size_t p = 0; p < points.size(); ++p) {
    // A point stands for a ring as wide as its raster, or the layer would start as a comb.
    const double low = std::max(0.0, points.x[p][0] - 0.5 * across), high = points.x[p][0] + 0.5 * across;
    const double ring = high * high - low * low;
    for (auto i = static_cast<std::size_t>(low / dr); i < n && layer.radius(i) < high; ++i) {
      const double a = std::max(low, layer.radius(i)), b = std::min(high, layer.radius(i + 1));
      layer.h[i] += points.volume(p) * (b * b - a * a) / ring / layer.area(i);
    }
  }
  return layer;
}

// 3 % at every time from 3 to 120 s, against the equation from the same state and against the published
// diameters.
inline void expect_slender_flow_follows_the_lubrication_equation(double across, double up) {
  slump_flow::Scene scene;
  scene.mix = test::concrete(10.0, 35.8);
  scene.lift_speed.reset();
  scene.model.cell = {across, up};
  omp_set_num_threads(1);
  auto body = slump_flow::filled_cone(scene);
  StepSettings settings = slump_flow::step_settings(scene);
  const auto march = [&](double until) {
    while (body.time < until - 1e-9) {
      settings.dt_max = std::min(StepSettings{}.dt_max, until - body.time);
      EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
    }
  };
  march(2.0);
  Layer layer = layer_of(body.points, 1e-3, 2.0 * across / scene.model.points_per_cell[0]);
  EXPECT_NEAR(layer.volume() / cone_volume(), 1.0, 5e-3);
  const Fluid fluid{2400.0, 9.81, 10.0, 35.8};
  for (const auto& [t, mm] : published_slender) {
    spread_layer(fluid, t - body.time, layer);
    march(t);
    const double spread = slump_flow::spread(body.points, across), reference = 2.0 * layer.front();
    std::printf(
        "slender, %g x %g mm, %3d s: %.1f mm, lubrication from 2 s %.1f (%+.2f %%), published %d (%+.2f "
        "%%)\n",
        1e3 * across, 1e3 * up, t, 1e3 * spread, 1e3 * reference, 100 * (spread / reference - 1), mm,
        100 * (1e3 * spread / mm - 1));
    EXPECT_NEAR(spread / reference, 1.0, 0.03);
    EXPECT_NEAR(1e3 * spread / mm, 1.0, 0.03);
  }
}

}  // namespace tremie::verification
