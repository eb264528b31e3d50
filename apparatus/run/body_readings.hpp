#pragma once

// Sums, means and the front over the points of a body, and its flocculation after a rest.

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "libmpm/body/body.hpp"
#include "libmpm/constitutive/flocculation.hpp"

namespace tremie::experiment {

/// lambda of every point after a rest; nothing is stored for a mix without thixotropy.
template <class Geometry>
void rest(Body<Geometry>& body, double duration) {
  if (!body.mix.thixotropy) return;
  const Thixotropy& t = *body.mix.thixotropy;
  const double lambda = flocculation_after_rest(t.initial_flocculation, t, body.mix.tau_0, duration);
  body.points.lambda.assign(body.points.size(), lambda);
  body.points.gamma_dot.assign(body.points.size(), 0.0);
  body.points.lambda_parts.clear();
  for (const double share : part_shares(t.kinetics))
    body.points.lambda_parts.emplace_back(body.points.size(), share * lambda);
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

/// Mean height of the mass over the origin.
template <int D>
double mean_height(const Points<D>& points) {
  double sum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) sum += points.mass[p] * points.x[p][D - 1];
  return sum / total_mass(points);
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

/// Distance of the front from the gate: of the outermost point that has company (three others less than half
/// a cell behind).
template <int D>
double front_of(const Points<D>& points, double gate, double cell) {
  constexpr std::size_t most_detached = 500;
  std::vector<double> x;
  for (const auto& p : points.x) x.push_back(p[0]);
  const std::size_t n = std::min(most_detached, x.size());
  std::partial_sort(x.begin(), x.begin() + static_cast<std::ptrdiff_t>(n), x.end(), std::greater<>());
  std::size_t i = 0;
  while (i + 4 < n && x[i] - x[i + 3] > 0.5 * cell) ++i;
  return std::max(0.0, x[i] - gate);
}

}  // namespace tremie::experiment
