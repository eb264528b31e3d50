#pragma once

// The explicit grid laid under its tiles, and who begins with which of them.

#include <omp.h>

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

/// What a pass over a tile costs, in tenths of a group of one cell's points (measured: tests/verification/
/// explicit.md).
template <int D>
std::int64_t cost_of(const Tile<D>& tile) {
  return 15 + 10 * (tile.last_group - tile.first_group) + 6 * tile.mixed_groups;
}

/// Where the runs of n threads begin among the tiles, neighbours together: each takes about as long.
template <int D>
std::vector<int> even_runs(const std::vector<Tile<D>>& tiles, int n) {
  std::int64_t all = 0, so_far = 0;
  for (const Tile<D>& tile : tiles) all += cost_of(tile);
  std::vector<int> begin{0};
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    // A tile is on the side of a border that has its middle.
    const std::int64_t twice_middle = 2 * so_far + cost_of(tiles[t]);
    while (twice_middle * n >= 2 * all * std::ssize(begin)) begin.push_back(static_cast<int>(t));
    so_far += cost_of(tiles[t]);
  }
  begin.resize(static_cast<std::size_t>(n) + 1, static_cast<int>(tiles.size()));
  return begin;
}

/// Sets the pool to the tiles.
template <int D>
void share_out(TileGrid<D>& grid, int n_threads) {
  if (!grid.pool || grid.pool->size() != n_threads) grid.pool = std::make_unique<ThreadPool>(n_threads);
  const std::vector<int> begin = even_runs<D>(grid.tiles, n_threads);
  for (WorkSharing& work : grid.tile_work) work.set_out(begin);
  grid.block_claims.set_out(grid.blocks.size());
  grid.blocks_done.set_out(grid.blocks.size()), grid.tiles_done.set_out(grid.tiles.size());
  grid.passes = 0;
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

/// Lays the grid under these tiles, sorted by `at`, for a pool of n_threads. Velocities of nodes that were
/// there are kept.
template <int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip,
               int n_threads = omp_get_max_threads()) {
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
  detail::share_out<D>(grid, n_threads);
}

}  // namespace tremie
