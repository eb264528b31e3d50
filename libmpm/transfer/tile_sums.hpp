#pragma once

// Grid to points and points to grid over the 3^D nodes of a stencil.
//
// A row of four nodes is one vector, so that a point reads and adds to its 3^(D-1) rows one vector each,
// wherever its stencil begins: points of different cells cost what those of one cell do. Each direction is
// factored out in turn. What a sum has beside the values goes with weights a in place of w in one direction
// at a time: the slopes of the weights (gradients and what stresses push with), their arms from the point
// (moments, and momenta of affine velocities), or first the ones and then the others: N sets of them.

#include "libmpm/transfer/shape_functions.hpp"
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace tremie {

/// Weights of one point: of the directions across the rows, and along them.
template <class Real, int D, int N>
struct PointWeights {
  Real w[D - 1][3], a[N][D - 1][3];
  NodeOf<Real> w_row, a_row[N];  ///< entry k: of a row's k-th node; the last is 0
};

/// A nodal vector field at one point, or what a point gives its nodes: values, and what goes with a in each
/// direction.
template <class Real, int D, int N>
struct AtPoint {
  NodeOf<Real> value, along[N][D];
};

namespace detail {

/// The same node four times, and each of its entries four times; the compiler would go through memory.
[[gnu::always_inline]] inline f32x16 repeat(const f32x4& a) {
#ifdef __AVX512F__
  return _mm512_maskz_broadcast_f32x4(0xffff, a);
#else
  const f32x4 four[4] = {a, a, a, a};
  return load_row<float>(four);
#endif
}
[[gnu::always_inline]] inline f32x16 repeat_each(const f32x4& a) {
#ifdef __AVX512F__
  return _mm512_maskz_permutevar_ps(0xffff, repeat(a),
                                    _mm512_set_epi32(3, 3, 3, 3, 2, 2, 2, 2, 1, 1, 1, 1, 0, 0, 0, 0));
#else
  const f32x4 none = {}, four[4] = {none + a[0], none + a[1], none + a[2], none + a[3]};
  return load_row<float>(four);
#endif
}
[[gnu::always_inline]] inline f64x16 repeat(const f64x4& a) {
  const f64x8 two = __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3);
  return {two, two};
}
[[gnu::always_inline]] inline f64x16 repeat_each(const f64x4& a) {
  return {__builtin_shufflevector(a, a, 0, 0, 0, 0, 1, 1, 1, 1),
          __builtin_shufflevector(a, a, 2, 2, 2, 2, 3, 3, 3, 3)};
}

/// Sum of the first three nodes.
template <class Real>
[[gnu::always_inline]] inline NodeOf<Real> sum_of_row(const RowOf<Real>& row) {
  NodeOf<Real> node[4];
  store_row<Real>(row, node);
  return node[0] + node[1] + node[2];
}

}  // namespace detail

/// A nodal field at a point whose stencil begins at `node`. The weights w of a direction add up to 1 and the a to 0: the
/// differences of the outer nodes from the middle one are all that they see.
template <int D, int N, class Real>
[[gnu::always_inline]] inline AtPoint<Real, D, N> gather(const NodeOf<Real>* node,
                                                         const PointWeights<Real, D, N>& p) {
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
    const NodeOf<Real>* line = node + i * stride<D>(tile_span, 0);
    if constexpr (D == 2) {
      sum[i] = load_row<Real>(line);
    } else {
      Row row[3] = {load_row<Real>(line), load_row<Real>(line + tile_span),
                    load_row<Real>(line + 2 * tile_span)};
      to_differences(row);
      sum[i] = with_w(1, row);
      for (int n = 0; n < N; ++n) turned[n][i] = with_a(n, 1, row);
    }
  }
  to_differences(sum);
  const Row w = detail::repeat_each(p.w_row), value = with_w(0, sum);
  AtPoint<Real, D, N> at;
  at.value = detail::sum_of_row<Real>(w * value);
  for (int n = 0; n < N; ++n) {
    at.along[n][0] = detail::sum_of_row<Real>(w * with_a(n, 0, sum));
    if constexpr (D == 3) {
      to_differences(turned[n]);
      at.along[n][1] = detail::sum_of_row<Real>(w * with_w(0, turned[n]));
    }
    at.along[n][D - 1] = detail::sum_of_row<Real>(detail::repeat_each(p.a_row[n]) * value);
  }
  return at;
}

