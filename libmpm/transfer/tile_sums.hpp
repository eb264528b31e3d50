#pragma once

// Grid to points and points to grid over the 3^D nodes of a stencil.
//
// A row of four nodes is one vector, so that a point reads and adds to its 3^(D-1) rows one vector each,
// wherever its stencil begins: points of different cells cost what those of one cell do. Each direction is
// factored out in turn. What a sum has beside the values goes with weights a in place of w in one direction
// at a time: the slopes of the weights (gradients and what stresses push with), their arms from the point
// (moments, and momenta of affine velocities), or first the ones and then the others: N sets of them.

#include "libmpm/transfer/shape_functions.hpp"

namespace tremie {

/// Weights of one point: of the directions across the rows, and along them.
template <class Real, int D, int N>
struct PointWeights {
  Real w[D - 1][3], a[N][D - 1][3];
  NodeOf<Real> w_row, a_row[N];  ///< entry k: of a row's k-th node; the last is 0
};

/// What a point gives its nodes: values, and what goes with a in each direction.
template <class Real, int D, int N>
struct AtPoint {
  NodeOf<Real> value, along[N][D];
};

/// Distance of row r of a stencil from its first node in a tile's cube.
template <int D>
constexpr int row_offset(int r) {
  return D == 2 ? r * tile_span : (r / 3 * tile_span + r % 3) * tile_span;
}

namespace detail {

/// The same node in all places of a row.
template <class Row, class Node>
[[gnu::always_inline]] inline Row repeat(const Node& a) {
  if constexpr (std::is_same_v<Row, Node>) {
    return a;
  } else {
    const auto half = repeat<Simd<ScalarOf<Row>, size_of<Row> / 2>>(a);
    return join(half, half);
  }
}
/// Four times each entry of a node, from entry `first` on.
template <class Row, int first = 0, class Node>
[[gnu::always_inline]] inline Row repeat_each(const Node& a) {
  if constexpr (!std::is_same_v<Row, Node>) {
    using Half = Simd<ScalarOf<Row>, size_of<Row> / 2>;
    return join(repeat_each<Half, first>(a), repeat_each<Half, first + size_of<Half> / 4>(a));
  } else if constexpr (is_pair<Node>) {
    const auto half = half_of<first / 2 != 0>(a),
               both = __builtin_shufflevector(half, half, first % 2, first % 2);
    return {both, both};
  } else {
    return __builtin_shufflevector(a, a, first, first, first, first);
  }
}

/// Sum of the first three nodes.
template <class Real>
[[gnu::always_inline]] inline NodeOf<Real> sum_of_row(const RowOf<Real>& row) {
  NodeOf<Real> node[4];
  store_row<Real>(row, node);
  return node[0] + node[1] + node[2];
}

}  // namespace detail

/// The rows of one stencil: in space, those that differ in the second direction alone by the differences of the outer
/// ones from the middle one.
template <class Real, int D>
struct StencilRows {
  RowOf<Real> at[3][D == 2 ? 1 : 3];

  [[gnu::always_inline]] void load(const NodeOf<Real>* node) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const NodeOf<Real>* line = node + i * stride<D>(tile_span, 0);
      at[i][0] = load_row<Real>(line);
      if constexpr (D == 3) {
        at[i][1] = load_row<Real>(line + tile_span);
        at[i][0] = at[i][0] - at[i][1];
        at[i][2] = load_row<Real>(line + 2 * tile_span) - at[i][1];
      }
    }
  }
};

/// What the rows of points are once the other directions are summed up: with their weights, and for each n with a[n] in
/// place of w in each of them.
template <class Real, int D, int N>
struct alignas(64) GatheredRows {
  NodeOf<Real> row[1 + N * (D - 1)][f64x8_size][4];
};

/// Those of point l, with this stencil. The weights w of a direction add up to 1 and the a to 0: the differences of the
/// outer nodes from the middle one are all that they see.
template <int D, int N, class Real>
[[gnu::always_inline]] inline void gather_rows(const StencilRows<Real, D>& rows,
                                               const PointWeights<Real, D, N>& p, int l,
                                               GatheredRows<Real, D, N>& to) {
  using Row = RowOf<Real>;
  const auto with_w = [&p](int d, const Row(&of)[3]) {
    return of[1] + p.w[d][0] * of[0] + p.w[d][2] * of[2];
  };
  const auto with_a = [&p](int n, int d, const Row(&of)[3]) {
    return p.a[n][d][0] * of[0] + p.a[n][d][2] * of[2];
  };
  const auto to_differences = [](Row(&of)[3]) { of[0] = of[0] - of[1], of[2] = of[2] - of[1]; };
  Row sum[3], turned[N][3];
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    if constexpr (D == 2) {
      sum[i] = rows.at[i][0];
    } else {
      sum[i] = with_w(1, rows.at[i]);
      for (int n = 0; n < N; ++n) turned[n][i] = with_a(n, 1, rows.at[i]);
    }
  }
  to_differences(sum);
  store_row<Real>(with_w(0, sum), to.row[0][l]);
  for (int n = 0; n < N; ++n) {
    store_row<Real>(with_a(n, 0, sum), to.row[1 + n * (D - 1)][l]);
    if constexpr (D == 3) {
      to_differences(turned[n]);
      store_row<Real>(with_w(0, turned[n]), to.row[2 + 2 * n][l]);
    }
  }
}

