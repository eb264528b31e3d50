#pragma once

// What the explicit steps are timed on: a block of concrete, 2 points a cell in each direction, under its own weight between
// free-slip planes.

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/explicit/step.hpp"

namespace tremie::bench {

inline const Papanastasiou law{5.0};

/// About 14,000 points unless said otherwise.
template <class Geometry>
Body<Geometry> block(bool thixotropic, int cells = Geometry::dim == 3 ? 12 : 60) {
  constexpr int D = Geometry::dim;
  const double h = 0.015, height = cells * h;
  Body<Geometry> body;
  body.mix = bodies::concrete(54.0, 35.8, 33e3);
  body.gravity[Geometry::up] = -9.81;
  for (Axis& a : body.grid.axes) a = {.h = h, .low = FaceKind::free_slip};
  bodies::fill_box<Geometry>(body, Vec<D>::Zero(), Vec<D>::Constant(height), 2,
                             [&](const auto& x) { return 2400.0 * 9.81 * (height - x[Geometry::up]); });
  if (!thixotropic) return body;
  body.mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.01}};
  body.points.lambda.assign(body.points.size(), 1.0);
  body.points.gamma_dot.assign(body.points.size(), 0.0);
  return body;
}

template <class Geometry>
struct Set {
  Body<Geometry> body;
  ExplicitSettings settings;
  ExplicitState<Geometry> state;

  Set(bool thixotropic, bool gimp, StressUpdate stress, bool cell_pressure, bool single = false)
      : Set(block<Geometry>(thixotropic), gimp, stress, cell_pressure, single) {}
  Set(Body<Geometry> filled, bool gimp, StressUpdate stress, bool cell_pressure, bool single = false)
      : body(std::move(filled)) {
    settings.stress = stress;
    settings.single_precision = single;
    settings.cell_pressure = cell_pressure;
    settings.keep_affine = false;
    settings.fixed_dt = 1e-5;
    Shape<Geometry::dim> shape;
    if (gimp) shape = {ShapeFunctions::gimp, {}}, shape.half.fill(0.25);
    state = start_explicit(body, law, settings, shape);
  }
};

}  // namespace tremie::bench
