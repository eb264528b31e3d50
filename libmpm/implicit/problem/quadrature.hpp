#pragma once

// Where the stresses of an implicit step are integrated.
//
// A yield stress fluid has no memory of strain: its deviatoric stress follows from the velocity gradient of
// the moment and from lambda. So the stresses are integrated at 2^D quadrature points a cell instead of at the
// points, each weighted with the volume of the points around it. The cost of a solve then does not depend on
// the number of points, and more points a cell make the weights smoother without making the solver slower.

#include <array>
#include <numeric>
#include <type_traits>
#include <vector>

#include "libmpm/constitutive/equation_of_state.hpp"
#include "libmpm/grid/active_grid.hpp"
#include "libmpm/implicit/problem/cut_cell_rule.hpp"
#include "libmpm/implicit/problem/wall_films.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// Strain rows of every cell: one entry a cell, or, where they are the same in all cells but for the splines
/// at walls, one a kind of cell.
template <class Rows, bool by_kind>
class CellRows {
 public:
  void resize(std::size_t n) {
    resize_for_overwrite(kind_, by_kind ? n : 0);
    resize_for_overwrite(rows_, by_kind ? 64 : n);
  }
  const Rows& operator[](std::size_t c) const { return rows_[by_kind ? kind_[c] : c]; }
  Rows& entry(std::size_t c) { return rows_[c]; }
  void set_kind(std::size_t c, unsigned char kind) { kind_[c] = kind; }

 private:
  std::vector<unsigned char> kind_;
  std::vector<Rows> rows_;
};

/// Six bits: of which axes a cell touches the low end, low(axis, c), and the high one.
template <class Low, class High>
unsigned char ends_touched(const std::array<Axis, 3>& axes, const Index<3>& cell, Low low, High high) {
  unsigned ends = 0;
  for (int d = 0; d < 3; ++d) {
    if (low(axes[d], cell[d])) ends |= 1u << (2 * d);
    if (high(axes[d], cell[d])) ends |= 2u << (2 * d);
  }
  return static_cast<unsigned char>(ends);
}
/// Walls and repeated knots: a cell's splines follow from them.
inline unsigned char cell_kind(const std::array<Axis, 3>& axes, const Index<3>& cell) {
  return ends_touched(
      axes, cell, [](const Axis& a, int c) { return a.interpolates_low(c); },
      [](const Axis& a, int c) { return a.interpolates_high(c); });
}
/// And planes of symmetry: what a cell's nodes are follows from them.
inline unsigned char cell_ends(const std::array<Axis, 3>& axes, const Index<3>& cell) {
  return ends_touched(
      axes, cell, [](const Axis& a, int c) { return a.interpolates_low(c) || (a.wall_low() && c == 0); },
      [](const Axis& a, int c) { return a.interpolates_high(c) || (a.wall_high() && c == a.n_cells - 1); });
}

template <class Geometry>
struct Quadrature {
  static constexpr int D = Geometry::dim, n_strain = Geometry::n_strain;
  static constexpr int n_places = power(2, D), n_local = power(3, D);
  static constexpr bool by_kind = std::is_same_v<Geometry, ThreeD>;  ///< else rows are kept cell by cell
  using StrainRows = std::array<Mat<n_strain, D>, n_local>;

  using DivergenceRows = std::array<Vec<D>, n_local>;

  CellRows<std::array<StrainRows, n_places>, by_kind> B;  ///< strain rows, [1/m]
  std::vector<DivergenceRows> b;                          ///< cell by cell: rows of the mean divergence [1/m]
  CellRows<std::array<DivergenceRows, n_places>, by_kind> slopes;  ///< by kind: the splines' gradients [1/m]
  std::vector<char> full;  ///< in 3D: whether the cell lies inside the body and counts as full
  std::vector<std::array<double, n_places>> V;      ///< concrete volume of each place [m^3]
  std::vector<std::array<double, n_places>> tau_y;  ///< yield stress there [Pa]
  // Between side walls that hold (side_walls.hpp), else empty:
  std::vector<std::array<double, n_places>>
      own_yield;  ///< the concrete's, of which tau_y is the plane's share [Pa]
  std::vector<std::array<double, n_places>> wall_yield;  ///< what the walls may hold there [Pa]
  std::vector<std::array<double, n_places>> mu;     ///< plastic viscosity there [Pa s]; empty: one everywhere
  std::vector<double> V_cell;                       ///< sum of V [m^3]
  std::vector<double> p;                            ///< pressure at the start of the step [Pa]
  std::vector<std::array<Vec<D>, n_places>> place;  ///< local coordinates of the places, in a section
  /// Rows of how the divergence at each place differs from its cell's mean [1/m]; empty where nothing asks for it.
  std::vector<std::array<DivergenceRows, n_places>> excess;

