#pragma once

#include <array>

#include "libmpm/constitutive/equation_of_state.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// Fills the box [low, high] with points on a regular raster, `n` of them in each direction, where inside(x)
/// holds. Each carries the volume of its own raster cell and the pressure pressure_at(x) [Pa] at the time 0.
template <class Geometry, class Inside, class Pressure>
void seed_box(const Vec<Geometry::dim>& low, const Vec<Geometry::dim>& high,
              const std::array<int, Geometry::dim>& n, double density, double K, Inside inside,
              Pressure pressure_at, Points<Geometry::dim>& points) {
  constexpr int D = Geometry::dim;
  Vec<D> spacing;
  std::size_t total = 1;
  for (int d = 0; d < D; ++d) {
    spacing[d] = (high[d] - low[d]) / n[d];
    total *= static_cast<std::size_t>(n[d]);
  }
  const auto place = [&](std::size_t i) {
    Vec<D> x;
    for (int d = D - 1; d >= 0; i /= static_cast<std::size_t>(n[d]), --d)
      x[d] = low[d] + (static_cast<double>(i % static_cast<std::size_t>(n[d])) + 0.5) * spacing[d];
    return x;
  };
  std::size_t points_inside = 0;  // arrays that grow would be there twice
  for (std::size_t i = 0; i < total; ++i) points_inside += inside(place(i)) ? 1 : 0;
  reserve(points, points.size() + points_inside);
  for (std::size_t i = 0; i < total; ++i) {
    const Vec<D> x = place(i);
    if (!inside(x)) continue;
    const double V = spacing.prod() * Geometry::measure(x);
    const double ln_J = ln_J_under(pressure_at(x), K);
    add_point<D>(points, x, density * V, V * std::exp(-ln_J), ln_J);
  }
}

}  // namespace tremie
