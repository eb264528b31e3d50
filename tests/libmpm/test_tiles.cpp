// The tiles of the explicit grid: rows of controls and what each thread shares in.

#include <gtest/gtest.h>

#include "libmpm/grid/shares.hpp"

namespace tremie {
namespace {

/// A row of tiles, the t-th with t groups more than the one before it.
template <int D>
TileGrid<D> row_of_tiles(int n, int n_shares) {
  TileGrid<D> grid;
  for (Axis& axis : grid.axes) axis = {.n_cells = 64};
  std::vector<Tile<D>> tiles;
  for (int t = 0, groups = 0; t < n; ++t) {
    Tile<D> tile{.first_group = groups, .last_group = groups + t};
    tile.at[0] = t;
    groups += t;
    tiles.push_back(tile);
  }
  lay_tiles<D>(grid, tiles, false, n_shares);
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
  clear_rows(all_rows<2> & ~TileRows{1}, cube);
  for (int i = 0; i < TileGrid<2>::tile_nodes; ++i) EXPECT_EQ(cube[i][0], i < tile_span ? 1.0 : 0.0);
}

/// Each tile is in one share, and finds in it the blocks that it sees.
void expect_shared_out(const TileGrid<3>& grid) {
  std::vector<int> all;
  for (const Share<3>& share : grid.shares) {
    EXPECT_TRUE(std::is_sorted(share.tiles.begin(), share.tiles.end()));
    EXPECT_EQ(share.v.size(), share.blocks.size());
    all.insert(all.end(), share.tiles.begin(), share.tiles.end());
  }
  std::sort(all.begin(), all.end());
  ASSERT_EQ(std::ssize(all), grid.n_tiles());
  for (int t = 0; t < grid.n_tiles(); ++t) {
    EXPECT_EQ(all[static_cast<std::size_t>(t)], t);
    const Tile<3>& tile = grid.tiles[static_cast<std::size_t>(t)];
    const Share<3>& share = share_of(grid, t);
    EXPECT_EQ(std::count(share.tiles.begin(), share.tiles.end(), t), 1);
    for (int k = 0; k < 8; ++k) {
      const auto in_share = static_cast<std::size_t>(tile.block[static_cast<std::size_t>(k)]);
      const auto& at = grid.blocks[static_cast<std::size_t>(share.blocks[in_share])].at;
      for (int d = 0; d < 3; ++d) EXPECT_EQ(at[d], tile.at[d] + corner<3>(k)[d]);
    }
  }
}

TEST(Tiles, SharesAreOfAllTiles) {
  for (const int n : {0, 1, 2, 7, 40})
    for (const int shares : {1, 2, 3, 16}) {
      const TileGrid<3> grid = row_of_tiles<3>(n, shares);
      EXPECT_EQ(std::ssize(grid.shares), shares);
      expect_shared_out(grid);
    }
}

std::int64_t cost_of_share(const TileGrid<3>& grid, int s) {
  std::int64_t cost = 0;
  for (const int t : grid.shares[static_cast<std::size_t>(s)].tiles)
    cost += detail::cost_of(grid.tiles[static_cast<std::size_t>(t)]);
  return cost;
}

// 780 groups of 10 and 30 a tile: 9000 in all. A cut between two tiles leaves up to half of one on either
// side, and where tiles rise in size along the row no exchange makes that less: the last one costs 420.
TEST(Tiles, SharesCostAboutAsMuch) {
  EXPECT_NEAR(static_cast<double>(cost_of_share(row_of_tiles<3>(40, 2), 0)), 4200.0, 203.0);
}

/// A sheet of tiles, n by n, with these groups in each, row by row.
TileGrid<3> sheet_of_tiles(int n, const std::vector<int>& groups, int n_shares) {
  TileGrid<3> grid;
  for (Axis& axis : grid.axes) axis = {.n_cells = 64};
  std::vector<Tile<3>> tiles;
  int first = 0;
  for (const int of_tile : groups) {
    const auto t = static_cast<int>(tiles.size());
    tiles.push_back({.at = {t / n, t % n, 0}, .first_group = first, .last_group = first + of_tile});
    first += of_tile;
  }
  lay_tiles<3>(grid, tiles, false, n_shares);
  return grid;
}

// Eight tiles of 115 and one of 415 in the middle: a cut between two tiles leaves 460 and 875.
TEST(Tiles, TilesMovedAcrossTheBorderMakeSharesMoreEven) {
  const TileGrid<3> grid = sheet_of_tiles(3, {10, 10, 10, 10, 40, 10, 10, 10, 10}, 2);
  EXPECT_EQ(cost_of_share(grid, 0) + cost_of_share(grid, 1), 1335);
  EXPECT_LE(std::abs(cost_of_share(grid, 0) - cost_of_share(grid, 1)), 200);
  expect_shared_out(grid);
}

// Equal tiles: half of a square on either side of a straight border, which no other is shorter than.
TEST(Tiles, AStraightBorderStays) {
  const TileGrid<3> grid = sheet_of_tiles(6, std::vector<int>(36, 20), 2);
  for (const Tile<3>& tile : grid.tiles) EXPECT_EQ(tile.share, tile.at[0] < 3 ? 0 : 1);
}

// Three quarters of the cost for a thread that is three times as fast; up to half a tile is left.
TEST(Tiles, FasterThreadsHaveMoreToDo) {
  TileGrid<3> grid = row_of_tiles<3>(0, 2);
  grid.pace = {1.5, 0.5};
  std::vector<Tile<3>> tiles;
  for (int t = 0; t < 40; ++t) {
    tiles.push_back({.first_group = 10 * t, .last_group = 10 * t + 10});
    tiles.back().at[0] = t;
  }
  lay_tiles<3>(grid, tiles, false, 2);
  EXPECT_NEAR(static_cast<double>(cost_of_share(grid, 0)), 0.75 * 40 * 115, 58.0);
  // The same time for both shows that the paces were right; twice as long for one, that it is slower.
  for (Share<3>& share : grid.shares) share.busy = 1.0, share.rounds = 100;
  lay_tiles<3>(grid, std::vector<Tile<3>>(grid.tiles), false, 2);
  EXPECT_GT(grid.pace[0], 1.4);
  EXPECT_LT(grid.pace[1], 0.6);
}

// In a row of tiles those beside a tile of another share see common blocks with it.
TEST(Tiles, TilesAtABorderHaveTwoBuffers) {
  const TileGrid<3> grid = row_of_tiles<3>(10, 3);
  std::vector<int> two, at_border;
  std::vector<int> buffers;
  const auto share = [&](int t) { return grid.tiles[static_cast<std::size_t>(t)].share; };
  for (int t = 0; t < 10; ++t) {
    if ((t > 0 && share(t - 1) != share(t)) || (t < 9 && share(t + 1) != share(t))) at_border.push_back(t);
    const auto& buffer = grid.tiles[static_cast<std::size_t>(t)].buffer;
    buffers.push_back(buffer[0]);
    if (buffer[0] == buffer[1]) continue;
    two.push_back(t), buffers.push_back(buffer[1]);
  }
  EXPECT_FALSE(two.empty());
  EXPECT_EQ(two, at_border);
  for (int i = 0; i < std::ssize(buffers); ++i) EXPECT_EQ(buffers[static_cast<std::size_t>(i)], i);
  EXPECT_EQ(grid.sums.size(), buffers.size());
}

// Block 9 is the last that tile 8 sees and the first that tile 9 sees.
TEST(Tiles, VelocitiesAreHandedOnAndKept) {
  TileGrid<3> grid = row_of_tiles<3>(10, 10);
  const auto block_9 = [&](int tile, int k) -> NodeLanes& {
    auto& share = grid.shares[static_cast<std::size_t>(&share_of(grid, tile) - grid.shares.data())];
    const Tile<3>& of = grid.tiles[static_cast<std::size_t>(tile)];
    return share.v[static_cast<std::size_t>(of.block[static_cast<std::size_t>(k)])][7];
  };
  ASSERT_NE(&share_of(grid, 8), &share_of(grid, 9));
  first_nodes(grid, share_of(grid, 9), grid.tiles[9].block[0])[7] = NodeLanes{1.0, 2.0, 3.0, 4.0};
  EXPECT_EQ(block_9(8, 4)[2], 3.0);  // the first share that sees it is tile 8's
  EXPECT_EQ(block_9(9, 0)[2], 0.0);
  hand_on_velocities(grid);
  EXPECT_EQ(block_9(9, 0)[2], 3.0);
  lay_tiles<3>(grid, std::vector<Tile<3>>(grid.tiles), false, 2);
  EXPECT_EQ(block_9(8, 4)[2], 3.0);
  EXPECT_EQ(block_9(9, 0)[2], 3.0);
}

}  // namespace
}  // namespace tremie
