#include "libmpm/transfer/apic.hpp"

#include <cmath>
#include <memory>

#include "libmpm/geometry/spaces.hpp"
#include "libmpm/grid/node_reduction.hpp"

namespace tremie {

namespace detail {
namespace {

/// Positions of a cell's three nodes in each direction.
template <int D>
std::array<std::array<double, 3>, D> node_positions(const std::array<Axis, D>& axes, const Index<D>& cell) {
  std::array<std::array<double, 3>, D> xi;
  for (int d = 0; d < D; ++d)
    for (int k = 0; k < 3; ++k) xi[d][k] = axes[d].node_position(axes[d].first_node(cell[d]) + k);
  return xi;
}

/// Shape values of one point with the arms x_i - x_p and the stencil's inverse inertia in each direction.
template <int D>
struct PointStencil {
  std::array<SplineValues, D> spline;
  std::array<std::array<double, 3>, D> arm;
  Vec<D> inverse_inertia;

  PointStencil(const std::array<Axis, D>& axes, const Index<D>& cell,
               const std::array<std::array<double, 3>, D>& xi, const Vec<D>& x) {
    const Vec<D> s = local_coordinates<D>(axes, cell, x);
    for (int d = 0; d < D; ++d) {
      spline[d] = splines(axes[d], cell[d], s[d]);
      double inertia = 0.0;
      for (int k = 0; k < 3; ++k) {
        arm[d][k] = xi[d][k] - x[d];
        inertia += spline[d].N[k] * arm[d][k] * arm[d][k];
      }
      // On a wall one spline is 1 and the others 0: no slope can be seen there, and none is given.
      inverse_inertia[d] = inertia > 1e-12 * axes[d].h * axes[d].h ? 1.0 / inertia : 0.0;
    }
  }
  /// The splines with their moments about the point, or with their slopes.
  SpaceWeights with_arms() const {
    SpaceWeights w;
    for (int d = 0; d < D; ++d)
      for (int k = 0; k < 3; ++k) w.N[d][k] = spline[d].N[k], w.slope[d][k] = spline[d].N[k] * arm[d][k];
    return w;
  }
  SpaceWeights with_slopes() const {
    SpaceWeights w;
    for (int d = 0; d < D; ++d)
      for (int k = 0; k < 3; ++k) w.N[d][k] = spline[d].N[k], w.slope[d][k] = spline[d].dN[k];
    return w;
  }
  double N(const Index<D>& o) const {
    double n = 1.0;
    for (int d = 0; d < D; ++d) n *= spline[d].N[o[d]];
    return n;
  }
  Vec<D> arms(const Index<D>& o) const {
    Vec<D> a;
    for (int d = 0; d < D; ++d) a[d] = arm[d][o[d]];
    return a;
  }
  Vec<D> gradient(const Index<D>& o) const {
    Vec<D> g;
    for (int d = 0; d < D; ++d) {
      g[d] = spline[d].dN[o[d]];
      for (int e = 0; e < D; ++e)
        if (e != d) g[d] *= spline[e].N[o[e]];
    }
    return g;
  }
};

/// Momenta and masses that the points of a cell give its nodes.
template <int D>
void cell_momenta(const ActiveGrid<D>& grid, const Points<D>& points, int c,
                  std::array<Vec<D + 1>, power(3, D)>& local) {
  const auto xi = node_positions<D>(grid.axes, grid.cell_index[c]);
  for (auto& sum : local) sum.setZero();
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const PointStencil<D> st(grid.axes, grid.cell_index[c], xi, points.x[p]);
    const Mat<D, D>& C = points.C[p];
    for (int k = 0; k < power(3, D); ++k) {
      const Index<D> o = local_offset<D>(k);
      const double m = points.mass[p] * st.N(o);
      local[k].template head<D>() += m * (points.v[p] + C * st.arms(o));
      local[k][D] += m;
    }
  }
}
CellQuads cell_momenta(const ActiveGrid<3>& grid, const Points<3>& points, int c) {
  const auto xi = node_positions<3>(grid.axes, grid.cell_index[c]);
  CellQuads sum{};
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const PointStencil<3> st(grid.axes, grid.cell_index[c], xi, points.x[p]);
    const double m = points.mass[p];
    std::array<f64x4, 3> slope;
    for (int d = 0; d < 3; ++d) slope[d] = m * to_quad(points.C[p].col(d));
    spread(st.with_arms(), m * to_quad(points.v[p], 1.0), slope, sum);
  }
  return sum;
}

/// Masses, and momenta in the place of velocities, that the points give the nodes: cell by cell.
template <int D>
void add_momenta(const ActiveGrid<D>& grid, const Points<D>& points, NodalState<D>& nodes) {
  constexpr int n_local = power(3, D), at_a_time = 4096;
  nodes.mass.assign(grid.node_index.size(), 0.0);
  nodes.v.assign(grid.node_index.size(), Vec<D>::Zero());
  using Momenta = std::array<Vec<D + 1>, n_local>;
  const std::unique_ptr<Momenta[]> local(new Momenta[std::min(grid.n_cells(), at_a_time)]);
  for (int first = 0; first < grid.n_cells(); first += at_a_time) {
    const int last = std::min(first + at_a_time, grid.n_cells());
#pragma omp parallel for schedule(static)
    for (int c = first; c < last; ++c) cell_momenta(grid, points, c, local[c - first]);
    for (int c = first; c < last; ++c)
      for (int k = 0; k < n_local; ++k) {
        const int i = grid.cell_nodes[c][k];
        nodes.v[i] += local[c - first][k].template head<D>();
        nodes.mass[i] += local[c - first][k][D];
      }
  }
}
/// In 3D in chunks of cells.
[[maybe_unused]] void add_momenta(const ActiveGrid<3>& grid, const Points<3>& points, NodalState<3>& nodes) {
  resize_for_overwrite(nodes.mass, grid.node_index.size());
  resize_for_overwrite(nodes.v, grid.node_index.size());
  const auto give = [&](int c, double* to) {
    const CellQuads momenta = cell_momenta(grid, points, c);
    for (std::size_t k = 0; k < 27; ++k)
      add_to_node(momenta[k], to + 4 * std::ptrdiff_t{grid.cell_nodes[c][k]});
  };
  sum_over_cells(grid, give, [&](int i, const Vec<4>& sum) {
    nodes.v[i] = sum.head<3>();
    nodes.mass[i] = sum[3];
  });
}

/// What the nodes of a cell say of the place of a point: velocity and, column by column, its moments about
/// it.
template <int D>
void velocity_at(const std::array<Vec<D>, power(3, D)>& u, const PointStencil<D>& st, Vec<D>& vp,
                 Mat<D, D>& moment) {
  vp.setZero(), moment.setZero();
  for (int k = 0; k < power(3, D); ++k) {
    const Index<D> o = local_offset<D>(k);
    const Vec<D> Nv = st.N(o) * u[k];
    vp += Nv;
    moment += Nv * st.arms(o).transpose();
  }
}
[[maybe_unused]] void velocity_at(const CellQuads& u, const PointStencil<3>& st, Vec<3>& vp,
                                  Mat<3, 3>& moment) {
  f64x4 value;
  std::array<f64x4, 3> slope;
  contract(u, st.with_arms(), value, slope);
  vp = to_vec(value);
  for (int d = 0; d < 3; ++d) moment.col(d) = to_vec(slope[d]);
}

/// use(c, p, st, u) for all points p of all cells c: the stencil of the point and the nodal vectors v of the cell.
template <int D, class Use>
void for_each_point(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, const Points<D>& points,
                    Use use) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const auto xi = node_positions<D>(grid.axes, grid.cell_index[c]);
    const auto u = at_controls(grid, v, c);
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const int p = grid.order[i];
      use(c, p, PointStencil<D>(grid.axes, grid.cell_index[c], xi, points.x[p]), u);
    }
  }
}

