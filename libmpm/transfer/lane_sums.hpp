#pragma once

// Sums over the 3^D controls of eight points at once.
//
// Points whose stencils begin at the same place are gathered side by side: one lane a point, a control's
// value read once for all. Sums to the grid go point by point, two neighbouring controls in one vector of
// eight.

#include "libmpm/transfer/lane_stencils.hpp"

namespace tremie {

/// One component of a nodal field at eight points: value, slopes and first moments in the directions from d
/// on.
template <int R, Wanted wanted>
struct GatheredLanes {
  Octet value;
  Octet slope[wanted.slopes && R > 0 ? R : 1];
  Octet moment[wanted.moments && R > 0 ? R : 1];
};

/// Component c at eight points whose stencils all begin at `node`; otherwise as gather() for one point.
template <int D, Wanted wanted, int d = 0>
[[gnu::always_inline]] inline GatheredLanes<D - d, wanted> gather_together(const NodeLanes* node, int c,
                                                                           const Weights<D>& p) {
  GatheredLanes<D - d, wanted> sum;
  if constexpr (d == D) {
    sum.value = all_lanes((*node)[c]);
  } else {
    constexpr int rest = D - d - 1;
    for (int k = 0; k < 3; ++k) {
      const auto part = gather_together<D, wanted, d + 1>(node + k * stride<D>(tile_span, d), c, p);
      const auto add = [k](Octet& to, const Octet& w, const Octet& x) { to = k == 0 ? w * x : to + w * x; };
      add(sum.value, p.w[d][k], part.value);
      if constexpr (wanted.slopes) {
        add(sum.slope[0], p.dw[d][k], part.value);
        for (int e = 0; e < rest; ++e) add(sum.slope[e + 1], p.w[d][k], part.slope[e]);
      }
      if constexpr (wanted.moments) {
        add(sum.moment[0], p.wa[d][k], part.value);
        for (int e = 0; e < rest; ++e) add(sum.moment[e + 1], p.w[d][k], part.moment[e]);
      }
    }
  }
  return sum;
}

/// The same vector in both halves, and two vectors side by side.
inline Octet twice(const NodeLanes& a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3); }
inline Octet side_by_side(const NodeLanes& a, const NodeLanes& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Octet pair(double a, double b) { return Octet{a, a, a, a, b, b, b, b}; }
inline NodeLanes low_half(const Octet& a) { return __builtin_shufflevector(a, a, 0, 1, 2, 3); }

/// Products of the weights of all directions but the last: those of the rows of controls that a point sees.
template <int D>
using RowWeights = std::array<Octet, power(3, D - 1)>;

template <int D>
void multiply_rows(const Weights<D>& weights, RowWeights<D>& rows) {
  for (int r = 0; r < power(3, D - 1); ++r) {
    rows[r] = weights.w[0][r / power(3, D - 2)];
    if constexpr (D == 3) rows[r] *= weights.w[1][r % 3];
  }
}

/// What one point adds, in vectors of eight: the same in both halves or, in the last direction, to two
/// neighbouring controls from an even one on; the third has its own.
template <int D>
struct PointSpread {
  const Weights<D>& weights;
  const RowWeights<D>& rows;
  std::size_t lane;
  Octet along[D > 1 ? D - 1 : 1][3];  ///< slope times gradient plus moment times arm
  Octet w_pair, along_pair;
  NodeLanes along_single;
  double w_single;
};

template <int D, int d = 0>
[[gnu::always_inline]] inline void spread(NodeLanes* pair, NodeLanes* single, const PointSpread<D>& p,
                                          const Octet& carried, int row) {
  if constexpr (d == D - 1) {
    const double weight = p.rows[row][p.lane];
    Octet* const two = reinterpret_cast<Octet*>(pair);
    *two = *two + p.w_pair * carried + weight * p.along_pair;
    *single = *single + p.w_single * low_half(carried) + weight * p.along_single;
  } else {
#pragma GCC unroll 3
    for (int k = 0; k < 3; ++k) {
      const int at = k * stride<D>(tile_span, d);
      Octet next = p.weights.w[d][k][p.lane] * carried;
      if constexpr (d == 0)
        next += p.along[d][k];
      else
        next += p.weights.w[0][row][p.lane] * p.along[d][k];
      spread<D, d + 1>(pair + at, single + at, p, next, 3 * row + k);
    }
  }
}

/// Adds to every control of point l value times w plus, for each direction e, slope[e] times the gradient's
/// and moment[e] times the arm's component e, what of them is `given`. `sums`: the tile's cube.
template <int D, Wanted given>
[[gnu::always_inline]] inline void scatter_point(NodeLanes* sums, const Weights<D>& weights,
                                                 const RowWeights<D>& rows, std::size_t l,
                                                 const NodeLanes& value, const NodeLanes (&slope)[D],
                                                 const NodeLanes (&moment)[D]) {
  const auto along = [&](int d, int k) {
    NodeLanes sum = {};
    if constexpr (given.slopes) sum = weights.dw[d][k][l] * slope[d];
    if constexpr (given.moments) sum += weights.wa[d][k][l] * moment[d];
    return sum;
  };
  constexpr int last = D - 1;
  const int base = weights.base[l], odd = base & 1, other = odd ? 0 : 2;
  PointSpread<D> p{weights, rows, l, {}, {}, {}, {}, 0.0};
  for (int d = 0; d < last; ++d)
    for (int k = 0; k < 3; ++k) p.along[d][k] = twice(along(d, k));
  p.w_pair = pair(weights.w[last][odd][l], weights.w[last][odd + 1][l]);
  p.w_single = weights.w[last][other][l];
  p.along_pair = side_by_side(along(last, odd), along(last, odd + 1));
  p.along_single = along(last, other);
  spread<D>(sums + base + odd, sums + base + other, p, twice(value), 0);
}

/// Rows of four (one a point) to columns of eight (one a component), and back.
inline void to_columns(const NodeLanes (&row)[octet_size], Octet (&column)[4]) {
  Octet low[2], high[2];  // components 0 and 2, 1 and 3 of points 0-3 and 4-7
  for (int i = 0; i < 2; ++i) {
    const NodeLanes* r = row + 4 * i;
    const Octet even = side_by_side(r[0], r[2]);
    const Octet odd = side_by_side(r[1], r[3]);
    low[i] = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
    high[i] = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
  }
  column[0] = __builtin_shufflevector(low[0], low[1], 0, 1, 4, 5, 8, 9, 12, 13);
  column[1] = __builtin_shufflevector(high[0], high[1], 0, 1, 4, 5, 8, 9, 12, 13);
  column[2] = __builtin_shufflevector(low[0], low[1], 2, 3, 6, 7, 10, 11, 14, 15);
  column[3] = __builtin_shufflevector(high[0], high[1], 2, 3, 6, 7, 10, 11, 14, 15);
}
inline void to_rows(const Octet (&column)[4], NodeLanes (&row)[octet_size]) {
  for (int odd = 0; odd < 2; ++odd) {
    const Octet front = odd ? __builtin_shufflevector(column[0], column[1], 1, 9, 3, 11, 5, 13, 7, 15)
                            : __builtin_shufflevector(column[0], column[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const Octet back = odd ? __builtin_shufflevector(column[2], column[3], 1, 9, 3, 11, 5, 13, 7, 15)
                           : __builtin_shufflevector(column[2], column[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const Octet low = __builtin_shufflevector(front, back, 0, 1, 8, 9, 2, 3, 10, 11);
    const Octet high = __builtin_shufflevector(front, back, 4, 5, 12, 13, 6, 7, 14, 15);
    row[odd] = low_half(low), row[4 + odd] = low_half(high);
    row[2 + odd] = __builtin_shufflevector(low, low, 4, 5, 6, 7);
    row[6 + odd] = __builtin_shufflevector(high, high, 4, 5, 6, 7);
  }
}

}  // namespace tremie
