// The tiles of the explicit grid: rows of nodes, and who sees whom.

#include <gtest/gtest.h>

#include "libmpm/explicit/tile_layout.hpp"

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
  lay_tiles<D>(grid, tiles, false);
  return grid;
}

/// Every row of a tile's cube is a row of those of its blocks that lie beside each other along it, and of no
/// other: blocks of four nodes, two a direction.
template <int D>
void expect_rows_in_blocks() {
  constexpr int n_rows = power(tile_span, D - 1);
  for (int row = 0; row < n_rows; ++row) {
    std::vector<int> begins;
    for (int k = 0; k < power(2, D); ++k) {
      const unsigned in_block = rows_of_block<D>(TileRows{1} << row, k);
      for_each_row(in_block, [&](int r) { begins.push_back(row_in_cube<D>(k, r)); });
    }
    EXPECT_EQ(begins, (std::vector<int>{row * tile_span, row * tile_span + tile_cells}));
  }
}

TEST(Tiles, RowsLieInTheirBlocks) {
  expect_rows_in_blocks<2>();
  expect_rows_in_blocks<3>();
}

TEST(Tiles, AStencilReachesThreeRowsADirection) {
  EXPECT_EQ(stencil_rows<2>(5 * tile_span + 3), TileRows{7} << 5);
  const TileRows rows = stencil_rows<3>((5 * tile_span + 5) * tile_span + 5);  // the last there is
  std::vector<int> at;
  for_each_row(rows, [&](int row) { at.push_back(row); });
  EXPECT_EQ(at, (std::vector<int>{45, 46, 47, 53, 54, 55, 61, 62, 63}));
}

TEST(Tiles, OnlyTheRowsThatAreMeantAreCleared) {
  TileGrid<2>::Buffer cube;
  cube.fill(f64x4{} + 1.0);
  clear_rows(all_rows<2> & ~TileRows{1}, cube);
  for (int i = 0; i < TileGrid<2>::tile_nodes; ++i) EXPECT_EQ(cube[i][0], i < tile_span ? 1.0 : 0.0);
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
  lay_tiles<3>(grid, std::vector<Tile<3>>(grid.tiles.begin() + 4, grid.tiles.end()), false);
  EXPECT_EQ(grid.v.size(), 4 * 7);
  EXPECT_EQ(block_9()[2], 3.0);
  EXPECT_EQ(grid.v[static_cast<std::size_t>(grid.tiles[4].block[0])][7][2], 0.0);
}

}  // namespace
}  // namespace tremie