  /// The concrete's yield stress at a place [Pa].
  double yield_of_concrete(int c, int k) const { return own_yield.empty() ? tau_y[c][k] : own_yield[c][k]; }

  void resize(std::size_t n) {
    B.resize(n), resize_for_overwrite(V, n), resize_for_overwrite(tau_y, n), resize_for_overwrite(V_cell, n),
        resize_for_overwrite(p, n);
    if constexpr (!by_kind)
      resize_for_overwrite(b, n), resize_for_overwrite(place, n);
    else
      slopes.resize(n), resize_for_overwrite(full, n);
  }

  /// Rows of the mean divergence of cell c [1/m]. In 3D they are made when they are asked for: 648 bytes a
  /// cell from its eight volumes.
  std::conditional_t<by_kind, DivergenceRows, const DivergenceRows&> divergence_rows(int c) const {
    if constexpr (!by_kind) {
      return b[c];
    } else {
      const auto of_place = [&](int k) {
        return V[c][k] / V_cell[c] * Eigen::Map<const Vec<3 * n_local>>(slopes[c][k][0].data());
      };
      DivergenceRows sum;  // at once: it stays in registers
      Eigen::Map<Vec<3 * n_local>>(sum[0].data()) = of_place(0) + of_place(1) + of_place(2) + of_place(3) +
                                                    of_place(4) + of_place(5) + of_place(6) + of_place(7);
      return sum;
    }
  }
};

/// Local coordinates of quadrature point k of a full cell; bit d of k set means the upper one in direction d.
template <int D>
Vec<D> quadrature_point(int k) {
  constexpr double offset = 0.28867513459481288;  // 1 / (2 sqrt 3)
  Vec<D> s;
  for (int d = 0; d < D; ++d) s[d] = 0.5 + ((k >> d) & 1 ? offset : -offset);
  return s;
}