/// grid_to_point(), whatever the motion.
template <int D, class Move>
void move_with_grid(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, const std::vector<Vec<D>>& v_old,
                    const Transfer& transfer, double dt, Points<D>& points, const Move& motion) {
  points.C.resize(points.size());
  for_each_point(grid, v, points, [&](int c, int p, const PointStencil<D>& st, const auto& u) {
    Vec<D> vp, vp_old = Vec<D>::Zero();
    Mat<D, D> moment, unused;
    velocity_at(u, st, vp, moment);
    if (transfer.flip) velocity_at(at_controls(grid, v_old, c), st, vp_old, unused);
    points.C[p] =
        transfer.flip ? Mat<D, D>(Mat<D, D>::Zero()) : Mat<D, D>(moment * st.inverse_inertia.asDiagonal());
    points.v[p] = transfer.flip ? Vec<D>(vp + transfer.flip_blend * (points.v[p] - vp_old)) : vp;
    const Vec<D> from = points.x[p];
    motion.move(points, p, vp, dt);
    keep_in_domain<D>(grid, from, points.x[p]);
  });
}

}  // namespace
}  // namespace detail

template <int D>
void point_to_grid(const ActiveGrid<D>& grid, const Points<D>& points, NodalState<D>& nodes) {
  detail::add_momenta(grid, points, nodes);
  for (const MirrorNode<D>& m : grid.mirrors) nodes.v[m.of] += m.sign.cwiseProduct(nodes.v[m.node]);
  fold_mirrors<D>(grid, nodes.mass);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < grid.n_nodes(); ++i)
    if (nodes.mass[i] > 0.0) nodes.v[i] /= nodes.mass[i];
  fill_mirrors<D>(grid, nodes.v);
}

