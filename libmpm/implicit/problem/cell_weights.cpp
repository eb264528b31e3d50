#include "libmpm/implicit/problem/cell_weights.hpp"

#include <array>

#include "libmpm/geometry/spaces.hpp"
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

/// Mass of a cell's points, and their density.
struct CellMass {
  double mass = 0.0, density = 0.0;  ///< [kg], [kg/m^3]
};

template <int D>
CellMass mass_of_cell(const ActiveGrid<D>& grid, const Points<D>& points, int c) {
  double mass = 0.0, volume = 0.0;
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    mass += points.mass[grid.order[i]];
    volume += points.volume(grid.order[i]);
  }
  return {mass, mass / volume};
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
    const double mass = full ? mass_of_cell<3>(grid, points, c).density * quadrature.V_cell[c] : 1.0;
    for (std::size_t k = 0; k < 27; ++k) to[4 * std::ptrdiff_t{grid.cell_nodes[c][k]}] += mass * of[k];
  };
  sum_over_cells(grid, give, [&](int i, const Vec<4>& sum) { weight[i] = sum[0]; });
  fold_mirrors<3>(grid, weight);
  return weight;
}

template <class Geometry>
std::vector<Vec<2>> balanced_weights(const ActiveGrid<2>& grid, const Points<2>& points,
                                     const Quadrature<Geometry>& quadrature, const Vec<2>& gravity,
                                     bool inside) {
  Eigen::VectorXd R = Eigen::VectorXd::Zero(grid.n_nodes() * 2);
  for (int c = 0; c < grid.n_cells(); ++c) {
    const Index<2>& cell = grid.cell_index[c];
    const bool full = is_inside<2>(grid, cell);
    if (inside && !full) {
      for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
        const int p = grid.order[i];
        const Stencil<2> st = stencil<2>(grid.axes, cell, local_coordinates<2>(grid.axes, cell, points.x[p]));
        for (std::size_t k = 0; k < 9; ++k)
          R.segment<2>(grid.cell_nodes[c][k] * 2) += points.mass[p] * st.N[k] * gravity;
      }
      continue;
    }
    const CellMass of = mass_of_cell<2>(grid, points, c);
    const double density = full ? of.density : of.mass / quadrature.V_cell[c];
    std::array<Vec<2>, 4> x;
    Vec<2> middle = Vec<2>::Zero();
    for (std::size_t k = 0; k < 4; ++k) {
      x[k] = position_in_cell<2>(grid.axes, cell, quadrature.place[c][k]);
      middle += quadrature.V[c][k] / quadrature.V_cell[c] * x[k];
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const Stencil<2> st = stencil<2>(grid.axes, cell, quadrature.place[c][k]);
      const double mass = density * quadrature.V[c][k], fall = gravity.dot(x[k] - middle);
      for (std::size_t i = 0; i < 9; ++i)
        R.segment<2>(grid.cell_nodes[c][i] * 2) +=
            mass * (st.N[i] * gravity + fall * Geometry::divergence_row(st.N[i], st.g[i], x[k]));
    }
  }
  fold_mirrors<2>(grid, R);
  std::vector<Vec<2>> force(grid.node_index.size());
  for (int i = 0; i < grid.n_nodes(); ++i) force[i] = R.segment<2>(i * 2);
  return force;
}

#define TREMIE_BALANCED_WEIGHTS_IN(Section)                                             \
  template std::vector<Vec<2>> balanced_weights(const ActiveGrid<2>&, const Points<2>&, \
                                                const Quadrature<Section>&, const Vec<2>&, bool);
TREMIE_IN_SECTIONS(TREMIE_BALANCED_WEIGHTS_IN)

}  // namespace tremie
