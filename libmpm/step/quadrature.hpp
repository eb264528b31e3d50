#pragma once

// Where the stresses of an implicit step are integrated.
//
// A yield stress fluid has no memory of strain: its deviatoric stress follows from the velocity gradient of
// the moment and from lambda. So the stresses are integrated at 2^D Gauss places a cell instead of at the
// points, each weighted with the volume of the points in its part of the cell, or with the part's own where
// the cell lies inside the body. The cost of a solve then does not depend on the number of points, and more
// points a cell make the weights smoother without making the solver slower.

#include <array>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/law/equation_of_state.hpp"
#include "libmpm/points/points.hpp"

namespace tremie {

template <class Space>
struct Quadrature {
  static constexpr int D = Space::dim, n_strain = Space::n_strain;
  static constexpr int n_places = power(2, D), n_local = power(3, D);
  using StrainRows = std::array<Mat<n_strain, D>, n_local>;

  std::vector<std::array<StrainRows, n_places>> B;  ///< strain rows, [1/m]
  std::vector<std::array<Vec<D>, n_local>> b;       ///< rows of the cell's mean divergence [1/m]
  std::vector<std::array<double, n_places>> V;      ///< concrete volume of each place [m^3]
  std::vector<std::array<double, n_places>> tau_y;  ///< yield stress there [Pa]
  std::vector<double> V_cell;                       ///< sum of V [m^3]
  std::vector<double> p;                            ///< pressure at the start of the step [Pa]

  void resize(std::size_t n) {
    B.resize(n), b.resize(n), V.resize(n), tau_y.resize(n), V_cell.resize(n), p.resize(n);
  }
};

/// Local coordinates of Gauss place k, and the bit pattern of its part: bit d set means the upper half in
/// direction d.
template <int D>
Vec<D> gauss_place(int k) {
  constexpr double offset = 0.28867513459481288;  // 1 / (2 sqrt 3)
  Vec<D> s;
  for (int d = 0; d < D; ++d) s[d] = 0.5 + ((k >> d) & 1 ? offset : -offset);
  return s;
}

namespace detail {

/// Local coordinates of the middle of part k.
template <int D>
Vec<D> part_middle(int k) {
  Vec<D> s;
  for (int d = 0; d < D; ++d) s[d] = (k >> d) & 1 ? 0.75 : 0.25;
  return s;
}

/// Number of the part of cell c that holds the place x.
template <int D>
int part_of(const ActiveGrid<D>& grid, int c, const Vec<D>& x) {
  const Vec<D> s = local_coordinates<D>(grid.axes, grid.cell_index[c], x);
  int k = 0;
  for (int d = 0; d < D; ++d) k |= (s[d] >= 0.5 ? 1 : 0) << d;
  return k;
}

/// Volumes of the parts of a cell as the points in it say.
template <class Space>
std::array<double, power(2, Space::dim)> part_volumes(const ActiveGrid<Space::dim>& grid,
                                                      const Points<Space::dim>& points, int c) {
  std::array<double, power(2, Space::dim)> volume{};
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    volume[part_of<Space::dim>(grid, c, points.x[p])] += points.volume(p);
  }
  return volume;
}

/// Volumes of the parts of a full cell, as the Gauss rule has them.
template <class Space>
std::array<double, power(2, Space::dim)> full_volumes(
    const std::array<Axis, Space::dim>& axes, const std::array<Vec<Space::dim>, power(2, Space::dim)>& x) {
  double part = 1.0;
  for (const Axis& axis : axes) part *= 0.5 * axis.h;
  std::array<double, power(2, Space::dim)> volume;
  for (std::size_t k = 0; k < volume.size(); ++k) volume[k] = part * Space::measure(x[k]);
  return volume;
}

/// Strain rows at every place and the rows of the cell's mean divergence.
template <class Space>
void lay_out_rows(const std::array<Stencil<Space::dim>, power(2, Space::dim)>& st,
                  const std::array<Vec<Space::dim>, power(2, Space::dim)>& x, int c,
                  Quadrature<Space>& quadrature) {
  constexpr int n = power(2, Space::dim), n_local = power(3, Space::dim);
  double V_cell = 0.0;
  for (int k = 0; k < n; ++k) V_cell += quadrature.V[c][k];
  quadrature.V_cell[c] = V_cell;
  for (int i = 0; i < n_local; ++i) {
    quadrature.b[c][i].setZero();
    for (int k = 0; k < n; ++k) {
      quadrature.B[c][k][i] = Space::strain_rows(st[k].N[i], st[k].g[i], x[k]);
      quadrature.b[c][i] += quadrature.V[c][k] / V_cell * Space::divergence_row(st[k].N[i], st[k].g[i], x[k]);
    }
  }
}

/// Volume mean of the pressures of a cell's points.
template <int D>
double mean_pressure(const ActiveGrid<D>& grid, const Points<D>& points, double K, int c) {
  double sum = 0.0, volume = 0.0;
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    sum += points.volume(p) * pressure(points.ln_J[p], K);
    volume += points.volume(p);
  }
  return sum / volume;
}

