#pragma once

// The explicit grid laid under its tiles.

#include <algorithm>

#include "libmpm/grid/tiles.hpp"

namespace tremie {

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
    if (const int was = find_at<D>(old, blocks[b].at); was >= 0) now[b] = v[static_cast<std::size_t>(was)];
  return now;
}

}  // namespace detail

/// Lays the grid under these tiles, sorted by `at`. Velocities of nodes that were there are kept.
template <int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip) {
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  grid.tiles = std::move(tiles);
  grid.blocks = {};
  detail::join_blocks<D>(grid);
  grid.v = detail::kept<D>(old, grid.v, grid.blocks);
  if (flip) grid.v_start = detail::kept<D>(old, grid.v_start, grid.blocks);
  const std::size_t n = grid.tiles.size();
  grid.single ? grid.single_sums.resize(n) : grid.sums.resize(n);
  if (flip) grid.forces.resize(n);
  grid.rows.assign(n, all_rows<D>);
}

}  // namespace tremie
