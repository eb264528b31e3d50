#pragma once

// The grid of the explicit steps: tiles of 4 cells a direction where there is concrete, and nothing
// elsewhere.
//
// A tile's points see the nodes 4a - 1 ... 4a + 6 of each direction: its own cells and one more on either
// side, so that points may drift by a cell before they are sorted again. Nodes are kept in blocks, 4b - 1
// ... 4b + 2; a tile reads exactly 2^D of them. What its points add to the nodes goes into the tile's own
// buffer, and each block sums up the buffers of its 2^D tiles in one fixed order: no locks, and the same bits
// for any number of threads.

#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

inline constexpr int tile_cells = 4;
inline constexpr int tile_span = 2 * tile_cells;  ///< nodes that a tile sees in each direction

/// One entry a node: components 0 to D-1 a vector, component D the mass, or of velocities 1/mass [1/kg], 0
/// where there is none.
template <class Real>
using NodeOf = Simd<Real, 4>;

/// Four nodes of a row (the last direction) side by side.
template <class Real>
using RowOf = Simd<Real, 16>;

template <class Real>
[[gnu::always_inline]] inline RowOf<Real> load_row(const NodeOf<Real>* from) {
  return load<RowOf<Real>>(reinterpret_cast<const Real*>(from));
}
template <class Real>
[[gnu::always_inline]] inline void store_row(const RowOf<Real>& row, NodeOf<Real>* to) {
  store(row, reinterpret_cast<Real*>(to));
}

/// The nodes that a tile sees, the last direction fastest. A row of four may begin at any of them: there is room
/// behind the last.
template <class Real, int D>
struct alignas(64) NodeCube : std::array<NodeOf<Real>, power(tile_span, D) + tile_cells> {};

template <int D>
using BlockNodes = std::array<f64x4, power(tile_cells, D)>;

template <int D>
struct Tile {
  Index<D> at{};                         ///< its cells are 4 at ... 4 at + 3
  int first_group = 0, last_group = 0;   ///< its points, in groups of eight: [first, last)
  std::array<int, power(2, D)> block{};  ///< blocks at + offset; the last direction fastest
};

template <int D>
struct NodeBlock {
  Index<D> at{};
  std::array<int, power(2, D)> tile{};  ///< tiles at - offset; -1: none
};

template <int D>
struct TileGrid {
  template <class Real>
  using Buffers = std::vector<NodeCube<Real, D>>;

  std::array<Axis, D> axes;
  std::vector<Tile<D>> tiles;
  std::vector<NodeBlock<D>> blocks;
  std::vector<BlockNodes<D>> v;                      ///< a block: velocities
  std::vector<BlockNodes<D>> v_start;                ///< a block: before the step's forces, for FLIP alone
  std::tuple<Buffers<double>, Buffers<float>> sums;  ///< a tile: momentum, mass and impulse of its points
  std::tuple<Buffers<double>, Buffers<float>>
      impulses;  ///< a tile: of the stresses, where FLIP tells them apart

  int n_tiles() const { return static_cast<int>(tiles.size()); }
};

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

/// Where row `row` of a tile's k-th block begins in the tile's cube.
template <int D>
int row_in_cube(int k, int row) {
  const Index<D> c = corner<D>(k);
  int at = c[D - 1] * tile_cells;
  for (int d = D - 2; d >= 0; --d, row /= tile_cells)
    at += (c[d] * tile_cells + row % tile_cells) * stride<D>(tile_span, d);
  return at;
}

/// Copies a tile's blocks into one cube of nodes.
template <class Real, int D>
void read_blocks(const Tile<D>& tile, const std::vector<BlockNodes<D>>& blocks, NodeCube<Real, D>& cube) {
  for (int k = 0; k < power(2, D); ++k) {
    const f64x4* from = blocks[tile.block[k]].data();
    for (int row = 0; row < power(tile_cells, D - 1); ++row)
      for (NodeOf<Real>*to = &cube[row_in_cube<D>(k, row)], *end = to + tile_cells; to != end; ++to)
        *to = convert<Real>(*from++);
  }
  for (int i = 0; i < tile_cells; ++i) cube[power(tile_span, D) + i] = NodeOf<Real>{};
}