/// Mean of 1 + lambda over the points of each part of a cell, of the whole cell where a part has none.
template <class Space>
std::array<double, power(2, Space::dim)> mean_structure(const ActiveGrid<Space::dim>& grid,
                                                        const Points<Space::dim>& points, int c) {
  constexpr int n = power(2, Space::dim);
  std::array<double, n> sum{}, volume{};
  double cell_sum = 0.0, cell_volume = 0.0;
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const int k = part_of<Space::dim>(grid, c, points.x[p]);
    const double V = points.volume(p), structure = 1.0 + points.lambda[p];
    sum[k] += V * structure, volume[k] += V;
    cell_sum += V * structure, cell_volume += V;
  }
  for (int k = 0; k < n; ++k) sum[k] = volume[k] > 0.0 ? sum[k] / volume[k] : cell_sum / cell_volume;
  return sum;
}

}  // namespace detail

/// Lays out the quadrature of a step: places, volumes, yield stresses tau_y = (1 + lambda) tau_0 and
/// pressures.
template <class Space>
void lay_out_quadrature(const ActiveGrid<Space::dim>& grid, const Points<Space::dim>& points, double tau_0,
                        double K, Quadrature<Space>& quadrature) {
  constexpr int D = Space::dim, n = power(2, D);
  quadrature.resize(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const Index<D>& cell = grid.cell_index[c];
    std::array<Stencil<D>, n> st;
    std::array<Vec<D>, n> x;
    for (int k = 0; k < n; ++k) {
      x[k] = cell_place<D>(grid.axes, cell, gauss_place<D>(k));
      st[k] = stencil<D>(grid.axes, cell, gauss_place<D>(k));
    }
    if (is_inside<D>(grid, cell)) {
      // Counting points there would make the pressure push whenever one crosses from part to part.
      quadrature.V[c] = detail::full_volumes<Space>(grid.axes, x);
    } else {
      quadrature.V[c] = detail::part_volumes<Space>(grid, points, c);
      // A full part must weigh what the Gauss rule gives its place, or a uniform pressure would push: in a
      // ring the place does not lie at the part's middle radius.
      for (int k = 0; k < n; ++k)
        quadrature.V[c][k] *=
            Space::measure(x[k]) / Space::measure(cell_place<D>(grid.axes, cell, detail::part_middle<D>(k)));
    }
    detail::lay_out_rows<Space>(st, x, c, quadrature);
    quadrature.p[c] = detail::mean_pressure(grid, points, K, c);
    quadrature.tau_y[c].fill(tau_0);
    if (!points.thixotropic()) continue;
    const std::array<double, n> structure = detail::mean_structure<Space>(grid, points, c);
    for (int k = 0; k < n; ++k) quadrature.tau_y[c][k] = structure[k] * tau_0;
  }
}

}  // namespace tremie
