#pragma once

// Passes over the explicit grid by all threads, without a wait between their parts.
//
// A block may be done when its tiles are done with the pass before: they have given what it sums up, and no
// longer read its velocities. A tile may be done when its blocks are: they have what it reads, and no longer
// read what it gave. Each thread does its own blocks; tiles, which take ten times as long, are shared out as
// they come.

#include <cassert>
#include <tuple>

#include "libmpm/grid/tiles.hpp"

namespace tremie {

/// What happens in a pass: of_block(block) and of_tile(tile).
template <class OfBlock, class OfTile>
struct GridPass {
  bool blocks_done;  ///< already; only the first of passes in a row can find it so
  OfBlock of_block;
  OfTile of_tile;
};
template <class OfBlock, class OfTile>
GridPass(bool, OfBlock, OfTile) -> GridPass<OfBlock, OfTile>;

namespace detail {

/// Thread s's part of the `number`-th pass in a row.
template <int D, class Pass>
void do_part(TileGrid<D>& grid, int s, std::size_t number, const Pass& pass) {
  assert(number == 0 || !pass.blocks_done);
  const std::int64_t now = grid.passes + static_cast<std::int64_t>(number) + 1;
  const auto do_block = [&](int b) {
    if (number > 0)
      for (const int t : grid.blocks[static_cast<std::size_t>(b)].tile)
        if (t >= 0) grid.tiles_done.wait_for(t, now - 1);
    pass.of_block(b);
    grid.blocks_done.mark(b, now);
  };
  grid.tile_work[number].take(s, [&](int t) {
    const auto& blocks = grid.tiles[static_cast<std::size_t>(t)].block;
    if (!pass.blocks_done) {
      for (const int b : blocks)
        if (grid.block_claims.take(b, now)) do_block(b);
      for (const int b : blocks) grid.blocks_done.wait_for(b, now);
    }
    pass.of_tile(t);
    grid.tiles_done.mark(t, now);
  });
}

}  // namespace detail

/// One pass after the other.
template <int D, class... Passes>
void run_passes(TileGrid<D>& grid, const Passes&... passes) {
  static_assert(sizeof...(passes) <= std::tuple_size_v<decltype(grid.tile_work)>);
  for (SharedWork& work : grid.tile_work) work.start_anew();
  grid.crew->run([&](int s) {
    std::size_t number = 0;
    (detail::do_part(grid, s, number++, passes), ...);
  });
  grid.passes += sizeof...(passes);
}

/// Visits each block.
template <int D, class Visit>
void for_each_block(TileGrid<D>& grid, Visit visit) {
  grid.crew->run([&](int s) { grid.block_work.own(s, visit); });
}

}  // namespace tremie
