#pragma once

// Sums and means over the points of a body, and its flocculation after a rest.

#include <optional>

#include "libmpm/body/body.hpp"
#include "libmpm/constitutive/flocculation.hpp"

namespace tremie::test_run {

/// lambda of every point after a rest; nothing is stored for a mix without thixotropy.
template <class Geometry>
void rest(Body<Geometry>& body, double duration) {
  if (!body.mix.thixotropy) return;
  const Thixotropy& t = *body.mix.thixotropy;
  body.points.lambda.assign(body.points.size(),
                            flocculation_after_rest(t.initial_flocculation, t, body.mix.tau_0, duration));
  body.points.gamma_dot.assign(body.points.size(), 0.0);
}

template <int D>
double total_volume(const Points<D>& points) {
  double V = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) V += points.volume(p);
  return V;
}

template <int D>
double total_mass(const Points<D>& points) {
  double m = 0.0;
  for (double mass : points.mass) m += mass;
  return m;
}

/// sum V / sum V0 - 1, against the stress-free volume.
template <int D>
double volume_change(const Points<D>& points) {
  double V0 = 0.0;
  for (double v : points.V0) V0 += v;
  return total_volume(points) / V0 - 1.0;
}

template <int D>
double kinetic_energy(const Points<D>& points) {
  double e = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) e += 0.5 * points.mass[p] * points.v[p].squaredNorm();
  return e;
}

/// Volume mean of lambda; empty without thixotropy.
template <int D>
std::optional<double> mean_flocculation(const Points<D>& points) {
  if (!points.thixotropic()) return std::nullopt;
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) sum += points.volume(p) * points.lambda[p];
  return sum / total_volume(points);
}

}  // namespace tremie::test_run