/// Visits the nodes of a block with the sums over its tiles' buffers: visit(node, total).
template <int D, class Real, class Visit>
void sum_tiles(const NodeBlock<D>& block, const std::vector<NodeCube<Real, D>>& buffers, Visit visit) {
  constexpr int rows = power(tile_cells, D - 1);
  RowOf<Real> sum[rows] = {};
  for (int k = 0; k < power(2, D); ++k) {
    if (block.tile[k] < 0) continue;
    const NodeCube<Real, D>& buffer = buffers[block.tile[k]];
    for (int row = 0; row < rows; ++row)
      sum[row] = sum[row] + load_row<Real>(&buffer[row_in_cube<D>(k, row)]);
  }
  NodeOf<Real> total[rows * tile_cells];
  for (int row = 0; row < rows; ++row) store_row<Real>(sum[row], total + row * tile_cells);
  for (int i = 0; i < rows * tile_cells; ++i) visit(i, convert<double>(total[i]));
}

namespace detail {

template <int D, class Item>
int find_at(const std::vector<Item>& sorted, const Index<D>& at) {
  const auto found = std::lower_bound(sorted.begin(), sorted.end(), at,
                                      [](const Item& item, const Index<D>& i) { return item.at < i; });
  return found != sorted.end() && found->at == at ? static_cast<int>(found - sorted.begin()) : -1;
}

/// Blocks around the tiles and who sees whom.
template <int D>
void join_blocks(TileGrid<D>& grid) {
  std::vector<Index<D>> at;
  const auto neighbour = [&](const Index<D>& from, int k, int sign) {
    Index<D> to = corner<D>(k);
    for (int d = 0; d < D; ++d) to[d] = wrapped(grid.axes[d], from[d] + sign * to[d]);
    return to;
  };
  for (const Tile<D>& t : grid.tiles)
    for (int k = 0; k < power(2, D); ++k) at.push_back(neighbour(t.at, k, 1));
  std::sort(at.begin(), at.end());
  at.erase(std::unique(at.begin(), at.end()), at.end());
  grid.blocks.resize(at.size());
  for (std::size_t b = 0; b < at.size(); ++b) {
    grid.blocks[b].at = at[b];
    for (int k = 0; k < power(2, D); ++k)
      grid.blocks[b].tile[k] = find_at<D>(grid.tiles, neighbour(at[b], k, -1));
  }
  for (Tile<D>& t : grid.tiles)
    for (int k = 0; k < power(2, D); ++k) t.block[k] = find_at<D>(grid.blocks, neighbour(t.at, k, 1));
}

/// Velocities of the nodes that were there before.
template <int D>
std::vector<BlockNodes<D>> kept(const std::vector<NodeBlock<D>>& old, const std::vector<BlockNodes<D>>& v,
                                const std::vector<NodeBlock<D>>& blocks) {
  std::vector<BlockNodes<D>> now(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
    if (const int was = find_at<D>(old, blocks[b].at); was >= 0) now[b] = v[was];
  return now;
}

}  // namespace detail

/// Lays the grid under these tiles, sorted by `at`. Velocities of nodes that were there are kept.
template <class Real, int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip) {
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  grid.tiles = std::move(tiles);
  grid.blocks = {};
  detail::join_blocks<D>(grid);
  grid.v = detail::kept<D>(old, grid.v, grid.blocks);
  using Buffers = typename TileGrid<D>::template Buffers<Real>;
  std::get<Buffers>(grid.sums).resize(grid.tiles.size());
  if (!flip) return;
  grid.v_start = detail::kept<D>(old, grid.v_start, grid.blocks);
  std::get<Buffers>(grid.impulses).resize(grid.tiles.size());
}

}  // namespace tremie