/// What a point gives, added to the rows of its stencil. `outer`: a middle row stands for the sum of the three, which
/// needs no weights, until add_rows() leaves it what the outer ones do not have.
template <int D, int N, bool outer, class Real>
[[gnu::always_inline]] inline void scatter(const PointWeights<Real, D, N>& p, const AtPoint<Real, D, N>& of,
                                           RowOf<Real> (&rows)[power(3, D - 1)]) {
  using Row = RowOf<Real>;
  const Row w = detail::repeat_each<Row>(p.w_row);
  Row value = w * detail::repeat<Row>(of.value), first[3] = {}, second[3] = {};
  for (int n = 0; n < N; ++n) {
    value = value + detail::repeat_each<Row>(p.a_row[n]) * detail::repeat<Row>(of.along[n][D - 1]);
    const Row along_0 = w * detail::repeat<Row>(of.along[n][0]),
              along_1 = w * detail::repeat<Row>(of.along[n][1]);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k += outer ? 2 : 1) {
      first[k] = n == 0 ? p.a[n][0][k] * along_0 : first[k] + p.a[n][0][k] * along_0;
      if constexpr (D == 3) second[k] = n == 0 ? p.a[n][1][k] * along_1 : second[k] + p.a[n][1][k] * along_1;
    }
  }
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const bool all_i = outer && i == 1;
    const Row sum = all_i ? value : first[i] + p.w[0][i] * value;
    if constexpr (D == 2) {
      rows[i] = rows[i] + sum;
    } else {
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        Row& row = rows[3 * i + j];
        if (outer && j == 1)
          row = row + sum;
        else
          row = row + p.w[1][j] * sum + (all_i ? second[j] : p.w[0][i] * second[j]);
      }
    }
  }
}

/// Adds rows to the stencil that begins at `node`, and clears them.
template <int D, bool outer, class Real>
[[gnu::always_inline]] inline void add_rows(RowOf<Real> (&rows)[power(3, D - 1)], NodeOf<Real>* node) {
  if constexpr (outer) {
    for (int i = 0; i < 3 && D == 3; ++i) rows[3 * i + 1] = rows[3 * i + 1] - (rows[3 * i] + rows[3 * i + 2]);
    constexpr int n = power(3, D - 2);
    for (int j = 0; j < n; ++j) rows[n + j] = rows[n + j] - (rows[j] + rows[2 * n + j]);
  }
  for (int r = 0; r < power(3, D - 1); ++r) {
    NodeOf<Real>* to = node + row_offset<D>(r);
    store_row<Real>(load_row<Real>(to) + rows[r], to);
    rows[r] = RowOf<Real>{};
  }
}

/// A nodal vector field at eight points, or what they give their nodes, one lane a point; entry 3 of along is not used.
template <class Real, int D, int N>
struct AtPoints {
  SimdOf<Real> value[4], along[N][D][4];
};

/// The weights a of eight points, N sets.
template <class Real, int N>
using OtherWeights = std::array<const SimdOf<Real> (*)[3], N>;

namespace detail {

/// The k-th nodes of rows, one a point, to one vector a component, and back.
template <class Real>
[[gnu::always_inline]] inline void to_lanes(const NodeOf<Real> (&node)[f64x8_size][4], int k,
                                            SimdOf<Real> (&lanes)[4]) {
  for (int i = 0; i < 4; ++i) lanes[i] = join(node[i][k], node[4 + i][k]);
  transpose(lanes);
}
template <class Real>
[[gnu::always_inline]] inline void to_nodes(const SimdOf<Real> (&lanes)[4],
                                            NodeOf<Real> (&node)[f64x8_size]) {
  SimdOf<Real> four[4] = {lanes[0], lanes[1], lanes[2], lanes[3]};
  transpose(four);
  for (int i = 0; i < 4; ++i) node[i] = half_of<false>(four[i]), node[4 + i] = half_of<true>(four[i]);
}

/// Weights of eight points one by one.
template <class Real, int D, int N>
struct WeightsOfLanes {
  const Weights<Real, D>& weights;
  const OtherWeights<Real, N>& a;
  NodeOf<Real> w_row[f64x8_size], a_row[N][f64x8_size];

