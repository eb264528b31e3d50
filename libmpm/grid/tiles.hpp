#pragma once

// The grid of the explicit steps: tiles of 4 cells a direction where there is concrete, and nothing
// elsewhere.
//
// A tile's points see the nodes 4a - 1 ... 4a + 6 of each direction: its own cells and one more on either
// side, so that points may drift by a cell before they are sorted again. Nodes are kept in blocks, 4b - 1
// ... 4b + 2; a tile reads exactly 2^D of them. What its points add to the nodes goes into the tile's own
// buffer, and each block sums up the buffers of its 2^D tiles in one fixed order: no locks, and the same bits
// for any number of threads. Points reach about half of the rows that their tile sees (a row: the nodes
// along the last direction); each tile knows which, and the others are neither cleared nor read nor summed.
//
// A step goes over the blocks, for the velocities of their nodes, and over the tiles (passes.hpp).

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <vector>
#ifdef __AVX__
#include <immintrin.h>
#endif

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

inline constexpr int tile_cells = 4;
inline constexpr int tile_span = 2 * tile_cells;  ///< nodes that a tile sees in each direction

/// One entry a node: components 0 to D-1 a vector, component D the mass, or of velocities 1/mass [1/kg], 0
/// where there is none.
using f64x4 [[gnu::vector_size(32)]] = double;

/// The same in single precision.
using f32x4 [[gnu::vector_size(16)]] = float;

inline f64x4 in_double(const f64x4& node) { return node; }
inline f64x4 in_double(const f32x4& node) {
#ifdef __AVX__  // the compiler would do it by halves
  return _mm256_cvtps_pd(node);
#else
  return __builtin_convertvector(node, f64x4);
#endif
}
inline void add_to(f64x4& node, const f64x4& a) { node += a; }
inline void add_to(f32x4& node, const f64x4& a) { node += __builtin_convertvector(a, f32x4); }

/// Two nodes side by side.
using two_f64x4 [[gnu::vector_size(64), gnu::may_alias]] = double;
using two_f32x4 [[gnu::vector_size(32), gnu::may_alias]] = float;

