#pragma once

// Passes over the explicit grid by all threads, without a wait between their parts.
//
// A block may be done when its tiles are done with the pass before: they have given what it sums up, and no
// longer read its velocities. A tile may be done when its blocks are: they have what it reads, and no longer
// read what it gave. Tiles are shared out as they come. The blocks of a tile that nobody has begun with are
// done by whoever comes to it: of two threads each asks last for what lies at their border, when the other is
// done with it as well.

#include <cassert>

#include "libmpm/grid/tiles.hpp"

namespace tremie {

/// What happens in a pass: of_block(block, time) and of_tile(tile, time), where passes follow each other
/// several times over.
template <class OfBlock, class OfTile>
struct GridPass {
  bool blocks_done;  ///< already; only the first of passes that follow each other once can find it so
  OfBlock of_block;
  OfTile of_tile;
};
template <class OfBlock, class OfTile>
GridPass(bool, OfBlock, OfTile) -> GridPass<OfBlock, OfTile>;

namespace detail {

/// Thread s's part of a pass, the `number`-th in a row.
template <int D, class Pass>
void do_part(TileGrid<D>& grid, int s, std::size_t number, int time, const Pass& pass) {
  assert(number == 0 || !pass.blocks_done);
  const std::int64_t now = grid.passes + static_cast<std::int64_t>(number) + 1;
  // Whoever takes a block has waited for its tiles first: by then it is done with the pass before, too.
  const auto come_to_block = [&](int b) {
    if (grid.block_claims.taken(b, now)) return;
    if (number > 0)
      for (const int t : grid.blocks[static_cast<std::size_t>(b)].tile)
        if (t >= 0) grid.tiles_done.wait_for(t, now - 1);
    if (!grid.block_claims.take(b, now)) return;
    pass.of_block(b, time);
    grid.blocks_done.mark(b, now);
  };
  grid.tile_work[number].take(s, [&](int t) {
    const auto& blocks = grid.tiles[static_cast<std::size_t>(t)].block;
    if (!pass.blocks_done) {
      for (const int b : blocks) come_to_block(b);
      for (const int b : blocks) grid.blocks_done.wait_for(b, now);
    }
    pass.of_tile(t, time);
    grid.tiles_done.mark(t, now);
  });
}

}  // namespace detail

/// One pass after the other, `times` over: at most most_times.
template <int D, class... Passes>
void repeat_passes(TileGrid<D>& grid, int times, const Passes&... passes) {
  static_assert(sizeof...(passes) <= TileGrid<D>::passes_in_a_step);
  assert(times <= TileGrid<D>::most_times);
  const std::size_t n = static_cast<std::size_t>(times) * sizeof...(passes);
  for (std::size_t i = 0; i < n; ++i) grid.tile_work[i].start_anew();
  grid.pool->run([&](int s) {
    std::size_t number = 0;
    for (int time = 0; time < times; ++time) (detail::do_part(grid, s, number++, time, passes), ...);
  });
  grid.passes += static_cast<std::int64_t>(n);
}
template <int D, class... Passes>
void run_passes(TileGrid<D>& grid, const Passes&... passes) {
  repeat_passes(grid, 1, passes...);
}

/// Visits each block; each thread has as many of them.
template <int D, class Visit>
void for_each_block(TileGrid<D>& grid, Visit visit) {
  const std::int64_t n = std::ssize(grid.blocks), threads = grid.pool->size();
  grid.pool->run([&](int s) {
    for (std::int64_t b = n * s / threads; b < n * (s + 1) / threads; ++b) visit(static_cast<int>(b));
  });
}

}  // namespace tremie
