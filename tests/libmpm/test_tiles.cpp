// The tiles of the explicit grid: rows of controls and what each thread has.

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
  lay_tiles<D>(grid, tiles, false);
  return grid;
}

/// Every row of a tile's cube is a row of those of its blocks that lie beside each other along it, and of no
/// other: blocks of four controls, two a direction.
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
  cube.fill(NodeLanes{} + 1.0);
  clear_rows<2>(all_rows<2> & ~TileRows{1}, cube);
  for (int i = 0; i < TileGrid<2>::tile_nodes; ++i) EXPECT_EQ(cube[i][0], i < tile_span ? 1.0 : 0.0);
}

// Each tile and block is somebody's, once; no thread has more than its share and one tile.
TEST(Tiles, ThreadsShareThemAll) {
  for (const int n : {0, 1, 2, 7, 40}) {
    const TileGrid<3> grid = row_of_tiles<3>(n);
    for (const int threads : {1, 2, 3, 16}) {
      EXPECT_EQ(first_tile_of(grid, 0, threads), 0);
      EXPECT_EQ(first_block_of(grid, 0, threads), 0);
      EXPECT_EQ(first_tile_of(grid, threads, threads), grid.n_tiles());
      EXPECT_EQ(first_block_of(grid, threads, threads), grid.n_blocks());
      for (int t = 0; t < threads; ++t) {
        EXPECT_LE(first_tile_of(grid, t, threads), first_tile_of(grid, t + 1, threads));
        EXPECT_LE(first_block_of(grid, t, threads), first_block_of(grid, t + 1, threads));
      }
    }
    if (n != 40) continue;
    // 780 groups and 8 a tile for its arrays: 1100 in all, 47 of them the last tile's.
    const int half = first_tile_of(grid, 1, 2);
    EXPECT_NEAR(grid.tiles[static_cast<std::size_t>(half)].first_group + 8 * half, 550, 47);
  }
}

}  // namespace
}  // namespace tremie