inline two_f64x4 both(const f64x4& a, const f64x4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline two_f32x4 both(const f32x4& a, const f32x4& b) {
  return __builtin_shufflevector(a, b, 0, 1, 2, 3, 4, 5, 6, 7);
}

/// A node and the next, from any one on.
inline two_f64x4 load_two(const f64x4* from) {
  two_f64x4 two;
  std::memcpy(&two, from, sizeof two);
  return two;
}
inline two_f32x4 load_two(const f32x4* from) {
  two_f32x4 two;
  std::memcpy(&two, from, sizeof two);
  return two;
}
template <class Two, class Node>
void store_two(const Two& two, Node* to) {
  static_assert(sizeof(Two) == 2 * sizeof(Node));
  std::memcpy(to, &two, sizeof two);
}

/// Rows of the nodes that a tile sees, one bit each; the direction before the last runs fastest.
using TileRows = std::uint64_t;
template <int D>
inline constexpr TileRows all_rows = D == 2 ? (1 << tile_span) - 1 : ~TileRows{0};

template <int D>
struct Tile {
  Index<D> at{};                         ///< its cells are 4 at ... 4 at + 3
  int first_group = 0, last_group = 0;   ///< its points, in groups of eight: [first, last)
  int mixed_groups = 0;                  ///< of these, groups of points of several cells
  std::array<int, power(2, D)> block{};  ///< blocks at + offset; the last direction fastest
};

template <int D>
struct NodeBlock {
  Index<D> at{};
  std::array<int, power(2, D)> tile{};  ///< tiles at - offset; -1: none
  std::uint64_t on_walls = 0;           ///< its nodes on flat walls, one bit each
};

/// The nodes that a tile sees, aligned so that an even one and the next make one vector of eight. In
/// single precision four are taken at once, from any one on: there is room behind the last.
template <class Node, int n>
struct alignas(64) NodeCube : std::array<Node, n + (std::is_same_v<Node, f32x4> ? 4 : 0)> {};

template <int D>
using BlockNodes = std::array<f64x4, power(tile_cells, D)>;

template <int D>
struct TileGrid {
  static constexpr int tile_nodes = power(tile_span, D);
  using Buffer = NodeCube<f64x4, tile_nodes>;
  using SingleBuffer = NodeCube<f32x4, tile_nodes>;

  std::array<Axis, D> axes;
  std::vector<Tile<D>> tiles;
  std::vector<NodeBlock<D>> blocks;
  std::vector<BlockNodes<D>> v;        ///< a block: velocities, in the rows that a tile reaches
  std::vector<BlockNodes<D>> v_start;  ///< a block: before the step's forces, for FLIP alone
  std::vector<Buffer> sums;            ///< a tile: momentum and mass that the points give
  std::vector<Buffer> forces;          ///< a tile: impulse of the stresses, for FLIP alone
  bool single = false;                 ///< sums are kept in single precision, in these:
  std::vector<SingleBuffer> single_sums;
  std::vector<TileRows> rows;  ///< a tile: what its points reached; all else in its buffer is zero

  int n_tiles() const { return static_cast<int>(tiles.size()); }
};

/// The buffers of sums, of either precision.
template <class Node, int D>
auto& sums_of(TileGrid<D>& grid) {
  if constexpr (std::is_same_v<Node, f32x4>)
    return grid.single_sums;
  else
    return grid.sums;
}

/// Distance between neighbours in direction d within a cube of `span` entries a direction.
template <int D>
constexpr int stride(int span, int d) {
  return power(span, D - 1 - d);
}

/// Offset (0 or 1 in each direction) of the k-th corner; the last direction runs fastest.
template <int D>
constexpr Index<D> corner(int k) {
  Index<D> o{};
  for (int d = D - 1; d >= 0; --d, k /= 2) o[d] = k % 2;
  return o;
}

namespace detail {

/// Tile or block index on a periodic axis, wrapped.
inline int wrapped(const Axis& axis, int at) {
  const int n = axis.n_cells / tile_cells;
  return axis.periodic ? ((at % n) + n) % n : at;
}

}  // namespace detail

/// Visits the numbers of the rows in `rows`.
template <class Visit>
[[gnu::always_inline]] inline void for_each_row(TileRows rows, Visit visit) {
  for (; rows != 0; rows &= rows - 1) visit(__builtin_ctzll(rows));
}

/// Rows of the stencil that begins at `base` in a tile's cube.
template <int D>
TileRows stencil_rows(int base) {
  constexpr TileRows three = D == 2 ? 7 : 7 | 7 << tile_span | 7 << 2 * tile_span;
  return three << (base / tile_span);
}

template <class Node, int n>
void clear_rows(TileRows rows, NodeCube<Node, n>& cube) {
  for_each_row(rows, [&](int row) {
    auto* const from = reinterpret_cast<two_f64x4*>(&cube[static_cast<std::size_t>(row * tile_span)]);
    for (std::size_t i = 0; i < tile_span * sizeof(Node) / sizeof(two_f64x4); ++i) from[i] = two_f64x4{};
  });
}

/// Of a tile's rows those of its k-th block, four a direction.
template <int D>
unsigned rows_of_block(TileRows rows, int k) {
  const Index<D> c = corner<D>(k);
  constexpr TileRows four = (1 << tile_cells) - 1;
  if constexpr (D == 2) {
    return static_cast<unsigned>(rows >> (c[0] * tile_cells) & four);
  } else {
    unsigned in_block = 0;
    rows >>= (c[0] * tile_span + c[1]) * tile_cells;
    for (int i = 0; i < tile_cells; ++i)
      in_block |= static_cast<unsigned>(rows >> (i * tile_span) & four) << (i * tile_cells);
    return in_block;
  }
}

/// Where row `row` of a tile's k-th block begins in the tile's cube.
template <int D>
int row_in_cube(int k, int row) {
  const Index<D> c = corner<D>(k);
  int at = c[D - 1] * tile_cells;
  for (int d = D - 2; d >= 0; --d, row /= tile_cells)
    at += (c[d] * tile_cells + row % tile_cells) * stride<D>(tile_span, d);
  return at;
}

/// Copies four nodes.
inline void copy_row(const f64x4* from, f64x4* to) { std::copy_n(from, tile_cells, to); }
inline void copy_row(const f64x4* from, f32x4* to) {
  f64x8 low, high;
  std::memcpy(&low, from, sizeof low), std::memcpy(&high, from + tile_cells / 2, sizeof high);
  const f32x16 row = to_single(low, high);
  std::memcpy(to, &row, sizeof row);
}

/// Copies rows of a tile's blocks into one cube of nodes.
template <int D, class Node>
void read_blocks(const Tile<D>& tile, TileRows rows, const std::vector<BlockNodes<D>>& blocks,
                 NodeCube<Node, power(tile_span, D)>& cube) {
  for (int k = 0; k < power(2, D); ++k) {
    const auto& block = blocks[static_cast<std::size_t>(tile.block[k])];
    for_each_row(rows_of_block<D>(rows, k), [&](int row) {
      copy_row(&block[static_cast<std::size_t>(row * tile_cells)],
               &cube[static_cast<std::size_t>(row_in_cube<D>(k, row))]);
    });
  }
}

/// Four nodes of a row.
struct FourNodes {
  two_f64x4 low = {}, high = {};
};

inline FourNodes load_row(const f64x4* from) { return {load_two(from), load_two(from + tile_cells / 2)}; }
inline void store_row(const FourNodes& four, f64x4* to) {
  store_two(four.low, to), store_two(four.high, to + tile_cells / 2);
}

namespace detail {

/// Sums of four nodes of a row.
struct FourSums {
  FourNodes sum;
  void add(const f64x4* row) {
    const FourNodes more = load_row(row);
    sum.low += more.low, sum.high += more.high;
  }
  FourNodes total() const { return sum; }
};
struct FourSingleSums {
  f32x16 sum = {};
  void add(const f32x4* row) {
    using Row [[gnu::vector_size(64), gnu::may_alias]] = float;
    sum += *reinterpret_cast<const Row*>(row);
  }
  FourNodes total() const { return {to_double(sum, 0), to_double(sum, 1)}; }
};

}  // namespace detail

/// Visits rows of a block with the sums over its tiles' buffers: visit(row, totals of its nodes). Tile by
/// tile and not row by row: whether a tile reaches the next row is anyone's guess, the processor's too.
template <int D, class Buffer, class Visit>
void sum_tiles(const TileGrid<D>& grid, const NodeBlock<D>& block, const std::vector<Buffer>& buffers,
               Visit visit) {
  using Four = std::conditional_t<std::is_same_v<Buffer, typename TileGrid<D>::SingleBuffer>,
                                  detail::FourSingleSums, detail::FourSums>;
  unsigned reached = 0;
  std::array<Four, power(tile_cells, D - 1)> sum{};
  for (int k = 0; k < power(2, D); ++k) {
    if (block.tile[k] < 0) continue;
    const auto tile = static_cast<std::size_t>(block.tile[k]);
    const unsigned rows = rows_of_block<D>(grid.rows[tile], k);
    reached |= rows;
    for_each_row(rows, [&](int row) {
      sum[static_cast<std::size_t>(row)].add(
          &buffers[tile][static_cast<std::size_t>(row_in_cube<D>(k, row))]);
    });
  }
  for_each_row(reached, [&](int row) { visit(row, sum[static_cast<std::size_t>(row)].total()); });
}

}  // namespace tremie
