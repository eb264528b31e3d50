#pragma once

// The grid of the explicit steps: tiles of 4 cells a direction where there is concrete, and nothing
// elsewhere.
//
// A tile's points see the controls 4a - 1 ... 4a + 6 of each direction: its own cells and one more on either
// side, so that points may drift by a cell before they are sorted again. Controls are kept in blocks, 4b - 1
// ... 4b + 2; a tile reads exactly 2^D of them. What its points add to the controls goes into the tile's own
// buffer, and each block sums up the buffers of its 2^D tiles in one fixed order: no locks, and the same bits
// for any number of threads.

#include <algorithm>
#include <vector>

#include "libmpm/grid/active_grid.hpp"

namespace tremie {

inline constexpr int tile_cells = 4;
inline constexpr int tile_span = 2 * tile_cells;  ///< controls that a tile sees in each direction

/// One entry a control: components 0 to D-1 a vector, component D the mass.
using NodeLanes [[gnu::vector_size(32)]] = double;

template <int D>
struct Tile {
  Index<D> at{};                         ///< its cells are 4 at ... 4 at + 3
  int first_group = 0, last_group = 0;   ///< its points, in groups of eight: [first, last)
  std::array<int, power(2, D)> block{};  ///< blocks at + offset, the last direction running fastest
};

template <int D>
struct NodeBlock {
  Index<D> at{};
  std::array<int, power(2, D)> tile{};  ///< tiles at - offset; -1: none
};

/// The controls that a tile sees, aligned so that an even one and the next make one vector of eight.
template <int n>
struct alignas(64) NodeCube : std::array<NodeLanes, n> {};

template <int D>
struct TileGrid {
  static constexpr int tile_nodes = power(tile_span, D), block_nodes = power(tile_cells, D);
  using Buffer = NodeCube<tile_nodes>;
  using Nodes = std::array<NodeLanes, block_nodes>;

  std::array<Axis, D> axes;
  std::vector<Tile<D>> tiles;
  std::vector<NodeBlock<D>> blocks;
  std::vector<Buffer> sums;    ///< a tile: momentum and mass that its points give
  std::vector<Buffer> forces;  ///< a tile: impulse of the stresses, for FLIP alone
  std::vector<Nodes> v;        ///< a block: velocity and mass
  std::vector<Nodes> dv;       ///< a block: change of velocity in the step, for FLIP alone

  int n_tiles() const { return static_cast<int>(tiles.size()); }
  int n_blocks() const { return static_cast<int>(blocks.size()); }
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

}  // namespace detail

/// Lays the grid under these tiles, sorted by `at`. Velocities of controls that were there are kept.
template <int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip) {
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  std::vector<typename TileGrid<D>::Nodes> v = std::move(grid.v), dv = std::move(grid.dv);
  grid.tiles = std::move(tiles);
  grid.blocks = {};
  detail::join_blocks<D>(grid);
  grid.sums.resize(grid.tiles.size());
  grid.v.assign(grid.blocks.size(), {});
  if (flip) grid.forces.resize(grid.tiles.size()), grid.dv.assign(grid.blocks.size(), {});
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    const int was = detail::find_at<D>(old, grid.blocks[b].at);
    if (was < 0) continue;
    grid.v[b] = v[static_cast<std::size_t>(was)];
    if (flip) grid.dv[b] = dv[static_cast<std::size_t>(was)];
  }
}

/// Copies the blocks of a tile into one cube of controls.
template <int D>
void read_blocks(const Tile<D>& tile, const std::vector<std::array<NodeLanes, power(tile_cells, D)>>& blocks,
                 std::array<NodeLanes, power(tile_span, D)>& cube) {
  for (int k = 0; k < power(2, D); ++k) {
    const auto& block = blocks[static_cast<std::size_t>(tile.block[k])];
    int to = 0;
    for (int d = 0; d < D; ++d) to += corner<D>(k)[d] * tile_cells * stride<D>(tile_span, d);
    for (int row = 0; row < power(tile_cells, D - 1); ++row) {
      int at = to;
      for (int d = D - 2, r = row; d >= 0; --d, r /= tile_cells)
        at += (r % tile_cells) * stride<D>(tile_span, d);
      for (int i = 0; i < tile_cells; ++i) cube[at + i] = block[row * tile_cells + i];
    }
  }
}

/// Sum over the buffers of a block's tiles.
template <int D>
std::array<NodeLanes, power(tile_cells, D)> sum_tiles(
    const NodeBlock<D>& block, const std::vector<NodeCube<power(tile_span, D)>>& buffers) {
  std::array<NodeLanes, power(tile_cells, D)> total{};
  for (int k = 0; k < power(2, D); ++k) {
    if (block.tile[k] < 0) continue;
    const auto& cube = buffers[static_cast<std::size_t>(block.tile[k])];
    int from = 0;
    for (int d = 0; d < D; ++d) from += corner<D>(k)[d] * tile_cells * stride<D>(tile_span, d);
    for (int row = 0; row < power(tile_cells, D - 1); ++row) {
      int at = from;
      for (int d = D - 2, r = row; d >= 0; --d, r /= tile_cells)
        at += (r % tile_cells) * stride<D>(tile_span, d);
      for (int i = 0; i < tile_cells; ++i) total[row * tile_cells + i] += cube[at + i];
    }
  }
  return total;
}

}  // namespace tremie
