#pragma once

// Whether steps make energy: what passes a stability limit that nobody has written down does so long before
// its points run away, and so do thin films of water, whose cells hold a point or two.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/run/body_readings.hpp"
#include "apparatus/run/step_settings.hpp"

namespace tremie::experiment {

/// Kinetic and potential energy of the points [J]; heights from the floor.
template <class Geometry>
double energy_of_motion(const Points<Geometry::dim>& points) {
  double energy = kinetic_energy(points);
  for (std::size_t p = 0; p < points.size(); ++p)
    energy += points.mass[p] * gravity * points.x[p][Geometry::up];
  return energy;
}

/// With the elastic energy, too: the pressure -K ln(J) stores K (J ln J - J + 1) in a unit of stress-free
/// volume.
template <class Geometry>
double energy_of(const Points<Geometry::dim>& points, double K) {
  double elastic = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const double ln_J = points.ln_J[p], J = std::exp(ln_J);
    elastic += points.V0[p] * K * (J * ln_J - J + 1.0);
  }
  return energy_of_motion<Geometry>(points) + elastic;
}

/// A body that nothing pushes can only lose energy. A wall that moves may do work on it, half of what the
/// cone stands for at most: what the body has when the wall lets go is what it may have.
class EnergyWatch {
 public:
  explicit EnergyWatch(double at_start) : allowed_(at_start), scale_(at_start) {}

  void see(double energy, bool pushed) {
    if (pushed) allowed_ = std::min(energy, 1.5 * scale_);
    gained_ = std::max(gained_, (energy - allowed_) / scale_);
  }

  /// More than all that it started with: it will not come to rest.
  bool ran_away() const { return gained_ > 1.0; }

  /// Two per cent of what the cone stands for are more than the readings' own error.
  void tell(Checks& checks) const {
    if (!(gained_ > 0.02)) return;
    checks.reasons.push_back(fmt::format(
        "the concrete gained {:.3g} % of the energy that it started with: the steps are not stable{}",
        100.0 * gained_, ran_away() ? "; the run ends there" : ""));
  }

 private:
  double allowed_, scale_, gained_ = 0.0;
};

}  // namespace tremie::experiment
