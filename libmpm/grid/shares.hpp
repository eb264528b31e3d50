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
  return 15 + 10 * (tile.last_group - tile.first_group) + 6 * tile.mixed_groups;
}

/// Shares of neighbouring tiles that cost about as much.
template <int D>
void cut_into_shares(std::vector<Tile<D>>& tiles, int n_shares) {
  std::int64_t all = 0, so_far = 0;
  for (const Tile<D>& tile : tiles) all += cost_of(tile);
  int share = 0;
  for (Tile<D>& tile : tiles) {
    // A tile is on the side of a border that has its middle.
    const std::int64_t middle = 2 * so_far + cost_of(tile);
    while (middle * n_shares >= 2 * all * (share + 1)) ++share;
    tile.share = share;
    so_far += cost_of(tile);
  }
}

/// How many tiles on either side of a border may change it.
inline constexpr int border_tiles = 8;
/// What an exchange must gain, for the longer border that it makes.
inline constexpr std::int64_t border_cost = 60;

/// Moves a tile across the border of shares s and s + 1, or exchanges two, if that makes their costs more
/// even: a border between two tiles leaves up to one tile's cost between them.
template <int D>
void make_even(std::vector<Tile<D>>& tiles, int s) {
  std::int64_t more = 0;  // what s costs more
  std::vector<Tile<D>*> before, behind;
  for (Tile<D>& tile : tiles) {
    if (tile.share == s) before.push_back(&tile), more += cost_of(tile);
    if (tile.share == s + 1) behind.push_back(&tile), more -= cost_of(tile);
  }
  before.erase(before.begin(), before.end() - std::min<std::ptrdiff_t>(border_tiles, std::ssize(before)));
  behind.resize(std::min<std::size_t>(border_tiles, behind.size()));
  before.push_back(nullptr), behind.push_back(nullptr);
  Tile<D>*give = nullptr, *take = nullptr;
  std::int64_t least = std::abs(more) - border_cost;
  for (Tile<D>* a : before)
    for (Tile<D>* b : behind) {
      const std::int64_t left = std::abs(more - 2 * (a ? cost_of(*a) : 0) + 2 * (b ? cost_of(*b) : 0));
      if (left < least) least = left, give = a, take = b;
    }
  if (give) give->share = s + 1;
  if (take) take->share = s;
}

template <int D>
void share_out(std::vector<Tile<D>>& tiles, int n_shares) {
  cut_into_shares<D>(tiles, n_shares);
  for (int s = 0; s + 1 < n_shares; ++s) make_even<D>(tiles, s);
}

/// Share number s: its tiles and the blocks that they see, numbered in it from here on.
template <int D>
Share<D> take_share(TileGrid<D>& grid, int s, bool flip) {
  Share<D> share;
  for (int t = 0; t < grid.n_tiles(); ++t)
    if (grid.tiles[static_cast<std::size_t>(t)].share == s) share.tiles.push_back(t);
  const auto each_block = [&](auto visit) {
    for (const int t : share.tiles)
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
        if (t >= 0 && grid.tiles[static_cast<std::size_t>(t)].share != static_cast<int>(s))
          at_border[static_cast<std::size_t>(t)] = 1;
  int n = 0;
  for (std::size_t t = 0; t < grid.tiles.size(); ++t) {
    auto& buffer = grid.tiles[t].buffer;
    buffer[0] = n++;
    buffer[1] = at_border[t] != 0 ? n++ : buffer[0];
  }
  if (grid.single)
    grid.single_sums.resize(static_cast<std::size_t>(n));
  else
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
  detail::share_out<D>(grid.tiles, n_shares);
  for (int s = 0; s < n_shares; ++s) {
    grid.shares.push_back(detail::take_share<D>(grid, s, flip));
    detail::keep_velocities<D>(old, from, grid, grid.shares.back());
  }
  detail::give_buffers<D>(grid, flip);
  if (!grid.crew || grid.crew->size() != n_shares) grid.crew = std::make_unique<Crew>(n_shares);
}

/// Visits each share, in a thread of its own.
template <int D, class Visit>
void for_each_share(TileGrid<D>& grid, Visit visit) {
  grid.crew->run([&](int s) { visit(grid.shares[static_cast<std::size_t>(s)]); });
}

/// The share that a tile is in.
template <int D>
const Share<D>& share_of(const TileGrid<D>& grid, int tile) {
  return grid.shares[static_cast<std::size_t>(grid.tiles[static_cast<std::size_t>(tile)].share)];
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
