#pragma once

// Sums over the 3^D controls of sixteen points in single precision.
//
// A row of four controls is one vector of sixteen, so that a point reads and adds to its 3^(D-1) rows one
// vector each, wherever its stencil begins: points of different cells cost what those of one cell do. Shape
// functions, and what is carried to the rows, are made for the sixteen points at once, one lane a point.

#include "libmpm/transfer/lane_sums.hpp"

namespace tremie {

/// Four controls of a row, from any one on.
inline Singles load_controls(const SingleNode* from) {
  Singles four;
  std::memcpy(&four, from, sizeof four);
  return four;
}
inline void store_controls(const Singles& four, SingleNode* to) { std::memcpy(to, &four, sizeof four); }

/// One entry of four a point, where transpose_blocks brings them.
struct alignas(64) Entries : std::array<SingleNode, singles_size> {};

/// Values, slopes [1/m] and arms times values [m] of sixteen points' three controls in each direction, and
/// where their stencils begin in the tile's cube. Arms are from the middle control, whose own is none; the
/// middle control's is from the point.
template <int D>
struct SingleWeights {
  Singles w[D][3], dw[D][3], wa[D][3];
  Singles middle[D];   ///< arm of the middle control [m]
  Singles inertia[D];  ///< sum of w times the arm from the point squared [m^2]
  std::array<int, singles_size> base;
};

namespace detail {

/// The same control's entries four times; the entries 0 to 3 four times each.
inline Singles four_times(const SingleNode& a) {
#ifdef __AVX512F__  // one load; a shuffle would take an arithmetic unit
  return _mm512_maskz_broadcast_f32x4(0xffff, a);
#else
  const SingleNode four[4] = {a, a, a, a};
  Singles times;
  std::memcpy(&times, four, sizeof times);
  return times;
#endif
}
inline Singles each_four_times(const SingleNode& a) {
#ifdef __AVX512F__
  const Singles b = four_times(a);
  return __builtin_shufflevector(b, b, 0, 0, 0, 0, 5, 5, 5, 5, 10, 10, 10, 10, 15, 15, 15, 15);
#else
  const SingleNode none = {}, four[4] = {none + a[0], none + a[1], none + a[2], none + a[3]};
  Singles times;
  std::memcpy(&times, four, sizeof times);
  return times;
#endif
}

/// Blocks of four and within them: points 4a + b of column c go to entry c of block a of vector b.
inline void transpose_blocks(const Singles (&column)[4], Singles (&row)[4]) {
#ifdef __AVX512F__
  const Singles low_01 =
      __builtin_shufflevector(column[0], column[1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
  const Singles high_01 = __builtin_shufflevector(column[0], column[1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26,
                                                  11, 27, 14, 30, 15, 31);
  const Singles low_23 =
      __builtin_shufflevector(column[2], column[3], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
  const Singles high_23 = __builtin_shufflevector(column[2], column[3], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26,
                                                  11, 27, 14, 30, 15, 31);
  row[0] = __builtin_shufflevector(low_01, low_23, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  row[1] =
      __builtin_shufflevector(low_01, low_23, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
  row[2] =
      __builtin_shufflevector(high_01, high_23, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  row[3] =
      __builtin_shufflevector(high_01, high_23, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
#else  // the compiler takes shuffles that the processor has not lane by lane, and minutes for it
  float from[4][singles_size], to[4][singles_size];
  std::memcpy(from, column, sizeof from);
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t l = 0; l < singles_size; ++l) to[l % 4][l / 4 * 4 + c] = from[c][l];
  std::memcpy(row, to, sizeof to);
#endif
}

/// Where transpose_blocks brings point l, in entries of four.
constexpr std::size_t place_of(std::size_t l) { return l % 4 * 4 + l / 4; }

/// Entry b of each block of four, in all of the block.
inline Singles repeat_in_blocks(const Singles& a, std::size_t b) {
#ifdef __AVX512F__
  switch (b) {
    case 0:
      return __builtin_shufflevector(a, a, 0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12);
    case 1:
      return __builtin_shufflevector(a, a, 1, 1, 1, 1, 5, 5, 5, 5, 9, 9, 9, 9, 13, 13, 13, 13);
    case 2:
      return __builtin_shufflevector(a, a, 2, 2, 2, 2, 6, 6, 6, 6, 10, 10, 10, 10, 14, 14, 14, 14);
    default:
      return __builtin_shufflevector(a, a, 3, 3, 3, 3, 7, 7, 7, 7, 11, 11, 11, 11, 15, 15, 15, 15);
  }
#else
  float from[singles_size], to[singles_size];
  std::memcpy(from, &a, sizeof from);
  for (std::size_t l = 0; l < singles_size; ++l) to[l] = from[l / 4 * 4 + b];
  Singles repeated;
  std::memcpy(&repeated, to, sizeof repeated);
  return repeated;
#endif
}

/// Blocks of four of four vectors, the same ones side by side; the fourth ones are left out.
struct Blocks {
  Singles first, second, third;
};
inline Blocks first_three_blocks(const Singles (&of)[4]) {
#ifdef __AVX512F__
  const Singles low_01 =
      __builtin_shufflevector(of[0], of[1], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
  const Singles low_23 =
      __builtin_shufflevector(of[2], of[3], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
  const Singles high_01 =
      __builtin_shufflevector(of[0], of[1], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  const Singles high_23 =
      __builtin_shufflevector(of[2], of[3], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  return {
      __builtin_shufflevector(low_01, low_23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27),
      __builtin_shufflevector(low_01, low_23, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31),
      __builtin_shufflevector(high_01, high_23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)};
#else
  float from[4][singles_size], to[3][singles_size];
  std::memcpy(from, of, sizeof from);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < singles_size; ++l) to[k][l] = from[l / 4][4 * k + l % 4];
  Blocks blocks;
  std::memcpy(&blocks, to, sizeof blocks);
  return blocks;
#endif
}

/// Three columns of a direction's weights, one entry of four a point: 0 at the fourth control.
inline void to_entries(const Singles (&weight)[3], Entries& entry) {
  const Singles column[4] = {weight[0], weight[1], weight[2], Singles{}};
  transpose_blocks(column, reinterpret_cast<Singles(&)[4]>(*entry.data()));
}

}  // namespace detail

/// Weights of the points at x in a tile, eight and eight, as far as they are wanted: as weigh() of
/// lane_stencils.hpp.
template <int D, Wanted wanted>
void weigh_single(const StencilFrame<D>& frame, const std::array<Octet, D> (&x)[2],
                  SingleWeights<D>& weights) {
  const Singles low = -1 - Singles{}, high = tile_cells - Singles{};
  Singles base = {};
#pragma GCC unroll 3
  for (int d = 0; d < D; ++d) {
    const StencilAxis& axis = frame.axis[d];
    const SingleStencilAxis& single = frame.single[d];
    const auto in_tile = [&](const Octet& place) { return (place - axis.origin) * axis.ih - axis.first; };
    const Singles X = to_single(in_tile(x[0][d]), in_tile(x[1][d]));
    Singles at, arm[3];
    if (frame.kind == ShapeFunctions::gimp) {
      at = min(max(nearest(X), low), high);
      detail::gimp_weights(single, at, X - at, weights.w[d], weights.dw[d], arm);
    } else {
      at = min(max(floor(X), low), high);
      detail::b_spline_weights(single, at, X - at, weights.w[d], weights.dw[d], arm);
    }
    base = base * tile_span + (at + 1);
    if (!wanted.moments) continue;
    const Singles middle = weights.middle[d] = arm[1], low_arm = arm[0] - middle, high_arm = arm[2] - middle;
    const Singles first = weights.wa[d][0] = weights.w[d][0] * low_arm;
    const Singles last = weights.wa[d][2] = weights.w[d][2] * high_arm;
    weights.wa[d][1] = Singles{};
    weights.inertia[d] = first * low_arm + last * high_arm + middle * (middle + 2 * (first + last));
  }
  const auto whole = __builtin_convertvector(base, WholeNumbers);
  std::memcpy(weights.base.data(), &whole, sizeof whole);
}

/// A nodal field at sixteen points: values, and slopes or moments in each direction. Entry 3 of four is not
/// read.
template <int D>
struct SingleFields {
  Singles value[3], along[D][3];
};

namespace detail {

/// Sums over the rows of point l: sum[0] with the weights of all directions but the last, sum[1 + d] with
/// `side` in place of the weights of direction d; `ends`: it has none at the middle control.
template <int D, bool ends>
[[gnu::always_inline]] inline void sum_rows(const SingleNode* node, const SingleWeights<D>& p,
                                            const Singles (&side)[D][3], std::size_t l, Singles (&sum)[D]) {
  for (Singles& s : sum) s = Singles{};
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    Singles row, turned = {};
    const SingleNode* at = node + i * stride<D>(tile_span, 0);
    if constexpr (D == 2) {
      row = load_controls(at);
    } else {
      row = Singles{};
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        const Singles four = load_controls(at + j * tile_span);
        row += p.w[1][j][l] * four;
        if (!ends || j != 1) turned += side[1][j][l] * four;
      }
      sum[2] += p.w[0][i][l] * turned;
    }
    sum[0] += p.w[0][i][l] * row;
    if (!ends || i != 1) sum[1] += side[0][i][l] * row;
  }
}

}  // namespace detail

/// Values at the first n of sixteen points, and what `side` in place of a direction's weights gives: slopes
/// with dw, moments with wa. The others get what the rows of the first point of their eight are with weights
/// of their own: the same as it, where they stand. Values may be left out.
template <int D, bool values, bool ends>
[[gnu::noinline]] void sum_controls(const SingleNode* v, const SingleWeights<D>& p,
                                    const Singles (&side)[D][3], std::size_t n, SingleFields<D>& fields) {
  Singles entry[D + 1][4];  // of points 4a + b in block a of vector b
  Singles of_first[2][D] = {};
  for (std::size_t b = 0; b < 4; ++b) {
    Singles rows[D][4];
    for (std::size_t a = 0, l = b; a < 4; ++a, l += 4) {
      Singles sum[D];
      if (l < n) detail::sum_rows<D, ends>(v + p.base[l], p, side, l, sum);
      const std::size_t eight = n > octet_size ? l / octet_size : 0;
      for (int q = 0; q < D; ++q) rows[q][a] = l < n ? sum[q] : of_first[eight][q];
      if (l % octet_size == 0 && l < n) std::copy_n(sum, D, of_first[eight]);
    }
    Singles w[3], turned[3];
    for (int k = 0; k < 3; ++k) {
      w[k] = detail::repeat_in_blocks(p.w[D - 1][k], b);
      turned[k] = detail::repeat_in_blocks(side[D - 1][k], b);
    }
    for (int q = 0; q < D; ++q) {
      const auto [first, middle, last] = detail::first_three_blocks(rows[q]);
      if (q == 0)
        entry[D][b] = ends ? turned[0] * first + turned[2] * last
                           : turned[0] * first + turned[1] * middle + turned[2] * last;
      if (q > 0 || values) entry[q][b] = w[0] * first + w[1] * middle + w[2] * last;
    }
  }
  for (int q = values ? 0 : 1; q <= D; ++q) {
    Singles column[4];
    detail::transpose_blocks(entry[q], column);
    for (int c = 0; c < 3; ++c) (q == 0 ? fields.value : fields.along[q - 1])[c] = column[c];
  }
}

/// Slopes at the first n of sixteen points, and values if they are wanted.
template <int D, bool values>
void gather_slopes(const SingleNode* v, const SingleWeights<D>& p, std::size_t n, SingleFields<D>& fields) {
  sum_controls<D, values, false>(v, p, p.dw, n, fields);
}

/// Values and moments about the points.
template <int D>
void gather_moments(const SingleNode* v, const SingleWeights<D>& p, std::size_t n, SingleFields<D>& fields) {
  sum_controls<D, true, true>(v, p, p.wa, n, fields);
  for (int d = 0; d < D; ++d)
    for (int c = 0; c < D; ++c) fields.along[d][c] += p.middle[d] * fields.value[c];
}

/// What sixteen points add to their controls, as Spread of lane_sums.hpp; moments about the middle control.
template <int D>
struct SingleSpread {
  Singles value[4], slope[D][D], moment[D][D];
};

namespace detail {

/// What sixteen points bring to the last direction, one entry of four a point.
template <int D>
struct SingleRows {
  Singles weight[power(3, D - 1)];
  Entries value[power(3, D - 1)], slope, moment, w, dw, wa;
};

/// slope[d] times the gradient plus moment[d] times the arm from the middle, at the controls k of direction
/// d.
template <int D, Given given>
[[gnu::always_inline]] inline void add_along(const SingleWeights<D>& p, const SingleSpread<D>& spread, int d,
                                             int k, const Singles* weight, Singles (&to)[4]) {
  if (k == 1 && !given.slopes) return;
  for (int c = 0; c < D; ++c) {
    Singles along = {};
    if constexpr (given.slopes) along = p.dw[d][k] * spread.slope[d][c];
    if constexpr (given.moments) along += p.wa[d][k] * spread.moment[d][c];
    to[c] += weight ? *weight * along : along;
  }
}

template <int D, Given given>
void carry_to_rows(const SingleWeights<D>& p, const SingleSpread<D>& spread, SingleRows<D>& rows) {
  const auto store = [](const Singles(&column)[4], Entries& entry) {
    transpose_blocks(column, reinterpret_cast<Singles(&)[4]>(*entry.data()));
  };
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    Singles first[4] = {};
    for (int c = 0; c < 4 && given.values; ++c) first[c] = p.w[0][i] * spread.value[c];
    add_along<D, given>(p, spread, 0, i, nullptr, first);
    if constexpr (D == 2) {
      rows.weight[i] = p.w[0][i];
      store(first, rows.value[i]);
    } else {
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        Singles second[4];
        for (int c = 0; c < 4; ++c) second[c] = p.w[1][j] * first[c];
        add_along<D, given>(p, spread, 1, j, &p.w[0][i], second);
        rows.weight[3 * i + j] = p.w[0][i] * p.w[1][j];
        store(second, rows.value[3 * i + j]);
      }
    }
  }
  const auto last = [&](const Singles(&of)[D], Entries& entry) {
    Singles column[4] = {};
    for (int c = 0; c < D; ++c) column[c] = of[c];
    store(column, entry);
  };
  to_entries(p.w[D - 1], rows.w);
  if constexpr (given.slopes) last(spread.slope[D - 1], rows.slope), to_entries(p.dw[D - 1], rows.dw);
  if constexpr (given.moments) last(spread.moment[D - 1], rows.moment), to_entries(p.wa[D - 1], rows.wa);
}

/// Adds points first ... last - 1, whose stencils all begin at the same control: the sums stay in registers.
template <int D, Given given>
[[gnu::always_inline]] inline void add_run(const SingleRows<D>& rows, std::size_t first, std::size_t last,
                                           SingleNode* node) {
  constexpr int n = power(3, D - 1);
  Singles sum[n];
#pragma GCC unroll 9
  for (int r = 0; r < n; ++r) sum[r] = load_controls(node + row_offset<D>(r));
  for (std::size_t l = first; l < last; ++l) {
    const std::size_t at = place_of(l);
    const Singles w = each_four_times(rows.w[at]);
    Singles along = {};
    if constexpr (given.slopes) along = each_four_times(rows.dw[at]) * four_times(rows.slope[at]);
    if constexpr (given.moments) along += each_four_times(rows.wa[at]) * four_times(rows.moment[at]);
#pragma GCC unroll 9
    for (int r = 0; r < n; ++r)
      sum[r] = sum[r] + w * four_times(rows.value[r][at]) + rows.weight[r][l] * along;
  }
#pragma GCC unroll 9
  for (int r = 0; r < n; ++r) store_controls(sum[r], node + row_offset<D>(r));
}

}  // namespace detail

/// Rows that points add to, and how many runs of points with the same stencil they are.
struct Reached {
  TileRows rows = 0;
  int runs = 0;
};

/// Adds what the first n of sixteen points spread to their controls in the tile's cube. The control behind a
/// stencil's row is added nothing.
template <int D, Given given>
[[gnu::noipa]] Reached scatter_single(const SingleWeights<D>& p, const SingleSpread<D>& spread, std::size_t n,
                                      SingleNode* sums) {
  detail::SingleRows<D> rows;
  detail::carry_to_rows<D, given>(p, spread, rows);
  Reached reached;
  for (std::size_t first = 0, last; first < n; first = last) {
    for (last = first + 1; last < n && p.base[last] == p.base[first];) ++last;
    detail::add_run<D, given>(rows, first, last, sums + p.base[first]);
    reached.rows |= stencil_rows<D>(p.base[first]);
    ++reached.runs;
  }
  return reached;
}

}  // namespace tremie
