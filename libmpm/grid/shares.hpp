#pragma once

// Who passes over which tiles: the explicit grid laid under its tiles, in shares that take about as long and
// have short borders.

#include <omp.h>

#include <chrono>

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

/// Shares of neighbouring tiles that take about as long. pace[s]: what thread s does in a given time, against
/// their mean.
template <int D>
void cut_into_shares(std::vector<Tile<D>>& tiles, const std::vector<double>& pace) {
  double all = 0.0, so_far = 0.0, upto = 0.0, paces = 0.0;
  for (const Tile<D>& tile : tiles) all += static_cast<double>(cost_of(tile));
  for (const double one : pace) paces += one;
  std::size_t share = 0;
  for (Tile<D>& tile : tiles) {
    // A tile is on the side of a border that has its middle.
    const auto cost = static_cast<double>(cost_of(tile));
    const double middle = (so_far + 0.5 * cost) / all * paces;
    while (share + 1 < pace.size() && middle >= upto + pace[share]) upto += pace[share++];
    tile.share = static_cast<int>(share);
    so_far += cost;
  }
}

/// What a block costs that two shares see, in the units of cost_of: each sums it up, from the other core's
/// cache.
inline constexpr double border_block_cost = 12.0;
/// How many tiles on either side of a border are looked at.
inline constexpr std::size_t border_tiles = 12;

/// The border between shares s and s + 1, for moving tiles across it.
template <int D>
class Border {
 public:
  Border(TileGrid<D>& grid, int s)
      : grid_(grid),
        s_(s),
        slow_{1.0 / grid.pace[static_cast<std::size_t>(s)],
              1.0 / grid.pace[static_cast<std::size_t>(s) + 1]} {
    for (int t = 0; t < grid.n_tiles(); ++t) {
      const int side = side_of(t);
      if (side >= 0) more_ += (side == 0 ? slow_[0] : -slow_[1]) * cost(t);
    }
  }

  /// Moves the tile or exchanges the two that make a round of both shares shortest; false if none does.
  bool improve() {
    auto [before, behind] = tiles_at_border();
    before.push_back(-1), behind.push_back(-1);
    double best = -1.0;
    int give = -1, take = -1;
    for (const int a : before)
      for (const int b : behind)
        if (const double change = change_by(a, b); change < best) best = change, give = a, take = b;
    if (give < 0 && take < 0) return false;
    more_ = more_after(give, take);
    exchange(give, take);
    return true;
  }

 private:
  Tile<D>& tile(int t) const { return grid_.tiles[static_cast<std::size_t>(t)]; }
  double cost(int t) const { return t < 0 ? 0.0 : static_cast<double>(cost_of(tile(t))); }
  /// 0: in share s; 1: in s + 1; else -1.
  int side_of(int t) const {
    const int share = tile(t).share;
    return share == s_ ? 0 : share == s_ + 1 ? 1 : -1;
  }

  /// Whether both shares see a block.
  bool shared(int block) const {
    bool seen[2] = {false, false};
    for (const int t : grid_.blocks[static_cast<std::size_t>(block)].tile)
      if (t >= 0 && side_of(t) >= 0) seen[side_of(t)] = true;
    return seen[0] && seen[1];
  }

  std::array<std::vector<int>, 2> tiles_at_border() const {
    std::array<std::vector<int>, 2> at;
    for (int t = 0; t < grid_.n_tiles(); ++t) {
      const int side = side_of(t);
      if (side < 0 || at[static_cast<std::size_t>(side)].size() == border_tiles) continue;
      const auto& blocks = tile(t).block;
      if (std::any_of(blocks.begin(), blocks.end(), [&](int b) { return shared(b); }))
        at[static_cast<std::size_t>(side)].push_back(t);
    }
    return at;
  }

  double more_after(int give, int take) const {
    return more_ - (slow_[0] + slow_[1]) * (cost(give) - cost(take));
  }

  int shared_around(int give, int take) const {
    int n = 0;
    for (const int t : {give, take})
      for (std::size_t k = 0; t >= 0 && k < tile(t).block.size(); ++k) n += shared(tile(t).block[k]) ? 1 : 0;
    return n;
  }

  void exchange(int give, int take) {
    if (give >= 0) tile(give).share = s_ + 1;
    if (take >= 0) tile(take).share = s_;
  }

  /// Of the slower share's time, by what it has to do and by the border. Blocks of both tiles count twice.
  double change_by(int give, int take) {
    const int before = shared_around(give, take);
    exchange(give, take);
    const int after = shared_around(give, take);
    if (give >= 0) tile(give).share = s_;
    if (take >= 0) tile(take).share = s_ + 1;
    return 0.5 * (std::abs(more_after(give, take)) - std::abs(more_)) + border_block_cost * (after - before);
  }

  TileGrid<D>& grid_;
  int s_;
  double slow_[2], more_ = 0.0;  ///< time for a unit of cost; what share s takes more
};

/// Cuts the tiles into shares, and then moves tiles across each border: a cut between two tiles leaves up to
/// one tile between the shares, and may be longer than it needs to be. Among hundreds of tiles that is
/// nothing.
template <int D>
void share_out(TileGrid<D>& grid) {
  cut_into_shares<D>(grid.tiles, grid.pace);
  constexpr int most_moves = 20, many_tiles = 200;  // of a share
  const auto n_shares = static_cast<int>(grid.pace.size());
  if (grid.n_tiles() > many_tiles * n_shares) return;
  for (int s = 0; s + 1 < n_shares; ++s) {
    Border<D> border(grid, s);
    for (int moves = 0; moves < most_moves && border.improve(); ++moves) continue;
  }
}

/// Rounds before the paces say anything, how much of a new one counts, and how far one may be from the mean:
/// another program may have had the core for some of them.
inline constexpr int least_rounds = 20;
inline constexpr double new_pace = 0.3, least_pace = 0.7;

/// How fast the threads have been with the shares that they have: one starts later than the other, or has a
/// core that others use too.
template <int D>
void measure_paces(TileGrid<D>& grid, int n_shares) {
  std::vector<double>& pace = grid.pace;
  if (std::ssize(pace) != n_shares) pace.assign(static_cast<std::size_t>(n_shares), 1.0);
  if (std::ssize(grid.shares) != n_shares || grid.shares[0].rounds < least_rounds) return;
  std::vector<double> now;
  double mean = 0.0;
  for (const Share<D>& share : grid.shares) {
    if (share.tiles.empty() || !(share.busy > 0.0)) return;
    double cost = 0.0;
    for (const int t : share.tiles)
      cost += static_cast<double>(cost_of(grid.tiles[static_cast<std::size_t>(t)]));
    now.push_back(cost / share.busy);
    mean += now.back() / n_shares;
  }
  for (std::size_t s = 0; s < now.size(); ++s) {
    const double seen = std::clamp(now[s] / mean, least_pace, 2.0 - least_pace);
    pace[s] += new_pace * (seen - pace[s]);
  }
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
  detail::measure_paces(grid, n_shares);
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  const std::vector<Share<D>> from = std::move(grid.shares);
  grid.tiles = std::move(tiles);
  grid.blocks = {}, grid.shares = {};
  detail::join_blocks<D>(grid);
  detail::share_out<D>(grid);
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
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  grid.crew->run([&](int s) {
    Share<D>& share = grid.shares[static_cast<std::size_t>(s)];
    visit(share);
    share.busy += std::chrono::duration<double>(Clock::now() - start).count();
    ++share.rounds;
  });
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