/// The adjoint of gather(), added to the rows of a stencil.
template <int D, int N, class Real>
[[gnu::always_inline]] inline void scatter(const PointWeights<Real, D, N>& p, const AtPoint<Real, D, N>& of,
                                           RowOf<Real> (&rows)[power(3, D - 1)]) {
  using Row = RowOf<Real>;
  const Row w = detail::repeat_each(p.w_row);
  Row value = w * detail::repeat(of.value), first[3] = {}, second[3] = {};
  for (int n = 0; n < N; ++n) {
    value = value + detail::repeat_each(p.a_row[n]) * detail::repeat(of.along[n][D - 1]);
    const Row along_0 = w * detail::repeat(of.along[n][0]), along_1 = w * detail::repeat(of.along[n][1]);
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      first[k] = first[k] + p.a[n][0][k] * along_0;
      if constexpr (D == 3) second[k] = second[k] + p.a[n][1][k] * along_1;
    }
  }
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const Row sum = first[i] + p.w[0][i] * value;
    if constexpr (D == 2) {
      rows[i] = rows[i] + sum;
    } else {
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) rows[3 * i + j] = rows[3 * i + j] + p.w[1][j] * sum + p.w[0][i] * second[j];
    }
  }
}

/// Adds rows to the stencil that begins at `node`, and clears them.
template <int D, class Real>
[[gnu::always_inline]] inline void add_rows(RowOf<Real> (&rows)[power(3, D - 1)], NodeOf<Real>* node) {
  for (int r = 0; r < power(3, D - 1); ++r) {
    NodeOf<Real>* to = node + (D == 2 ? r * tile_span : (r / 3 * tile_span + r % 3) * tile_span);
    store_row<Real>(load_row<Real>(to) + rows[r], to);
    rows[r] = RowOf<Real>{};
  }
}

/// The same at eight points, one lane a point; entry 3 of along is not used.
template <class Real, int D, int N>
struct AtPoints {
  SimdOf<Real> value[4] = {}, along[N][D][4] = {};
};

/// The weights a of eight points, N sets.
template <class Real, int N>
using OtherWeights = std::array<const SimdOf<Real> (*)[3], N>;

namespace detail {

/// Nodes, one a point, to one vector a component, and back.
template <class Real>
[[gnu::always_inline]] inline void to_lanes(const NodeOf<Real> (&node)[f64x8_size],
                                            SimdOf<Real> (&lanes)[4]) {
  using V = SimdOf<Real>;
  V even[2], odd[2];  // components 0 and 2, 1 and 3 of points 0-3 and 4-7
  for (int i = 0; i < 2; ++i) {
    const V a = __builtin_shufflevector(node[4 * i], node[4 * i + 2], 0, 1, 2, 3, 4, 5, 6, 7),
            b = __builtin_shufflevector(node[4 * i + 1], node[4 * i + 3], 0, 1, 2, 3, 4, 5, 6, 7);
    even[i] = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    odd[i] = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  lanes[0] = __builtin_shufflevector(even[0], even[1], 0, 1, 4, 5, 8, 9, 12, 13);
  lanes[1] = __builtin_shufflevector(odd[0], odd[1], 0, 1, 4, 5, 8, 9, 12, 13);
  lanes[2] = __builtin_shufflevector(even[0], even[1], 2, 3, 6, 7, 10, 11, 14, 15);
  lanes[3] = __builtin_shufflevector(odd[0], odd[1], 2, 3, 6, 7, 10, 11, 14, 15);
}
template <class Real>
[[gnu::always_inline]] inline void to_nodes(const SimdOf<Real> (&lanes)[4],
                                            NodeOf<Real> (&node)[f64x8_size]) {
  using V = SimdOf<Real>;
  const V even_low = __builtin_shufflevector(lanes[0], lanes[1], 0, 8, 2, 10, 4, 12, 6, 14),
          even_high = __builtin_shufflevector(lanes[2], lanes[3], 0, 8, 2, 10, 4, 12, 6, 14),
          odd_low = __builtin_shufflevector(lanes[0], lanes[1], 1, 9, 3, 11, 5, 13, 7, 15),
          odd_high = __builtin_shufflevector(lanes[2], lanes[3], 1, 9, 3, 11, 5, 13, 7, 15);
  const V two[4] = {__builtin_shufflevector(even_low, even_high, 0, 1, 8, 9, 2, 3, 10, 11),
                    __builtin_shufflevector(odd_low, odd_high, 0, 1, 8, 9, 2, 3, 10, 11),
                    __builtin_shufflevector(even_low, even_high, 4, 5, 12, 13, 6, 7, 14, 15),
                    __builtin_shufflevector(odd_low, odd_high, 4, 5, 12, 13, 6, 7, 14, 15)};
  for (int i = 0; i < 4; ++i) {  // points l and l + 2
    NodeOf<Real> both[2];
    std::memcpy(both, &two[i], sizeof both);
    const int l = i / 2 * 4 + i % 2;
    node[l] = both[0], node[l + 2] = both[1];
  }
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
    PointWeights<Real, D, N> one;
    one.w_row = w_row[l];
    for (int d = 0; d < D - 1; ++d)
      for (int k = 0; k < 3; ++k) one.w[d][k] = weights.w[d][k][l];
    for (int n = 0; n < N; ++n) {
      one.a_row[n] = a_row[n][l];
      for (int d = 0; d < D - 1; ++d)
        for (int k = 0; k < 3; ++k) one.a[n][d][k] = a[n][d][k][l];
    }
    return one;
  }
};

}  // namespace detail

