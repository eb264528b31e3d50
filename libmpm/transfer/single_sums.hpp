#pragma once

// Sums over the 3^D nodes of sixteen points in single precision.
//
// A row of four nodes is one vector of sixteen, so that a point reads and adds to its 3^(D-1) rows one
// vector each, wherever its stencil begins: points of different cells cost what those of one cell do. Shape
// functions are made for the sixteen points at once, one lane a point.
//
// On some processors additions have units of their own, and multiply-adds are what binds: so sums are made of
// as few of these as there may be. The weights of a direction add up to 1, their slopes to 0, which leaves
// two numbers of three: slopes are read from differences to the middle node, and of impulses the middle
// row has what the others leave. (The middle node has half of the weight at least, but for splines next to
// a wall.) Across the rows moments are read, and momenta given, about the middle node, whose neighbours
// are a cell away (splines next to a wall: half a cell): each row has one product with its weight, the rest
// is sums.

#include "libmpm/transfer/simd_sums.hpp"
#include "libmpm/transfer/single_lanes.hpp"

namespace tremie {

/// What weights are made for; what it does not read is not written.
enum class WeighedFor {
  stress,   ///< gather_slopes and scatter_impulses
  reading,  ///< gather_moments, and the inertia for what it reads
  giving    ///< scatter_momenta
};

/// Shape functions of sixteen points at their three nodes in each direction, and where their stencils
/// begin in the tile's cube.
template <int D>
struct SingleWeights {
  f32x16 w[D][3];                  ///< in all directions for stress, else in the last alone
  f32x16 dw[D][2];                 ///< slopes at the first and the last [1/m]
  f32x16 across[power(3, D - 1)];  ///< of rows: the product of all directions but the last
  f32x16 wa[2];       ///< arm from the point times weight, first and last of the last direction [m]
  f32x16 middle[D];   ///< arm of the middle node from the point [m]
  f32x16 arm[D][2];   ///< of the first and the last from the middle one [m]
  f32x16 inertia[D];  ///< sum of w times the arm from the point squared [m^2]
  std::array<int, f32x16_size> base;
};

namespace detail {

template <ShapeFunctions kind, class Lanes>
[[gnu::always_inline]] inline void weights_of_axis(const SingleStencilAxis& axis, const Lanes& at,
                                                   const Lanes& X, Lanes (&w)[3], Lanes (&dw)[3],
                                                   Lanes (&arm)[3]) {
  if constexpr (kind == ShapeFunctions::gimp)
    gimp_weights(axis, at, X - at, w, dw, arm);
  else
    b_spline_weights(axis, at, X - at, w, dw, arm);
}

}  // namespace detail

/// Weights of the points at x in a tile, eight and eight: as weigh() of simd_stencils.hpp.
template <ShapeFunctions kind, WeighedFor use, int D>
void weigh_single(const StencilFrame<D>& frame, const std::array<f64x8, D> (&x)[2],
                  SingleWeights<D>& weights) {
  constexpr int last = D - 1;
  const f32x16 low = -1 - f32x16{}, high = tile_cells - f32x16{};
  f32x16 base = {}, w[D][3];
#pragma GCC unroll 3
  for (int d = 0; d < D; ++d) {
    const StencilAxis& axis = frame.axis[d];
    const auto in_tile = [&](const f64x8& place) {
      return place_in_tile(axis.origin, axis.ih, axis.first, place);
    };
    const f32x16 X = to_single(in_tile(x[0][d]), in_tile(x[1][d]));
    const f32x16 at = min(max(kind == ShapeFunctions::gimp ? nearest(X) : floor(X), low), high);
    f32x16 dw[3], arm[3];
    detail::weights_of_axis<kind>(frame.single[d], at, X, w[d], dw, arm);
    base = base * tile_span + (at + 1);
    if (use == WeighedFor::stress || d == last) std::copy_n(w[d], 3, weights.w[d]);
    if constexpr (use == WeighedFor::stress) {
      weights.dw[d][0] = dw[0], weights.dw[d][1] = dw[2];
      continue;
    }
    const f32x16 below = arm[0] - arm[1], above = arm[2] - arm[1];
    weights.middle[d] = arm[1], weights.arm[d][0] = below, weights.arm[d][1] = above;
    if constexpr (use == WeighedFor::reading) {
      const f32x16 wa[2] = {w[d][0] * arm[0], w[d][2] * arm[2]};
      weights.inertia[d] = wa[0] * below + wa[1] * above;
      if (d == last) std::copy_n(wa, 2, weights.wa);
    }
  }
  for (int r = 0; r < power(3, D - 1) && use != WeighedFor::stress; ++r)
    weights.across[r] = D == 2 ? w[0][r] : w[0][r / 3] * w[1][r % 3];
  const auto whole = __builtin_convertvector(base, i32x16);
  std::memcpy(weights.base.data(), &whole, sizeof whole);
}

/// A nodal field at sixteen points: values, and slopes or moments in each direction. Entry 3 of four is not
/// read.
template <int D>
struct SingleFields {
  f32x16 value[3], along[D][3];
};

namespace detail {

/// A stencil's rows of nodes: those that differ in the second direction alone by their differences.
template <int D>
struct Rows {
  std::conditional_t<D == 2, f32x16, Differences<f32x16>> at[3];

