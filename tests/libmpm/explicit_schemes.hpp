#pragma once

// Explicit steps of every kind, and a body for them.

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/explicit/step.hpp"

namespace tremie::test {

inline constexpr double g = 9.81;
inline const Papanastasiou law{5.0};

template <int D>
Shape<D> shape_of(ShapeFunctions kind, double half = 0.25) {
  Shape<D> shape{kind, {}};
  shape.half.fill(half);
  return shape;
}

struct Scheme {
  StressUpdate stress;
  bool flip;
  ShapeFunctions shape;
  bool cell_pressure;
  bool single = false;
};
inline const std::vector<Scheme> schemes = {{StressUpdate::last, false, ShapeFunctions::b_spline, true},
                                            {StressUpdate::last, false, ShapeFunctions::b_spline, false},
                                            {StressUpdate::last, true, ShapeFunctions::b_spline, true},
                                            {StressUpdate::first, false, ShapeFunctions::gimp, true},
                                            {StressUpdate::first, true, ShapeFunctions::gimp, false}};

inline ExplicitSettings settings_of(const Scheme& scheme, double dt) {
  ExplicitSettings settings;
  settings.stress = scheme.stress;
  settings.transfer.flip = scheme.flip;
  settings.cell_pressure = scheme.cell_pressure;
  settings.single_precision = scheme.single;
  settings.fixed_dt = dt;
  return settings;
}

/// A block of 2000 points on a floor with friction.
inline Body<ThreeD> collapsing_block() {
  Body<ThreeD> body;
  body.mix = bodies::concrete(20.0, 5.0, 33e3);
  body.mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.01}};
  body.gravity[2] = -g;
  for (Axis& a : body.grid.axes) a = {.h = 0.02, .low = FaceKind::free_slip};
  body.grid.axes[2].low = FaceKind::wall_law;
  bodies::fill_box<ThreeD>(body, Vec<3>::Zero(), Vec<3>(0.1, 0.1, 0.2), 2,
                           [](const auto& x) { return 2400.0 * g * (0.2 - x[2]); });
  body.points.lambda.assign(body.points.size(), 2.0);
  body.points.gamma_dot.assign(body.points.size(), 0.0);
  return body;
}

}  // namespace tremie::test
