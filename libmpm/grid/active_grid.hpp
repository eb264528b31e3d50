#pragma once

// The part of the background grid that holds concrete: active cells with their points, active nodes. Made
// anew at every step from the points; its cost follows the concrete, not a box around the apparatus.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "libmpm/geometry/geometries.hpp"
#include "libmpm/grid/axis.hpp"
#include "libmpm/parallel/buffers.hpp"

namespace tremie {

constexpr int power(int base, int exponent) { return exponent == 0 ? 1 : base * power(base, exponent - 1); }

template <int D>
using Index = std::array<int, D>;

/// A dense block of integers over the index range [low, low + extent), -1 where nothing is.
template <int D>
struct IndexMap {
  Index<D> low{}, extent{};
  std::vector<int> value;

  void reset(const Index<D>& from, const Index<D>& to) {  // both inclusive
    low = from;
    std::size_t n = 1;
    for (int d = 0; d < D; ++d) n *= static_cast<std::size_t>(extent[d] = to[d] - from[d] + 1);
    value.assign(n, -1);
  }
  bool contains(const Index<D>& i) const {
    for (int d = 0; d < D; ++d)
      if (i[d] < low[d] || i[d] >= low[d] + extent[d]) return false;
    return true;
  }
  std::size_t offset(const Index<D>& i) const {
    std::size_t o = 0;
    for (int d = 0; d < D; ++d)
      o = o * static_cast<std::size_t>(extent[d]) + static_cast<std::size_t>(i[d] - low[d]);
    return o;
  }
  int at(const Index<D>& i) const { return contains(i) ? value[offset(i)] : -1; }
};

/// A rigid wall that fills whole cells, between faces of the grid that are repeated knots or walls; a sheet where a
/// low face is also the high one. No concrete enters it.
template <int D>
struct Block {
  Index<D> low, high;                               ///< faces: the cells [low, high)
  std::function<Vec<D>(const Vec<D>& x)> velocity;  ///< of the block at x [m/s]
};

/// A thin wall on a face of the grid that is a repeated knot: the cells on its two sides share the nodes on the face
/// alone, so that a velocity fixed at these nodes holds on the whole wall. It stands where the coordinate of another
/// direction is within [from, to), and may grow or shrink there; normal to itself it does not move.
template <int D>
struct Sheet {
  int normal = 0, face = 0;                ///< direction across it; the cells above it
  int along = 1;                           ///< the other direction
  double from = 0.0, to = 0.0;             ///< [m]
  FaceKind contact = FaceKind::free_slip;  ///< no_slip, free_slip or wall_law
  Vec<D> velocity = Vec<D>::Zero();        ///< along itself [m/s]
};

/// An active node behind a plane of symmetry: its velocity is that of node `of`, component by component times
/// `sign`. It is no unknown of its own.
template <int D>
struct MirrorNode {
  int node, of;
  Vec<D> sign;
  bool operator==(const MirrorNode&) const = default;
};

/// The active nodes of every cell, local node by local node.
template <int D>
using CellNodes = std::vector<std::array<int, power(3, D)>>;

template <int D>
struct ActiveGrid {
  static constexpr int n_local = power(3, D);  ///< nodes seen by a cell

  std::array<Axis, D> axes;
  std::vector<Block<D>> blocks;
  std::vector<Sheet<D>> sheets;

  std::vector<Index<D>> cell_index;  ///< of each active cell, in lexicographic order
  CellNodes<D> cell_nodes;
  std::vector<int> cell_begin;       ///< points order[cell_begin[c] .. cell_begin[c+1]) lie in cell c
  std::vector<int> order;            ///< point numbers sorted by cell, ties in point order
  std::vector<Index<D>> node_index;  ///< node index of each active node
  IndexMap<D> cell_map, node_map;    ///< index -> active number
  std::vector<MirrorNode<D>> mirrors;