  [[gnu::always_inline]] void load(const f32x4* node) {
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      const f32x4* row = node + i * stride<D>(tile_span, 0);
      if constexpr (D == 2)
        at[i] = load_controls(row);
      else
        at[i] = differences(load_controls(row), load_controls(row + tile_span),
                            load_controls(row + 2 * tile_span));
    }
  }
};

/// What the first n of sixteen points read: `load(base)` the rows of the stencil that begins there, `sum(l,
/// of)` what point l has of them, of[0] with the weights of all directions but the last, of[1 + d] with
/// direction d's slopes or moments in place of its weights. Then the last direction, `side` in place of its
/// weights for the last of the fields. What is no real point gets what the rows of the first point of its
/// eight are with weights of its own: the same as it, where it stands there. Values may be left out. Points
/// of one stencil that follow each other read its rows once.
template <int D, bool values, class Load, class Sum>
[[gnu::always_inline]] inline void sum_controls(const SingleWeights<D>& p, const f32x16 (&side)[2],
                                                std::size_t n, SingleFields<D>& fields, Load load, Sum sum) {
  f32x16 entry[D + 1][4];  // of points 4b + a in block a of vector b
  int base = -1;
  for (std::size_t b = 0; b < 4; ++b) {
    f32x16 of_four[D][4];
#pragma GCC unroll 4
    for (std::size_t a = 0; a < 4; ++a) {
      const std::size_t l = 4 * b + a, from = l < n ? l : n > f64x8_size ? l & f64x8_size : 0;
      if (p.base[from] != base) load(base = p.base[from]);
      f32x16 of[D];
      sum(from, of);
      for (int q = 0; q < D; ++q) of_four[q][a] = of[q];
    }
    const auto repeat = [b](const f32x16& of) {
      return each_four_times(reinterpret_cast<const f32x4*>(&of)[b]);
    };
    const f32x16 first = repeat(p.w[D - 1][0]), last = repeat(p.w[D - 1][2]);
    for (int q = 0; q < D; ++q) {
      const Blocks block = first_three_blocks(of_four[q]);
      const auto along = differences(block.first, block.second, block.third);
      if (q > 0 || values) entry[q][b] = sum_to_one(first, last, along);
      if (q == 0) entry[D][b] = sum_to_none(repeat(side[0]), repeat(side[1]), along);
    }
  }
  for (int q = values ? 0 : 1; q <= D; ++q) {
    f32x16 column[4];
    transpose_blocks(entry[q], column);
    for (int c = 0; c < 3; ++c) (q == 0 ? fields.value : fields.along[q - 1])[c] = transposed(column[c]);
  }
}

}  // namespace detail

/// Slopes at the first n of sixteen points, and values if they are wanted.
template <int D, bool values>
[[gnu::noinline]] void gather_slopes(const f32x4* v, const SingleWeights<D>& p, std::size_t n,
                                     SingleFields<D>& fields) {
  detail::Rows<D> rows;
  const auto sum = [&](std::size_t l, f32x16(&of)[D]) {
    f32x16 row[3], turned[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; ++i) {
      if constexpr (D == 2) {
        row[i] = rows.at[i];
      } else {
        row[i] = detail::sum_to_one(p.w[1][0][l], p.w[1][2][l], rows.at[i]);
        turned[i] = detail::sum_to_none(p.dw[1][0][l], p.dw[1][1][l], rows.at[i]);
      }
    }
    const auto across = detail::differences(row[0], row[1], row[2]);
    const auto first = p.w[0][0][l], last = p.w[0][2][l];
    of[0] = detail::sum_to_one(first, last, across);
    of[1] = detail::sum_to_none(p.dw[0][0][l], p.dw[0][1][l], across);
    if constexpr (D == 3)
      of[2] = detail::sum_to_one(first, last, detail::differences(turned[0], turned[1], turned[2]));
  };
  detail::sum_controls<D, values>(
      p, p.dw[D - 1], n, fields, [&](int base) { rows.load(v + base); }, sum);
}