template <int D>
void grid_to_point(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, const std::vector<Vec<D>>& v_old,
                   const Transfer& transfer, double dt, Points<D>& points, const StraightAhead& motion) {
  detail::move_with_grid(grid, v, v_old, transfer, dt, points, motion);
}
void grid_to_point(const ActiveGrid<2>& grid, const std::vector<Vec<2>>& v, const std::vector<Vec<2>>& v_old,
                   const Transfer& transfer, double dt, Points<2>& points, const Motion<Polar>& motion) {
  detail::move_with_grid(grid, v, v_old, transfer, dt, points, motion);
}

template <int D>
void affine_from_grid(const ActiveGrid<D>& grid, const std::vector<Vec<D>>& v, Points<D>& points) {
  points.C.resize(points.size());
  detail::for_each_point(grid, v, points, [&](int, int p, const detail::PointStencil<D>& st, const auto& u) {
    Vec<D> vp;
    Mat<D, D> moment;
    detail::velocity_at(u, st, vp, moment);
    points.C[p] = moment * st.inverse_inertia.asDiagonal();
  });
}

template <class Geometry>
void shear_rate_at_points(const ActiveGrid<Geometry::dim>& grid, const std::vector<Vec<Geometry::dim>>& v,
                          const Points<Geometry::dim>& points, std::vector<double>& gamma_dot) {
  constexpr int D = Geometry::dim;
  gamma_dot.resize(points.size());
  detail::for_each_point(grid, v, points, [&](int, int p, const detail::PointStencil<D>& st, const auto& u) {
    if constexpr (D == 3) {
      f64x4 value;
      std::array<f64x4, 3> slope;
      detail::contract(u, st.with_slopes(), value, slope);
      Mat<3, 3> L;
      for (int d = 0; d < 3; ++d) L.col(d) = detail::to_vec(slope[d]);
      const Mat<3, 3> rate = L + L.transpose();  // 2 D
      gamma_dot[p] = std::sqrt(0.5 * (rate.squaredNorm() - rate.trace() * rate.trace() / 3.0));
    } else {
      Vec<Geometry::n_strain> q = Vec<Geometry::n_strain>::Zero();
      for (int k = 0; k < power(3, D); ++k) {
        const Index<D> o = local_offset<D>(k);
        q += Geometry::strain_rows(st.N(o), st.gradient(o), points.x[p]) * u[k];
      }
      gamma_dot[p] = q.norm();
    }
  });
}

#define TREMIE_TRANSFER_IN(D)                                                                               \
  template void point_to_grid(const ActiveGrid<D>&, const Points<D>&, NodalState<D>&);                      \
  template void grid_to_point(const ActiveGrid<D>&, const std::vector<Vec<D>>&, const std::vector<Vec<D>>&, \
                              const Transfer&, double, Points<D>&, const StraightAhead&);
TREMIE_TRANSFER_IN(2)
#ifndef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
TREMIE_TRANSFER_IN(1)
TREMIE_TRANSFER_IN(3)
template void affine_from_grid(const ActiveGrid<3>&, const std::vector<Vec<3>>&, Points<3>&);
#endif

#define TREMIE_SHEAR_RATES_IN(Geometry)                                                \
  template void shear_rate_at_points<Geometry>(const ActiveGrid<Geometry::dim>&,       \
                                               const std::vector<Vec<Geometry::dim>>&, \
                                               const Points<Geometry::dim>&, std::vector<double>&);
TREMIE_IN_ALL_SPACES(TREMIE_SHEAR_RATES_IN)

}  // namespace tremie