/// Grid to eight points.
template <class Real, int D, int N>
[[gnu::noinline]] void gather(const NodeCube<Real, D>& v, const Weights<Real, D>& weights,
                              const OtherWeights<Real, N>& a, AtPoints<Real, D, N>& points) {
  const detail::WeightsOfLanes<Real, D, N> of(weights, a);
  NodeOf<Real> value[f64x8_size], along[N][D][f64x8_size];
  for (int l = 0; l < f64x8_size; ++l) {
    const auto base = static_cast<std::size_t>(weights.base[static_cast<std::size_t>(l)]);
    const auto at = gather<D, N, Real>(&v[base], of[l]);
    value[l] = at.value;
    for (int n = 0; n < N; ++n)
      for (int d = 0; d < D; ++d) along[n][d][l] = at.along[n][d];
  }
  detail::to_lanes<Real>(value, points.value);
  for (int n = 0; n < N; ++n)
    for (int d = 0; d < D; ++d) detail::to_lanes<Real>(along[n][d], points.along[n][d]);
}

/// The first n of eight points to the grid. The rows of a stencil are summed up while points of the same follow. noipa:
/// g++ 12 sees a loop that writes to no memory, and drops the call.
template <class Real, int D, int N>
[[gnu::noipa]] void scatter(const Weights<Real, D>& weights, const OtherWeights<Real, N>& a,
                            const AtPoints<Real, D, N>& points, int n, NodeCube<Real, D>& sums) {
  const detail::WeightsOfLanes<Real, D, N> of(weights, a);
  NodeOf<Real> value[f64x8_size], along[N][D][f64x8_size];
  detail::to_nodes<Real>(points.value, value);
  for (int s = 0; s < N; ++s)
    for (int d = 0; d < D; ++d) detail::to_nodes<Real>(points.along[s][d], along[s][d]);
  RowOf<Real> rows[power(3, D - 1)] = {};
  for (int l = 0; l < n;) {
    const int base = weights.base[static_cast<std::size_t>(l)];
    do {
      AtPoint<Real, D, N> one;
      one.value = value[l];
      for (int s = 0; s < N; ++s)
        for (int d = 0; d < D; ++d) one.along[s][d] = along[s][d][l];
      scatter<D, N, Real>(of[l], one, rows);
    } while (++l < n && weights.base[static_cast<std::size_t>(l)] == base);
    add_rows<D, Real>(rows, &sums[static_cast<std::size_t>(base)]);
  }
}

}  // namespace tremie
