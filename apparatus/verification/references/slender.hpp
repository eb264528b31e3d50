#pragma once

// The slender case: tau_0 = 10 Pa, mu = 35.8 Pa s, the Abrams cone gone at once, against the lubrication
// equation, which takes over from the shape that the body has at 2 s (R/h above 10).

#include <omp.h>

#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/parts/cone/spread.hpp"
#include "apparatus/verification/references/bodies.hpp"
#include "apparatus/verification/references/finite_elements.hpp"
#include "apparatus/verification/references/lubrication.hpp"

namespace tremie::verification {

inline double cone_volume() { return cone::volume({}); }

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

/// The spread at a time, by the material points and by the equation [m], and as published [mm].
struct SlenderSample {
  int time, published;
  double spread, lubrication;
};
struct SlenderFlow {
  std::vector<SlenderSample> samples;
  double layer_volume = 0.0;  ///< that the equation starts with [m^3]
  int unconverged = 0;
};

/// The diameters of a scene's own run, whose cells become flat with the film.
inline SlenderFlow slender_flow(double across, double up) {
  constexpr double start = 2.0;
  omp_set_num_threads(1);
  cone::Scene scene = instant_release(10.0, 35.8, 120.0);
  scene.mix = bodies::concrete(10.0, 35.8);
  scene.model.cell = {across, up};
  scene.film_cell = cone::film_cell_of(scene);
  scene.film_spread = cone::film_spread_of(scene);

  ImplicitBody<Axisymmetric> body{cone::filled_cone<Axisymmetric>(scene)};
  StepSettings settings = cone::step_settings(scene);
  SlenderFlow flow;
  while (body.time < start - 1e-9) {
    settings.time_left = start - body.time;
    flow.unconverged += !implicit_step(body, ExactBingham{}, settings).converged;
  }
  Layer layer = layer_of(body.points, 1e-3, 2.0 * across / scene.model.points_per_cell[0]);
  flow.layer_volume = layer.volume();

  const cone::Outcome outcome = cone::run(scene);
  flow.unconverged += static_cast<int>(outcome.checks.unconverged_steps);
  const Fluid fluid{2400.0, 9.81, 10.0, 35.8};
  double time = body.time;
  for (const auto& [t, mm] : published_slender) {
    spread_layer(fluid, t - time, layer);
    time = t;
    flow.samples.push_back({t, mm, 1e-3 * spread_at(outcome, t), 2.0 * layer.front()});
  }
  return flow;
}

}  // namespace tremie::verification