/// Values and moments about the points.
template <ShapeFunctions kind, int D>
[[gnu::noinline]] void gather_moments(const f32x4* v, const SingleWeights<D>& p, std::size_t n,
                                      SingleFields<D>& fields) {
  constexpr bool even = kind == ShapeFunctions::gimp;
  constexpr int rows = power(3, D - 1);
  f32x16 row[rows];
  const auto load = [&](int base) {
#pragma GCC unroll 9
    for (int r = 0; r < rows; ++r) row[r] = detail::load_controls(v + base + row_offset<D>(r));
  };
  const auto sum = [&](std::size_t l, f32x16(&of)[D]) {
    const auto share = [&](int r) { return detail::rounded(p.across[r][l] * row[r]); };
    // Moment about the middle node in direction d, where its arms are even in units of them.
    const auto moment = [&](int d, const f32x16& low, const f32x16& high) {
      return even ? high - low : p.arm[d][0][l] * low + p.arm[d][1][l] * high;
    };
    if constexpr (D == 2) {
      const f32x16 low = share(0), high = share(2);
      of[0] = (low + high) + p.across[1][l] * row[1];
      of[1] = moment(0, low, high);
    } else {
      const f32x16 corner[2][2] = {{share(0), share(2)}, {share(6), share(8)}};
      const f32x16 left = share(3), right = share(5);
      const f32x16 low = (corner[0][0] + corner[0][1]) + p.across[1][l] * row[1],
                   high = (corner[1][0] + corner[1][1]) + p.across[7][l] * row[7];
      of[0] = (low + high) + ((left + right) + p.across[4][l] * row[4]);
      of[1] = moment(0, low, high);
      of[2] = moment(1, corner[0][0] + corner[1][0] + left, corner[0][1] + corner[1][1] + right);
    }
  };
  detail::sum_controls<D, true>(p, p.wa, n, fields, load, sum);
  for (int d = 0; d + 1 < D; ++d)
    for (int c = 0; c < 3; ++c) {
      f32x16& moment = fields.along[d][c];
      moment = (even ? p.arm[d][1] * moment : moment) + p.middle[d] * fields.value[c];
    }
}

/// Rows that points add to, and how many runs of points with the same stencil they are.
struct Reached {
  TileRows rows = 0;
  int runs = 0;
};

/// What moving points give: mass, last, and momentum where their middle nodes are; moment[d] times the arm
/// from there in direction d comes to the momentum.
template <int D>
struct SingleMomenta {
  f32x16 value[D + 1], moment[D][D];
};

/// What stresses push with: slope[d] times the gradient in direction d, and value times the weight.
template <int D>
struct SingleImpulses {
  f32x16 value[D], slope[D][D];
};

namespace detail {

/// Visits the first n of sixteen points by runs of one stencil: add(l) each point, end(node) each run, whose
/// stencil begins at that node.
template <int D, class Add, class End>
[[gnu::always_inline]] inline Reached for_each_run(const SingleWeights<D>& p, std::size_t n, f32x4* sums,
                                                   Add add, End end) {
  Reached reached;
  for (std::size_t l = 0; l < n; ++reached.runs) {
    const int base = p.base[l];
    do add(l);
    while (++l < n && p.base[l] == base);
    end(sums + base);
    reached.rows |= stencil_rows<D>(base);
  }
  return reached;
}

}  // namespace detail

/// Adds momenta and masses of the first n of sixteen points to their nodes in the tile's cube,
/// w_i w_j w_k (value + moment[0] a_i + moment[1] a_j + moment[2] a_k). The node behind a stencil's row is
/// added nothing. noipa: as add_by_runs() of simd_sums.hpp.
template <ShapeFunctions kind, int D>
[[gnu::noipa]] Reached scatter_momenta(const SingleWeights<D>& p, const SingleMomenta<D>& of, std::size_t n,
                                       f32x4* sums) {
  using detail::each_four_times, detail::four_times, detail::entries_of;
  constexpr bool even = kind == ShapeFunctions::gimp;
  constexpr int rows = power(3, D - 1);
  constexpr std::size_t last = D - 1;
  const f32x16 arms[3] = {p.w[last][0] * p.arm[last][0], f32x16{}, p.w[last][2] * p.arm[last][1]};
  const detail::Entries w = entries_of(p.w[last]), wa = entries_of(arms), value = entries_of(of.value);
  detail::Entries moment[D];  // where arms are even, in the directions across times these
  for (std::size_t d = 0; d < D; ++d) {
    f32x16 times_arm[D];
    for (int c = 0; c < D; ++c)
      times_arm[c] = even && d < last ? p.arm[d][1] * of.moment[d][c] : of.moment[d][c];
    moment[d] = entries_of(times_arm);
  }
  f32x16 sum[rows] = {};
  const auto add = [&](std::size_t l) {
    const std::size_t at = detail::place_of(l);
    const f32x16 w_k = each_four_times(w[at]);
    const f32x16 middle =
        w_k * four_times(value[at]) + each_four_times(wa[at]) * four_times(moment[last][at]);
    // What the first and the last in direction d have more than the middle one.
    const auto more = [&](std::size_t d, f32x16(&of_d)[2]) {
      const f32x16 by_d = detail::rounded(w_k * four_times(moment[d][at]));
      for (std::size_t k = 0; k < 2; ++k)
        of_d[k] = even ? (k == 0 ? -by_d : by_d) : detail::rounded(p.arm[d][k][l] * by_d);
    };
    f32x16 by_i[2];
    more(0, by_i);
    const f32x16 row[3] = {middle + by_i[0], middle, middle + by_i[1]};
    if constexpr (D == 2) {
      for (int i = 0; i < 3; ++i) sum[i] += p.across[i][l] * row[i];
    } else {
      f32x16 by_j[2];
      more(1, by_j);
#pragma GCC unroll 3
      for (int i = 0; i < 3; ++i) {
        sum[3 * i] += p.across[3 * i][l] * (row[i] + by_j[0]);
        sum[3 * i + 1] += p.across[3 * i + 1][l] * row[i];
        sum[3 * i + 2] += p.across[3 * i + 2][l] * (row[i] + by_j[1]);
      }
    }
  };
  const auto end = [&](f32x4* node) {
#pragma GCC unroll 9
    for (int r = 0; r < rows; ++r) {
      detail::add_controls(sum[r], node + row_offset<D>(r));
      sum[r] = f32x16{};
    }
  };
  return detail::for_each_run<D>(p, n, sums, add, end);
}

