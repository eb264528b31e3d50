#pragma once

// Passes over the explicit grid by all threads. The blocks write velocities that only they have, and the
// tiles sums that only they have: what is done does not depend on the order or on the number of threads.

#include "libmpm/grid/tiles.hpp"

namespace tremie {

/// visit(block) for each block.
template <int D, class Visit>
void for_each_block(TileGrid<D>& grid, Visit visit) {
  const std::size_t n = grid.blocks.size();
#pragma omp parallel for schedule(static)
  for (std::size_t b = 0; b < n; ++b) visit(b);
}

/// visit(tile) for each tile. Tiles hold unequal numbers of points: threads take them as they come.
template <int D, class Visit>
void for_each_tile(TileGrid<D>& grid, Visit visit) {
  const std::size_t n = grid.tiles.size();
#pragma omp parallel for schedule(dynamic)
  for (std::size_t t = 0; t < n; ++t) visit(t);
}

}  // namespace tremie