  WeightsOfLanes(const Weights<Real, D>& of, const OtherWeights<Real, N>& other) : weights(of), a(other) {
    const auto row_of = [](const SimdOf<Real>(&w)[3], NodeOf<Real>(&row)[f64x8_size]) {
      const SimdOf<Real> three[4] = {w[0], w[1], w[2], {}};
      to_nodes<Real>(three, row);
    };
    row_of(of.w[D - 1], w_row);
    for (int n = 0; n < N; ++n) row_of(a[n][D - 1], a_row[n]);
  }
  [[gnu::always_inline]] PointWeights<Real, D, N> operator[](int l) const {
    PointWeights<Real, D, N> lane;
    lane.w_row = w_row[l];
    for (int n = 0; n < N; ++n) lane.a_row[n] = a_row[n][l];
    for (int d = 0; d < D - 1; ++d)
      for (int k = 0; k < 3; ++k) {
        lane.w[d][k] = weights.w[d][k][l];
        for (int n = 0; n < N; ++n) lane.a[n][d][k] = a[n][d][k][l];
      }
    return lane;
  }
};

/// The nodes of eight points' rows side by side: the middle one, and the differences of the others from it.
template <class Real>
[[gnu::always_inline]] inline void to_differences(const NodeOf<Real> (&row)[f64x8_size][4],
                                                  SimdOf<Real> (&node)[3][4]) {
  for (int k = 0; k < 3; ++k) to_lanes<Real>(row, k, node[k]);
  for (int c = 0; c < 4; ++c) node[0][c] -= node[1][c], node[2][c] -= node[1][c];
}

}  // namespace detail

/// Grid to eight points.
template <class Real, int D, int N>
[[gnu::noinline]] void gather(const NodeCube<Real, D>& v, const Weights<Real, D>& weights,
                              const OtherWeights<Real, N>& a, AtPoints<Real, D, N>& points) {
  const detail::WeightsOfLanes<Real, D, N> lanes(weights, a);
  GatheredRows<Real, D, N> of;
  StencilRows<Real, D> rows;
  for (int l = 0, loaded = -1; l < f64x8_size; ++l) {
    const int base = weights.base[l];
    if (base != loaded) rows.load(&v[loaded = base]);
    gather_rows<D, N, Real>(rows, lanes[l], l, of);
  }
  const auto& w = weights.w[D - 1];
  SimdOf<Real> node[3][4];
  const auto with_w = [&](int c) { return node[1][c] + w[0] * node[0][c] + w[2] * node[2][c]; };
  detail::to_differences<Real>(of.row[0], node);
  for (int c = 0; c < 4; ++c) {
    points.value[c] = with_w(c);
    for (int n = 0; n < N; ++n)
      points.along[n][D - 1][c] = a[n][D - 1][0] * node[0][c] + a[n][D - 1][2] * node[2][c];
  }
  for (int n = 0; n < N; ++n)
    for (int d = 0; d < D - 1; ++d) {
      detail::to_differences<Real>(of.row[1 + n * (D - 1) + d], node);
      for (int c = 0; c < 4; ++c) points.along[n][d][c] = with_w(c);
    }
}

/// The first n of eight points to the grid, `outer` as above. The rows of a stencil are summed up while points of the
/// same follow. noipa: g++ 12 sees a loop that writes to no memory, and drops the call.
template <class Real, int D, int N, bool outer>
[[gnu::noipa]] void scatter_runs(const Weights<Real, D>& weights, const OtherWeights<Real, N>& a,
                                 const AtPoints<Real, D, N>& points, int n, NodeCube<Real, D>& sums) {
  const detail::WeightsOfLanes<Real, D, N> of(weights, a);
  NodeOf<Real> value[f64x8_size], along[N][D][f64x8_size];
  detail::to_nodes<Real>(points.value, value);
  for (int s = 0; s < N; ++s)
    for (int d = 0; d < D; ++d) detail::to_nodes<Real>(points.along[s][d], along[s][d]);
  RowOf<Real> rows[power(3, D - 1)] = {};
  for (int l = 0; l < n;) {
    const int base = weights.base[l];
    do {
      AtPoint<Real, D, N> point;
      point.value = value[l];
      for (int s = 0; s < N; ++s)
        for (int d = 0; d < D; ++d) point.along[s][d] = along[s][d][l];
      scatter<D, N, outer, Real>(of[l], point, rows);
    } while (++l < n && weights.base[l] == base);
    add_rows<D, outer, Real>(rows, &sums[base]);
  }
}

/// What a middle node is left must not be the rounding of the others: in single precision splines next to a wall, where it
/// may have next to no weight, go node by node.
template <class Real, int D, int N>
void scatter(const Weights<Real, D>& weights, const OtherWeights<Real, N>& a,
             const AtPoints<Real, D, N>& points, int n, NodeCube<Real, D>& sums) {
  if (std::is_same_v<Real, double> || weights.middle_counts)
    scatter_runs<Real, D, N, true>(weights, a, points, n, sums);
  else
    scatter_runs<Real, D, N, false>(weights, a, points, n, sums);
}

}  // namespace tremie
