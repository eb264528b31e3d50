#pragma once

// Small bodies of concrete, and sums over them.

#include <Eigen/Geometry>
#include <limits>

#include "apparatus/run/body_readings.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::bodies {

/// A mix of density 2400 kg/m^3 without thixotropy.
inline Mix concrete(double tau_0, double mu, double K = 1e6) {
  Mix mix;
  mix.tau_0 = tau_0, mix.mu = mu, mix.K = K;
  return mix;
}

using experiment::kinetic_energy, experiment::total_mass, experiment::total_volume;

template <int D>
Vec<D> momentum(const Points<D>& points) {
  Vec<D> sum = Vec<D>::Zero();
  for (std::size_t p = 0; p < points.size(); ++p) sum += points.mass[p] * points.v[p];
  return sum;
}

/// Angular momentum about the origin, as a vector; in the plane along the third direction. A point of APIC
/// carries the spin of its affine velocity too: its second moment is h^2/4 in each direction, away from
/// walls.
template <int D>
Eigen::Vector3d angular_momentum(const Body<std::conditional_t<D == 2, PlaneStrain, ThreeD>>& body) {
  const auto& points = body.points;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t p = 0; p < points.size(); ++p) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), v = x;
    Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
    x.head<D>() = points.x[p], v.head<D>() = points.v[p];
    for (int d = 0; d < D; ++d) {
      const double h = body.grid.axes[d].h;
      for (int e = 0; e < D; ++e) B(e, d) = points.C[p](e, d) * 0.25 * h * h;
    }
    sum += points.mass[p] *
           (x.cross(v) + Eigen::Vector3d(B(2, 1) - B(1, 2), B(0, 2) - B(2, 0), B(1, 0) - B(0, 1)));
  }
  return sum;
}

/// A box of points, n across each cell in each direction, without pressure unless `pressure_at` says
/// otherwise.
template <class Geometry, class Pressure>
void fill_box(Body<Geometry>& body, const Vec<Geometry::dim>& low, const Vec<Geometry::dim>& high,
              int per_cell, Pressure pressure_at) {
  std::array<int, Geometry::dim> n;
  for (int d = 0; d < Geometry::dim; ++d)
    n[d] = static_cast<int>(std::lround((high[d] - low[d]) / body.grid.axes[d].h * per_cell));
  seed_box<Geometry>(
      low, high, n, body.mix.density, body.mix.K, [](const auto&) { return true; }, pressure_at, body.points);
}
template <class Geometry>
void fill_box(Body<Geometry>& body, const Vec<Geometry::dim>& low, const Vec<Geometry::dim>& high,
              int per_cell) {
  fill_box(body, low, high, per_cell, [](const auto&) { return 0.0; });
}

}  // namespace tremie::bodies
