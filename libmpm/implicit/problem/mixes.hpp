#pragma once

// Concretes that differ in one body.

#include <array>
#include <vector>

#include "libmpm/constitutive/mix.hpp"
#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

/// Yield stress and plastic viscosity of a quadrature's places where points differ in their mix: means of the points around each,
/// by volume, as lay_out_quadrature() has them for one mix.
template <class Geometry>
void lay_out_mixes(const ActiveGrid<Geometry::dim>& grid, const Points<Geometry::dim>& points,
                   const std::vector<Mix>& mixes, Quadrature<Geometry>& quadrature) {
  constexpr int D = Geometry::dim;
  struct Sum {
    double V = 0.0, tau_y = 0.0, mu = 0.0;
    void add(const Mix& mix, double structure, double volume) {
      V += volume, tau_y += volume * structure * mix.tau_0, mu += volume * mix.mu;
    }
  };
  quadrature.mu.resize(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    std::array<Sum, power(2, D)> of_place;
    Sum all;
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const auto p = static_cast<std::size_t>(grid.order[i]);
      const Mix& mix = mixes[static_cast<std::size_t>(points.mix[p])];
      const auto share =
          detail::place_shares<D>(local_coordinates<D>(grid.axes, grid.cell_index[c], points.x[p]));
      const double section = points.volume(p) / Geometry::measure(points.x[p]),
                   structure = points.thixotropic() ? 1.0 + points.lambda[p] : 1.0;
      all.add(mix, structure, section);
      for (std::size_t k = 0; k < share.size(); ++k) of_place[k].add(mix, structure, share[k] * section);
    }
    for (std::size_t k = 0; k < of_place.size(); ++k) {
      const Sum& of = of_place[k].V > 0.0 ? of_place[k] : all;  // where no point is near, as in the cell
      quadrature.tau_y[c][k] = of.tau_y / of.V, quadrature.mu[c][k] = of.mu / of.V;
    }
  }
}

}  // namespace tremie