  int n_cells() const { return static_cast<int>(cell_index.size()); }
  int n_nodes() const { return static_cast<int>(node_index.size()); }
  Vec<D> node_position(int node) const {
    Vec<D> x;
    for (int d = 0; d < D; ++d) x[d] = axes[d].node_position(node_index[node][d]);
    return x;
  }
  double cell_size_min() const {
    double h = axes[0].h;
    for (const Axis& a : axes) h = std::min(h, a.h);
    return h;
  }
};

/// Local offset (0, 1 or 2 in each direction) of the k-th node of a cell; the last direction runs fastest.
template <int D>
constexpr Index<D> local_offset(int k) {
  Index<D> o{};
  for (int d = D - 1; d >= 0; --d, k /= 3) o[d] = k % 3;
  return o;
}

/// Shape values and gradients of all nodes of a cell at one place.
template <int D>
struct Stencil {
  static constexpr int n = power(3, D);
  std::array<double, n> N;
  std::array<Vec<D>, n> g;
};

template <int D>
Stencil<D> stencil(const std::array<Axis, D>& axes, const Index<D>& cell, const Vec<D>& s) {
  std::array<SplineValues, D> spline;
  for (int d = 0; d < D; ++d) spline[d] = splines(axes[d], cell[d], s[d]);
  Stencil<D> st;
  for (int k = 0; k < Stencil<D>::n; ++k) {
    const Index<D> o = local_offset<D>(k);
    double N = 1.0;
    for (int d = 0; d < D; ++d) N *= spline[d].N[o[d]];
    st.N[k] = N;
    for (int d = 0; d < D; ++d) {
      double g = spline[d].dN[o[d]];
      for (int e = 0; e < D; ++e)
        if (e != d) g *= spline[e].N[o[e]];
      st.g[k][d] = g;
    }
  }
  return st;
}

/// Local coordinates in [0, 1] of the place x in a cell.
template <int D>
Vec<D> local_coordinates(const std::array<Axis, D>& axes, const Index<D>& cell, const Vec<D>& x) {
  Vec<D> s;
  for (int d = 0; d < D; ++d) s[d] = (x[d] - axes[d].origin) / axes[d].h - cell[d];
  return s;
}

/// The place at the local coordinates s of a cell.
template <int D>
Vec<D> position_in_cell(const std::array<Axis, D>& axes, const Index<D>& cell, const Vec<D>& s) {
  Vec<D> x;
  for (int d = 0; d < D; ++d) x[d] = axes[d].origin + (cell[d] + s[d]) * axes[d].h;
  return x;
}

namespace detail {

template <int D>
Index<D> cell_of(const std::array<Axis, D>& axes, const Vec<D>& x) {
  Index<D> c;
  for (int d = 0; d < D; ++d) c[d] = axes[d].cell_of(x[d]);
  return c;
}

/// The first block that something lies in by every direction, in(block, d).
template <int D, class In>
const Block<D>* find_block(const ActiveGrid<D>& grid, In in) {
  for (const Block<D>& b : grid.blocks) {
    int d = 0;
    while (d < D && in(b, d)) ++d;
    if (d == D) return &b;
  }
  return nullptr;
}

template <int D, class Visit>
void for_each_index(const IndexMap<D>& map, Visit visit) {
  Index<D> i = map.low;
  for (std::size_t o = 0; o < map.value.size(); ++o) {
    visit(i, o);
    for (int d = D - 1; d >= 0 && ++i[d] == map.low[d] + map.extent[d]; --d) i[d] = map.low[d];
  }
}

}  // namespace detail

/// Number of cells with points, without sorting them. Positions must be finite.
template <int D>
std::int64_t count_active_cells(const std::array<Axis, D>& axes, const std::vector<Vec<D>>& positions);

/// Finds the active cells and nodes for points at the positions x, and sorts the points by cell. Positions must
/// be finite.
template <int D>
void activate(ActiveGrid<D>& grid, const std::vector<Vec<D>>& x);

/// Nodes behind planes of symmetry take the mirrored values of those before them.
template <int D>
void fill_mirrors(const ActiveGrid<D>& grid, std::vector<Vec<D>>& v) {
  for (const MirrorNode<D>& m : grid.mirrors) v[m.node] = m.sign.cwiseProduct(v[m.of]);
}

/// The adjoint: what they were given is added, mirrored, to those before them. `stride` numbers a node.
template <int D, int stride = D, class Vector>
void fold_mirrors(const ActiveGrid<D>& grid, Vector& R) {
  using Scalar = typename Vector::Scalar;
  for (const MirrorNode<D>& m : grid.mirrors) {
    R.template segment<D>(stride * m.of) +=
        m.sign.template cast<Scalar>().cwiseProduct(R.template segment<D>(stride * m.node));
    R.template segment<D>(stride * m.node).setZero();
  }
}

/// The same for matrices that couple a node with itself.
template <int D>
void fold_mirrors(const ActiveGrid<D>& grid, std::vector<Mat<D, D>>& block) {
  for (const MirrorNode<D>& m : grid.mirrors)
    block[m.of] += m.sign.asDiagonal() * block[m.node] * m.sign.asDiagonal();
}

/// The same for one number a node.
template <int D>
void fold_mirrors(const ActiveGrid<D>& grid, std::vector<double>& share) {
  for (const MirrorNode<D>& m : grid.mirrors) share[m.of] += share[m.node], share[m.node] = 0.0;
}

/// The block that fills a cell, if any.
template <int D>
const Block<D>* block_of_cell(const ActiveGrid<D>& grid, const Index<D>& cell) {
  return detail::find_block(
      grid, [&](const Block<D>& b, int d) { return cell[d] >= b.low[d] && cell[d] < b.high[d]; });
}

/// The block that a node lies in or on, if any.
template <int D>
const Block<D>* block_of_node(const ActiveGrid<D>& grid, const Index<D>& node) {
  return detail::find_block(grid, [&](const Block<D>& b, int d) {
    return node[d] >= grid.axes[d].first_node(b.low[d]) && node[d] <= grid.axes[d].first_node(b.high[d]);
  });
}

/// The sheet that a node lies on, if any. A node on a wall at the sheet's foot lets a third of a cell through: it is open once
/// half of that is, so that a narrow slit above a wall that slides is shut.
template <int D>
const Sheet<D>* sheet_at_node(const ActiveGrid<D>& grid, const Index<D>& node) {
  for (const Sheet<D>& s : grid.sheets) {
    if (node[s.normal] != grid.axes[s.normal].first_node(s.face)) continue;
    const Axis& along = grid.axes[s.along];
    double at = along.node_position(node[s.along]);
    if (along.on_low_wall(node[s.along])) at += along.h / 6.0;
    if (at >= s.from && at < s.to) return &s;
  }
  return nullptr;
}

/// Whether every cell around one is beyond a wall or holds concrete, as holds(neighbour) has it.
template <int D, class Holds>
bool is_surrounded(const std::array<Axis, D>& axes, const Index<D>& cell, Holds holds) {
  for (int k = 0; k < power(3, D); ++k) {
    Index<D> n = local_offset<D>(k);
    bool beyond_wall = false;
    for (int d = 0; d < D; ++d) {
      const Axis& a = axes[d];
      n[d] = a.cell(n[d] + cell[d] - 1);
      beyond_wall = beyond_wall || (a.wall_low() && n[d] < 0) || (a.wall_high() && n[d] >= a.n_cells);
    }
    if (!beyond_wall && !holds(n)) return false;
  }
  return true;
}

/// Whether a cell lies inside the body: every neighbour holds concrete or is beyond a wall.
template <int D>
bool is_inside(const ActiveGrid<D>& grid, const Index<D>& cell) {
  return is_surrounded<D>(grid.axes, cell, [&](const Index<D>& n) {
    return grid.cell_map.at(n) >= 0 || block_of_cell<D>(grid, n) != nullptr;
  });
}

}  // namespace tremie
