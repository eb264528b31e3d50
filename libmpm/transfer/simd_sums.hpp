#pragma once

// Sums over the 3^D nodes of eight points at once.
//
// Points whose stencils begin at the same place are gathered side by side: one lane a point, a node's
// value read once for all. Sums to the grid go point by point, two neighbouring nodes in one vector of
// eight.

#include "libmpm/transfer/simd_stencils.hpp"
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace tremie {

namespace detail {

/// Three numbers by their differences from the middle one, which are all that weights see whose sum is known.
template <class Lanes>
struct Differences {
  Lanes down, middle, up;
};
template <class Lanes>
[[gnu::always_inline]] inline Differences<Lanes> differences(const Lanes& first, const Lanes& middle,
                                                             const Lanes& last) {
  return {first - middle, middle, last - middle};
}
/// Sums with weights that add up to 1, and to 0; `first` and `last`: those of the outer two.
template <class Weight, class Lanes>
[[gnu::always_inline]] inline Lanes sum_to_one(const Weight& first, const Weight& last,
                                               const Differences<Lanes>& of) {
  return of.middle + first * of.down + last * of.up;
}
template <class Weight, class Lanes>
[[gnu::always_inline]] inline Lanes sum_to_none(const Weight& first, const Weight& last,
                                                const Differences<Lanes>& of) {
  return first * of.down + last * of.up;
}

}  // namespace detail

/// One component of a nodal field at eight points: value, slopes and first moments in the directions from d
/// on.
template <int R, Wanted wanted>
struct GatheredLanes {
  f64x8 value;
  f64x8 slope[wanted.slopes && R > 0 ? R : 1];
  f64x8 moment[wanted.moments && R > 0 ? R : 1];
};

/// Component c at eight points whose stencils all begin at `node`; otherwise as gather() for one point. The
/// weights of a direction add up to 1, and their slopes and first moments to 0: the differences of the outer
/// nodes from the middle one are all that they see.
template <int D, Wanted wanted, int d = 0>
[[gnu::always_inline]] inline GatheredLanes<D - d, wanted> gather_together(const f64x4* node, int c,
                                                                           const Weights<D>& p) {
  GatheredLanes<D - d, wanted> sum;
  if constexpr (d == D) {
    sum.value = all_lanes((*node)[c]);
  } else {
    constexpr int rest = D - d - 1;
    const auto part = [&](int k) {
      return gather_together<D, wanted, d + 1>(node + k * stride<D>(tile_span, d), c, p);
    };
    const auto first = part(0), middle = part(1), last = part(2);
    const auto value = detail::differences(first.value, middle.value, last.value);
    const auto mean = [&p](const f64x8& low, const f64x8& mid, const f64x8& high) {
      return detail::sum_to_one(p.w[d][0], p.w[d][2], detail::differences(low, mid, high));
    };
    sum.value = detail::sum_to_one(p.w[d][0], p.w[d][2], value);
    if constexpr (wanted.slopes) {
      sum.slope[0] = detail::sum_to_none(p.dw[d][0], p.dw[d][2], value);
      for (int e = 0; e < rest; ++e) sum.slope[e + 1] = mean(first.slope[e], middle.slope[e], last.slope[e]);
    }
    if constexpr (wanted.moments) {
      sum.moment[0] = detail::sum_to_none(p.wa[d][0], p.wa[d][2], value);
      for (int e = 0; e < rest; ++e)
        sum.moment[e + 1] = mean(first.moment[e], middle.moment[e], last.moment[e]);
    }
  }
  return sum;
}

/// The same vector in both halves, and two vectors side by side.
inline f64x8 twice(const f64x4& a) {
#ifdef __AVX512F__  // one load; a shuffle would take an arithmetic unit
  return _mm512_maskz_broadcast_f64x4(0xff, a);
#else
  return __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3);
#endif
}
inline f64x8 side_by_side(const f64x4& a, const f64x4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline f64x8 pair(double a, double b) { return f64x8{a, a, a, a, b, b, b, b}; }
inline f64x4 low_half(const f64x8& a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }

/// Rows of four (one a point) to columns of eight (one a component), and back.
inline void to_columns(const f64x4 (&row)[f64x8_size], f64x8 (&column)[4]) {
  f64x8 low[2], high[2];  // components 0 and 2, 1 and 3 of points 0-3 and 4-7
  for (int i = 0; i < 2; ++i) {
    const f64x4* r = row + 4 * i;
    const f64x8 even = side_by_side(r[0], r[2]);
    const f64x8 odd = side_by_side(r[1], r[3]);
    low[i] = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
    high[i] = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  column[0] = __builtin_shufflevector(low[0], low[1], 0, 1, 4, 5, 8, 9, 12, 13);
  column[1] = __builtin_shufflevector(high[0], high[1], 0, 1, 4, 5, 8, 9, 12, 13);
  column[2] = __builtin_shufflevector(low[0], low[1], 2, 3, 6, 7, 10, 11, 14, 15);
  column[3] = __builtin_shufflevector(high[0], high[1], 2, 3, 6, 7, 10, 11, 14, 15);
}

/// One vector of four a point, even points first: where four_a_point brings them.
using FourAPoint = std::array<f64x8, f64x8_size / 2>;
inline f64x4 of_point(const FourAPoint& four, std::size_t l) {
  return reinterpret_cast<const f64x4*>(four.data())[l % 2 * (f64x8_size / 2) + l / 2];
}
inline void four_a_point(const f64x8 (&column)[4], FourAPoint& four) {
  for (std::size_t odd = 0; odd < 2; ++odd) {
    const f64x8 front = odd ? __builtin_shufflevector(column[0], column[1], 1, 9, 3, 11, 5, 13, 7, 15)
                            : __builtin_shufflevector(column[0], column[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const f64x8 back = odd ? __builtin_shufflevector(column[2], column[3], 1, 9, 3, 11, 5, 13, 7, 15)
                           : __builtin_shufflevector(column[2], column[3], 0, 8, 2, 10, 4, 12, 6, 14);
    four[2 * odd] = __builtin_shufflevector(front, back, 0, 1, 8, 9, 2, 3, 10, 11);
    four[2 * odd + 1] = __builtin_shufflevector(front, back, 4, 5, 12, 13, 6, 7, 14, 15);
  }
}
inline void to_rows(const f64x8 (&column)[4], f64x4 (&row)[f64x8_size]) {
  FourAPoint four;
  four_a_point(column, four);
  for (std::size_t l = 0; l < f64x8_size; ++l) row[l] = of_point(four, l);
}

/// Products of the weights of all directions but the last: those of the rows of nodes that a point sees.
template <int D>
using RowWeights = std::array<f64x8, power(3, D - 1)>;

template <int D>
void multiply_rows(const Weights<D>& weights, RowWeights<D>& rows) {
  for (int r = 0; r < power(3, D - 1); ++r) {
    rows[r] = weights.w[0][r / power(3, D - 2)];
    if constexpr (D == 3) rows[r] *= weights.w[1][r % 3];
  }
}

/// What eight points add to their nodes: values, and for each direction d what goes with the gradient's
/// and with the arm's component d, one vector a component. What is not `given` is not read.
template <int D>
struct Spread {
  f64x8 value[4], slope[D][D], moment[D][D];
};

/// What is given of a Spread.
struct Given {
  bool values = true, slopes = true, moments = true;
};

/// slope[d] times the gradient plus moment[d] times the arm, at the nodes k of direction d.
template <int D, Given given>
[[gnu::always_inline]] inline void along_direction(const Weights<D>& weights, const Spread<D>& spread, int d,
                                                   int k, f64x8 (&along)[D]) {
  for (int c = 0; c < D; ++c) {
    along[c] = f64x8{};
    if constexpr (given.slopes) along[c] = weights.dw[d][k] * spread.slope[d][c];
    if constexpr (given.moments) along[c] += weights.wa[d][k] * spread.moment[d][c];
  }
}

/// What each row of nodes gets before the weights of the last direction.
template <int D, Given given>
void carry_to_rows(const Weights<D>& weights, const Spread<D>& spread,
                   FourAPoint (&carried)[power(3, D - 1)]) {
  f64x8 second[3][D];
  for (int j = 0; j < 3 && D == 3; ++j) along_direction<D, given>(weights, spread, 1, j, second[j]);
#pragma GCC unroll 3
  for (int i = 0; i < 3; ++i) {
    const f64x8& w = weights.w[0][i];
    f64x8 first[4] = {}, along[D];
    along_direction<D, given>(weights, spread, 0, i, along);
    for (int c = 0; c < 4 && given.values; ++c) first[c] = w * spread.value[c];
    for (int c = 0; c < D; ++c) first[c] += along[c];
    if constexpr (D == 2) {
      four_a_point(first, carried[i]);
    } else {
#pragma GCC unroll 3
      for (int j = 0; j < 3; ++j) {
        f64x8 row[4];
        for (int c = 0; c < 4; ++c) row[c] = weights.w[1][j] * first[c];
        for (int c = 0; c < D; ++c) row[c] += w * second[j][c];
        four_a_point(row, carried[3 * i + j]);
      }
    }
  }
}

/// What a group of eight brings to the last direction: along each row, and at each of the three nodes.
template <int D>
struct CarriedRows {
  RowWeights<D> weight;
  FourAPoint value[power(3, D - 1)], along[3];
};

/// Distance of row r of a stencil from its first node in a tile's cube.
template <int D>
constexpr int row_offset(int r) {
  return D == 2 ? r * tile_span : (r / 3 * tile_span + r % 3) * tile_span;
}

/// Adds points first ... last - 1, whose stencils all begin where that of `first` does, to their nodes:
/// the sums stay in registers.
template <int D>
[[gnu::always_inline]] inline void add_run(const Weights<D>& weights, const CarriedRows<D>& rows,
                                           std::size_t first, std::size_t last, f64x4* sums) {
  constexpr int n = power(3, D - 1);
  f64x8 two[n], one[n];
  const int base = weights.base[first], odd = base & 1, other = odd ? 0 : 2;
  f64x4* const pair_at = sums + base + odd;
  f64x4* const other_at = sums + base + other;
#pragma GCC unroll 9
  for (int r = 0; r < n; ++r)
    two[r] = *reinterpret_cast<const f64x8*>(pair_at + row_offset<D>(r)), one[r] = f64x8{};
  const auto& w = weights.w[D - 1];
  for (std::size_t l = first; l < last; ++l) {
    const f64x8 w_pair = pair(w[odd][l], w[odd + 1][l]), w_other = all_lanes(w[other][l]);
    const f64x8 along_pair = side_by_side(of_point(rows.along[odd], l), of_point(rows.along[odd + 1], l));
    const f64x8 along_other = twice(of_point(rows.along[other], l));
#pragma GCC unroll 9
    for (int r = 0; r < n; ++r) {
      const f64x8 value = twice(of_point(rows.value[r], l)), weight = all_lanes(rows.weight[r][l]);
      two[r] = two[r] + w_pair * value + weight * along_pair;
      one[r] = one[r] + w_other * value + weight * along_other;
    }
  }
#pragma GCC unroll 9
  for (int r = 0; r < n; ++r) {
    *reinterpret_cast<f64x8*>(pair_at + row_offset<D>(r)) = two[r];
    other_at[row_offset<D>(r)] += low_half(one[r]);
  }
}

/// Points of several places, run by run of those with the same. noipa: below -O3 with AVX-512 g++ 12 sees a
/// loop here that writes to no memory, and drops the call.
template <int D>
[[gnu::noipa]] void add_by_runs(const Weights<D>& weights, const CarriedRows<D>& rows, int n, f64x4* sums) {
  const auto end = static_cast<std::size_t>(n);
  for (std::size_t first = 0, last; first < end; first = last) {
    for (last = first + 1; last < end && weights.base[last] == weights.base[first];) ++last;
    add_run<D>(weights, rows, first, last, sums);
  }
}

/// Adds what the first n of eight points spread to their nodes in the tile's cube; the others spread
/// nothing.
template <int D, Given given>
void scatter_group(const Weights<D>& weights, const Spread<D>& spread, int n, f64x4* sums) {
  CarriedRows<D> rows;
  multiply_rows<D>(weights, rows.weight);
  carry_to_rows<D, given>(weights, spread, rows.value);
  for (int k = 0; k < 3; ++k) {
    f64x8 column[4] = {}, along[D];
    along_direction<D, given>(weights, spread, D - 1, k, along);
    std::copy_n(along, D, column);
    four_a_point(column, rows.along[k]);
  }
  if (weights.together)
    add_run<D>(weights, rows, 0, f64x8_size, sums);
  else
    add_by_runs<D>(weights, rows, n, sums);
}

}  // namespace tremie
