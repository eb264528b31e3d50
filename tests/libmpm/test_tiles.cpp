// The tiles of the explicit grid: rows of nodes, and who sees whom.

#include <gtest/gtest.h>

#include "libmpm/grid/tiles.hpp"

namespace tremie {
namespace {

/// A row of tiles, the t-th with t groups more than the one before it.
template <int D>
TileGrid<D> row_of_tiles(int n) {
  TileGrid<D> grid;
  for (Axis& axis : grid.axes) axis = {.n_cells = 64};
  std::vector<Tile<D>> tiles;
  for (int t = 0, groups = 0; t < n; ++t) {
    Tile<D> tile{.first_group = groups, .last_group = groups + t};
    tile.at[0] = t;
    groups += t;
    tiles.push_back(tile);
  }
  lay_tiles<double, D>(grid, tiles, false);
  return grid;
}

// Every row of a tile's cube is made up of rows of its blocks: blocks of four nodes, two a direction.
template <int D>
void expect_rows_in_blocks() {
  std::vector<int> begins;
  for (int k = 0; k < power(2, D); ++k)
    for (int row = 0; row < power(tile_cells, D - 1); ++row) begins.push_back(row_in_cube<D>(k, row));
  std::sort(begins.begin(), begins.end());
  for (std::size_t i = 0; i < begins.size(); ++i) EXPECT_EQ(begins[i], static_cast<int>(i) * tile_cells);
  EXPECT_EQ(begins.size() * tile_cells, power(tile_span, D));
}

TEST(Tiles, RowsLieInTheirBlocks) {
  expect_rows_in_blocks<2>();
  expect_rows_in_blocks<3>();
}

TEST(Tiles, EachTileFindsItsBlocksAndEachBlockItsTiles) {
  const TileGrid<3> grid = row_of_tiles<3>(7);
  EXPECT_EQ(grid.blocks.size(), 4 * 8);  // one more than tiles along the row, two in the other directions
  for (int t = 0; t < grid.n_tiles(); ++t)
    for (int k = 0; k < 8; ++k) {
      const Tile<3>& tile = grid.tiles[static_cast<std::size_t>(t)];
      const NodeBlock<3>& block =
          grid.blocks[static_cast<std::size_t>(tile.block[static_cast<std::size_t>(k)])];
      for (int d = 0; d < 3; ++d) EXPECT_EQ(block.at[d], tile.at[d] + corner<3>(k)[d]);
      EXPECT_EQ(block.tile[static_cast<std::size_t>(k)], t);
    }
}

// Block 9 is the last that tile 8 sees and the first that tile 9 sees.
TEST(Tiles, VelocitiesAreKept) {
  TileGrid<3> grid = row_of_tiles<3>(10);
  const auto block_9 = [&]() -> f64x4& {
    return grid.v[static_cast<std::size_t>(grid.tiles.back().block[0])][7];
  };
  block_9() = f64x4{1.0, 2.0, 3.0, 4.0};
  lay_tiles<double, 3>(grid, std::vector<Tile<3>>(grid.tiles.begin() + 4, grid.tiles.end()), false);
  EXPECT_EQ(grid.v.size(), 4 * 7);
  EXPECT_EQ(block_9()[2], 3.0);
  EXPECT_EQ(grid.v[static_cast<std::size_t>(grid.tiles[4].block[0])][7][2], 0.0);
}

}  // namespace
}  // namespace tremie