/// The same with impulses: slope[0] dw_i w_j w_k + slope[1] w_i dw_j w_k + slope[2] w_i w_j dw_k, and
/// value w_i w_j w_k if there are `values`.
template <int D, bool values>
[[gnu::noipa]] Reached scatter_impulses(const SingleWeights<D>& p, const SingleImpulses<D>& of, std::size_t n,
                                        f32x4* sums) {
  using detail::each_four_times, detail::four_times, detail::entries_of;
  constexpr std::size_t last = D - 1;
  const f32x16 slopes[3] = {p.dw[last][0], -p.dw[last][0] - p.dw[last][1], p.dw[last][1]};
  const detail::Entries w = entries_of(p.w[last]), dw = entries_of(slopes);
  detail::Entries value, slope[D];
  if constexpr (values) value = entries_of(of.value);
  for (int d = 0; d < D; ++d) slope[d] = entries_of(of.slope[d]);
  // Outer rows: those at the corners, and sums of all with one i, with one j, and of all.
  f32x16 corner[2][2] = {}, with_i[2] = {}, with_j[2] = {}, all = {};
  const auto add = [&](std::size_t l) {
    const std::size_t at = detail::place_of(l);
    const f32x16 w_k = each_four_times(w[at]), by_i = w_k * four_times(slope[0][at]);
    f32x16 row = each_four_times(dw[at]) * four_times(slope[last][at]);
    if constexpr (values) row += w_k * four_times(value[at]);
    all += row;
    f32x16 of_i[2];
#pragma GCC unroll 2
    for (int i = 0; i < 2; ++i) {
      of_i[i] = detail::rounded(p.dw[0][i][l] * by_i + p.w[0][2 * i][l] * row);
      with_i[i] += of_i[i];
    }
    if constexpr (D == 3) {
      const f32x16 by_j = w_k * four_times(slope[1][at]);
#pragma GCC unroll 2
      for (int j = 0; j < 2; ++j) {
        const auto w_j = p.w[1][2 * j][l], dw_j = p.dw[1][j][l];
        with_j[j] = with_j[j] + w_j * row + dw_j * by_j;
#pragma GCC unroll 2
        for (int i = 0; i < 2; ++i)
          corner[i][j] = corner[i][j] + w_j * of_i[i] + dw_j * (p.w[0][2 * i][l] * by_j);
      }
    }
  };
  const auto end = [&](f32x4* node) {
    const auto give = [node](int r, const f32x16& sum) {
      detail::add_controls(sum, node + row_offset<D>(r));
    };
    if constexpr (D == 2) {
      give(0, with_i[0]), give(1, all - with_i[0] - with_i[1]), give(2, with_i[1]);
    } else {
      const f32x16 low = with_j[0] - corner[0][0] - corner[1][0],
                   high = with_j[1] - corner[0][1] - corner[1][1];
      give(0, corner[0][0]), give(1, with_i[0] - corner[0][0] - corner[0][1]), give(2, corner[0][1]);
      give(3, low), give(4, all - with_i[0] - with_i[1] - low - high), give(5, high);
      give(6, corner[1][0]), give(7, with_i[1] - corner[1][0] - corner[1][1]), give(8, corner[1][1]);
    }
    for (int i = 0; i < 2; ++i) corner[i][0] = corner[i][1] = with_i[i] = with_j[i] = f32x16{};
    all = f32x16{};
  };
  return detail::for_each_run<D>(p, n, sums, add, end);
}

}  // namespace tremie
