#include "libmpm/implicit/problem/cell_weights.hpp"

#include "libmpm/grid/node_reduction.hpp"
#include "libmpm/transfer/shape_functions.hpp"

namespace tremie {
namespace {

using Shares = std::array<double, 27>;

/// Shares of the nodes in the weight of a full cell, for each kind of cell (cell_kind()).
std::array<Shares, 64> shares_of_kinds(const ActiveGrid<3>& grid, const Quadrature<ThreeD>& quadrature) {
  std::array<Shares, 64> shares;
  std::array<bool, 64> done{};
  for (int c = 0; c < grid.n_cells(); ++c) {
    const unsigned char kind = cell_kind(grid.axes, grid.cell_index[c]);
    if (done[kind] || !quadrature.full[c]) continue;
    done[kind] = true;
    shares[kind].fill(0.0);
    for (int k = 0; k < 8; ++k) {
      const Stencil<3> st = stencil<3>(grid.axes, grid.cell_index[c], quadrature_point<3>(k));
      for (std::size_t i = 0; i < 27; ++i) shares[kind][i] += 0.125 * st.N[i];
    }
  }
  return shares;
}

double density(const ActiveGrid<3>& grid, const Points<3>& points, int c) {
  double mass = 0.0, volume = 0.0;
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    mass += points.mass[grid.order[i]];
    volume += points.volume(grid.order[i]);
  }
  return mass / volume;
}

/// By its points.
Shares counted_weight(const ActiveGrid<3>& grid, const Points<3>& points, int c) {
  Shares sum{};
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const Stencil<3> st = stencil<3>(grid.axes, grid.cell_index[c],
                                     local_coordinates<3>(grid.axes, grid.cell_index[c], points.x[p]));
    for (std::size_t k = 0; k < 27; ++k) sum[k] += points.mass[p] * st.N[k];
  }
  return sum;
}

}  // namespace

std::vector<double> node_weights(const ActiveGrid<3>& grid, const Points<3>& points,
                                 const Quadrature<ThreeD>& quadrature) {
  const std::array<Shares, 64> shares = shares_of_kinds(grid, quadrature);
  std::vector<double> weight(grid.node_index.size());
  const auto give = [&](int c, double* to) {
    const bool full = quadrature.full[c];
    const Shares& of =
        full ? shares[cell_kind(grid.axes, grid.cell_index[c])] : counted_weight(grid, points, c);
    const double mass = full ? density(grid, points, c) * quadrature.V_cell[c] : 1.0;
    for (std::size_t k = 0; k < 27; ++k) to[4 * std::ptrdiff_t{grid.cell_nodes[c][k]}] += mass * of[k];
  };
  sum_over_cells(grid, give, [&](int i, const Vec<4>& sum) { weight[i] = sum[0]; });
  fold_mirrors<3>(grid, weight);
  return weight;
}

}  // namespace tremie