namespace detail {

/// Shares of a point at the local coordinates s in the quadrature points of its cell: linear between them, so that
/// the weights change continuously while points move, sum to one and keep the point's place wherever they
/// can.
template <int D>
std::array<double, power(2, D)> place_shares(const Vec<D>& s) {
  constexpr double low = 0.5 - 0.28867513459481288, high = 0.5 + 0.28867513459481288;
  std::array<double, power(2, D)> share;
  share.fill(1.0);
  for (int d = 0; d < D; ++d) {
    const double upper = std::clamp((s[d] - low) / (high - low), 0.0, 1.0);
    for (int k = 0; k < power(2, D); ++k) share[k] *= (k >> d) & 1 ? upper : 1.0 - upper;
  }
  return share;
}

/// Volumes of the quadrature points of cell c, and 1 + lambda times volume where the points have lambda. A place
/// weighs what the Gauss rule gives it in a full cell, or a uniform pressure would push: in a ring that is
/// the points' sections times the place's own measure, not theirs.
template <class Geometry>
void add_up_points(const ActiveGrid<Geometry::dim>& grid, const Points<Geometry::dim>& points, int c,
                   const std::array<Vec<Geometry::dim>, power(2, Geometry::dim)>& places,
                   std::array<double, power(2, Geometry::dim)>& volume,
                   std::array<double, power(2, Geometry::dim)>& structure) {
  volume.fill(0.0);
  structure.fill(0.0);
  for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
    const int p = grid.order[i];
    const auto share = place_shares<Geometry::dim>(
        local_coordinates<Geometry::dim>(grid.axes, grid.cell_index[c], points.x[p]));
    const double section = points.volume(p) / Geometry::measure(points.x[p]);
    const double factor = points.thixotropic() ? 1.0 + points.lambda[p] : 1.0;
    for (std::size_t k = 0; k < share.size(); ++k) {
      volume[k] += share[k] * section;
      structure[k] += share[k] * section * factor;
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    volume[k] *= Geometry::measure(places[k]);
    structure[k] *= Geometry::measure(places[k]);
  }
}

/// Volumes of the quadrature points of a full cell.
template <class Geometry>
std::array<double, power(2, Geometry::dim)> full_volumes(
    const std::array<Axis, Geometry::dim>& axes,
    const std::array<Vec<Geometry::dim>, power(2, Geometry::dim)>& places) {
  double section = 1.0;
  for (const Axis& axis : axes) section *= 0.5 * axis.h;
  std::array<double, power(2, Geometry::dim)> volume;
  for (std::size_t k = 0; k < volume.size(); ++k) volume[k] = section * Geometry::measure(places[k]);
  return volume;
}

/// Strain rows at every quadrature point and the rows of the cell's mean divergence, kept cell by cell.
template <class Geometry>
void lay_out_rows(const std::array<Stencil<Geometry::dim>, power(2, Geometry::dim)>& st,
                  const std::array<Vec<Geometry::dim>, power(2, Geometry::dim)>& x, int c,
                  Quadrature<Geometry>& quadrature) {
  constexpr int n = power(2, Geometry::dim), n_local = power(3, Geometry::dim);
  for (int i = 0; i < n_local; ++i) {
    quadrature.b[c][i].setZero();
    for (int k = 0; k < n; ++k) {
      quadrature.B.entry(c)[k][i] = Geometry::strain_rows(st[k].N[i], st[k].g[i], x[k]);
      quadrature.b[c][i] +=
          quadrature.V[c][k] / quadrature.V_cell[c] * Geometry::divergence_row(st[k].N[i], st[k].g[i], x[k]);
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

/// Strain rows in 3D, one set for each kind of cell that there is.
inline void lay_out_kinds(const ActiveGrid<3>& grid, Quadrature<ThreeD>& quadrature) {
  std::array<bool, 64> done{};
  for (int c = 0; c < grid.n_cells(); ++c) {
    const unsigned char kind = cell_kind(grid.axes, grid.cell_index[c]);
    quadrature.B.set_kind(c, kind);
    quadrature.slopes.set_kind(c, kind);
    if (done[kind]) continue;
    done[kind] = true;
    for (int k = 0; k < 8; ++k) {
      const Stencil<3> st = stencil<3>(grid.axes, grid.cell_index[c], quadrature_point<3>(k));
      for (int i = 0; i < 27; ++i) {
        quadrature.B.entry(kind)[k][i] = ThreeD::strain_rows(st.N[i], st.g[i], Vec<3>::Zero());
        quadrature.slopes.entry(kind)[k][i] = ThreeD::divergence_row(st.N[i], st.g[i], Vec<3>::Zero());
      }
    }
  }
}

/// What is in a cell on the floor lies on it: its lower places are full before its upper ones hold anything. Points
/// that a front has rolled over never settle there, and the floor would hold with a part of the yield stress.
template <class Geometry>
void settle_on_floor(const ActiveGrid<Geometry::dim>& grid, const Index<Geometry::dim>& cell,
                     const std::array<Vec<Geometry::dim>, power(2, Geometry::dim)>& x,
                     std::array<double, power(2, Geometry::dim)>& V) {
  if constexpr (requires { Geometry::up; }) {
    constexpr int up = Geometry::up;
    if (!grid.axes[up].clamped_low() || cell[up] != 0) return;
    const auto full = full_volumes<Geometry>(grid.axes, x);
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      if ((k >> up) & 1) continue;
      const int above = k | (1 << up);
      const double all = V[k] + V[above];
      V[k] = std::min(all, std::max(V[k], full[k]));
      V[above] = all - V[k];
    }
  }
}

}  // namespace detail

/// Lays out the quadrature of a step: places, volumes, yield stresses tau_y = (1 + lambda) tau_0 and
/// pressures. `fit`: the places of partly filled cells are fitted to their points (cut_cell_rule.hpp), in a
/// section; in 3D films are held on their walls (wall_films.hpp). `settle`: partly filled cells on the floor are full from below.
template <class Geometry>
void lay_out_quadrature(const ActiveGrid<Geometry::dim>& grid, const Points<Geometry::dim>& points,
                        double tau_0, double K, Quadrature<Geometry>& quadrature, bool fit = false,
                        bool settle = false) {
  constexpr int D = Geometry::dim, n = power(2, D);
  quadrature.resize(grid.cell_index.size());
  if constexpr (D == 3) detail::lay_out_kinds(grid, quadrature);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const Index<D>& cell = grid.cell_index[c];
    const bool inside = is_inside<D>(grid, cell), fitted = D < 3 && fit && !inside;
    std::array<Vec<D>, n> place;
    for (int k = 0; k < n; ++k) place[k] = quadrature_point<D>(k);
    if (fitted) place = cut_cell_rule<Geometry>(grid, points, c);
    if (D < 3) quadrature.place[c] = place;
    std::array<Vec<D>, n> x;
    for (int k = 0; k < n; ++k) x[k] = position_in_cell<D>(grid.axes, cell, place[k]);
    std::array<double, n> structure;
    detail::add_up_points<Geometry>(grid, points, c, x, quadrature.V[c], structure);
    double all_V = 0.0, all_structure = 0.0;
    for (int k = 0; k < n; ++k) all_V += quadrature.V[c][k], all_structure += structure[k];
    for (int k = 0; k < n; ++k)  // where no point is near, as in the rest of the cell
      quadrature.tau_y[c][k] =
          tau_0 * (quadrature.V[c][k] > 0.0 ? structure[k] / quadrature.V[c][k] : all_structure / all_V);
    if (fitted) {
      double section = 0.0;
      for (int k = 0; k < n; ++k) section += quadrature.V[c][k] / Geometry::measure(x[k]);
      for (int k = 0; k < n; ++k) quadrature.V[c][k] = section / n * Geometry::measure(x[k]);
    }
    if (settle && !inside) detail::settle_on_floor<Geometry>(grid, cell, x, quadrature.V[c]);
    if constexpr (D == 3)
      if (fit && !inside) hold_film(grid, cell, quadrature.V[c]);
    // Inside the body a cell is full: with counted volumes the pressure would push whenever a point crosses
    // into a cell.
    if (inside) quadrature.V[c] = detail::full_volumes<Geometry>(grid.axes, x);
    quadrature.V_cell[c] = std::accumulate(quadrature.V[c].begin(), quadrature.V[c].end(), 0.0);
    if constexpr (D == 3) {
      quadrature.full[c] = inside ? 1 : 0;
    } else {
      std::array<Stencil<D>, n> st;
      for (int k = 0; k < n; ++k) st[k] = stencil<D>(grid.axes, cell, place[k]);
      detail::lay_out_rows<Geometry>(st, x, c, quadrature);
    }
    quadrature.p[c] = detail::mean_pressure(grid, points, K, c);
  }
}

/// Lays out the rows of the excess divergence of a section's quadrature.
template <class Geometry>
void lay_out_excess(const ActiveGrid<Geometry::dim>& grid, Quadrature<Geometry>& quadrature) {
  constexpr int D = Geometry::dim;
  quadrature.excess.resize(grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < power(2, D); ++k) {
      const Vec<D>& s = quadrature.place[c][k];
      const Stencil<D> st = stencil<D>(grid.axes, grid.cell_index[c], s);
      const Vec<D> x = position_in_cell<D>(grid.axes, grid.cell_index[c], s);
      for (int i = 0; i < power(3, D); ++i)
        quadrature.excess[c][k][i] = Geometry::divergence_row(st.N[i], st.g[i], x) - quadrature.b[c][i];
    }
}

}  // namespace tremie
