#pragma once

// Who passes over which tiles: the explicit grid laid under its tiles, in shares of about equal cost.

#include <omp.h>

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
  return 30 + 10 * (tile.last_group - tile.first_group) + 6 * tile.mixed_groups;
}

/// Where the shares' tiles begin, and the end: neighbouring tiles that cost about as much.
template <int D>
std::vector<int> share_out(const std::vector<Tile<D>>& tiles, int n_shares) {
  std::int64_t all = 0, so_far = 0;
  for (const Tile<D>& tile : tiles) all += cost_of(tile);
  std::vector<int> first{0};
  for (std::size_t t = 0; t < tiles.size(); ++t) {
    // A tile is on the side of a border that has its middle.
    const std::int64_t middle = 2 * so_far + cost_of(tiles[t]);
    while (middle * n_shares >= 2 * all * std::ssize(first)) first.push_back(static_cast<int>(t));
    so_far += cost_of(tiles[t]);
  }
  first.resize(static_cast<std::size_t>(n_shares) + 1, static_cast<int>(tiles.size()));
  return first;
}

/// Share number s, of tiles first ... last - 1 and the blocks that they see, numbered in it from here on.
template <int D>
Share<D> take_share(TileGrid<D>& grid, int s, int first, int last, bool flip) {
  Share<D> share{.first_tile = first, .last_tile = last};
  const auto each_block = [&](auto visit) {
    for (int t = share.first_tile; t < share.last_tile; ++t)
      for (int& b : grid.tiles[static_cast<std::size_t>(t)].block) visit(b);
  };
  each_block([&](int b) { share.blocks.push_back(b); });
  std::sort(share.blocks.begin(), share.blocks.end());
  share.blocks.erase(std::unique(share.blocks.begin(), share.blocks.end()), share.blocks.end());
  std::vector<int> in_share(grid.blocks.size());
  for (std::size_t i = 0; i < share.blocks.size(); ++i) {
    const auto b = static_cast<std::size_t>(share.blocks[i]);
    in_share[b] = static_cast<int>(i);
    if (grid.blocks[b].share < 0) grid.blocks[b].share = s, grid.blocks[b].in_share = in_share[b];
  }
  each_block([&](int& b) { b = in_share[static_cast<std::size_t>(b)]; });
  share.v.assign(share.blocks.size(), {});
  if (flip) share.v_start.assign(share.blocks.size(), {});
  return share;
}

/// Gives every tile its buffer, and a second one to those whose sums another share reads.
template <int D>
void give_buffers(TileGrid<D>& grid, bool flip) {
  std::vector<char> at_border(grid.tiles.size(), 0);
  for (std::size_t s = 0; s < grid.shares.size(); ++s)
    for (const int b : grid.shares[s].blocks)
      for (const int t : grid.blocks[static_cast<std::size_t>(b)].tile)
        if (t >= 0 && (t < grid.shares[s].first_tile || t >= grid.shares[s].last_tile))
          at_border[static_cast<std::size_t>(t)] = 1;
  int n = 0;
  for (std::size_t t = 0; t < grid.tiles.size(); ++t) {
    auto& buffer = grid.tiles[t].buffer;
    buffer[0] = n++;
    buffer[1] = at_border[t] != 0 ? n++ : buffer[0];
  }
  grid.sums.resize(static_cast<std::size_t>(n));
  grid.rows.assign(static_cast<std::size_t>(n), all_rows<D>);
  if (flip) grid.forces.resize(static_cast<std::size_t>(n));
}

/// Velocities of the controls that were there before.
template <int D>
void keep_velocities(const std::vector<NodeBlock<D>>& old, const std::vector<Share<D>>& from,
                     const TileGrid<D>& grid, Share<D>& share) {
  for (std::size_t i = 0; i < share.blocks.size(); ++i) {
    const int was = find_at<D>(old, grid.blocks[static_cast<std::size_t>(share.blocks[i])].at);
    if (was < 0) continue;
    const NodeBlock<D>& block = old[static_cast<std::size_t>(was)];
    const auto s = static_cast<std::size_t>(block.share), b = static_cast<std::size_t>(block.in_share);
    share.v[i] = from[s].v[b];
    if (!share.v_start.empty()) share.v_start[i] = from[s].v_start[b];
  }
}

}  // namespace detail

/// Lays the grid under these tiles, sorted by `at`, in as many shares as there are threads. Velocities of
/// controls that were there are kept.
template <int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip,
               int n_shares = omp_get_max_threads()) {
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  const std::vector<Share<D>> from = std::move(grid.shares);
  grid.tiles = std::move(tiles);
  grid.blocks = {}, grid.shares = {};
  detail::join_blocks<D>(grid);
  const std::vector<int> first = detail::share_out<D>(grid.tiles, n_shares);
  for (int s = 0; s < n_shares; ++s) {
    const auto at = static_cast<std::size_t>(s);
    grid.shares.push_back(detail::take_share<D>(grid, s, first[at], first[at + 1], flip));
    detail::keep_velocities<D>(old, from, grid, grid.shares.back());
  }
  detail::give_buffers<D>(grid, flip);
}

/// Visits each share, in a thread of its own.
template <int D, class Visit>
void for_each_share(TileGrid<D>& grid, Visit visit) {
#pragma omp parallel for schedule(static, 1)
  for (std::size_t s = 0; s < grid.shares.size(); ++s) visit(grid.shares[s]);
}

/// The share that a tile is in.
template <int D>
const Share<D>& share_of(const TileGrid<D>& grid, int tile) {
  return *std::partition_point(grid.shares.begin(), grid.shares.end(),
                               [&](const Share<D>& share) { return share.last_tile <= tile; });
}

/// Block b of a share where the first share that sees it has it.
template <int D>
BlockNodes<D>& first_nodes(TileGrid<D>& grid, const Share<D>& share, int b) {
  const NodeBlock<D>& block =
      grid.blocks[static_cast<std::size_t>(share.blocks[static_cast<std::size_t>(b)])];
  return grid.shares[static_cast<std::size_t>(block.share)].v[static_cast<std::size_t>(block.in_share)];
}

/// Velocities of blocks that more than one share sees, where they were changed in the first of them.
template <int D>
void hand_on_velocities(TileGrid<D>& grid) {
  for (Share<D>& share : grid.shares)
    for (std::size_t b = 0; b < share.blocks.size(); ++b) {
      const BlockNodes<D>& first = first_nodes(grid, share, static_cast<int>(b));
      if (&first != &share.v[b]) share.v[b] = first;
    }
}

}  // namespace tremie
