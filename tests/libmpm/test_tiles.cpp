// The tiles of the explicit grid: rows of nodes, and passes over them by several threads.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "libmpm/explicit/passes.hpp"
#include "libmpm/explicit/tile_layout.hpp"

namespace tremie {
namespace {

/// A row of tiles, the t-th with t groups more than the one before it.
template <int D>
TileGrid<D> row_of_tiles(int n, int n_threads) {
  TileGrid<D> grid;
  for (Axis& axis : grid.axes) axis = {.n_cells = 64};
  std::vector<Tile<D>> tiles;
  for (int t = 0, groups = 0; t < n; ++t) {
    Tile<D> tile{.first_group = groups, .last_group = groups + t};
    tile.at[0] = t;
    groups += t;
    tiles.push_back(tile);
  }
  lay_tiles<D>(grid, tiles, false, n_threads);
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
  const TileGrid<3> grid = row_of_tiles<3>(7, 2);
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

// 780 groups of 10 and 15 a tile: 8400 in all. A cut between two tiles leaves up to half of one, the last
// one's 405, on either side.
TEST(Tiles, RunsCostAboutAsMuch) {
  const TileGrid<3> grid = row_of_tiles<3>(40, 2);
  for (const int n : {1, 2, 3, 5}) {
    const std::vector<int> begin = detail::even_runs<3>(grid.tiles, n);
    ASSERT_EQ(std::ssize(begin), n + 1);
    EXPECT_EQ(begin.front(), 0);
    EXPECT_EQ(begin.back(), 40);
    for (std::size_t s = 0; s + 1 < begin.size(); ++s) {
      std::int64_t cost = 0;
      for (int t = begin[s]; t < begin[s + 1]; ++t)
        cost += detail::cost_of(grid.tiles[static_cast<std::size_t>(t)]);
      EXPECT_NEAR(static_cast<double>(cost), 8400.0 / n, 405.0);
    }
  }
  EXPECT_EQ(detail::even_runs<3>({}, 3), (std::vector<int>{0, 0, 0, 0}));
}

// Block 9 is the last that tile 8 sees and the first that tile 9 sees.
TEST(Tiles, VelocitiesAreKept) {
  TileGrid<3> grid = row_of_tiles<3>(10, 10);
  const auto block_9 = [&]() -> f64x4& {
    return grid.v[static_cast<std::size_t>(grid.tiles.back().block[0])][7];
  };
  block_9() = f64x4{1.0, 2.0, 3.0, 4.0};
  lay_tiles<3>(grid, std::vector<Tile<3>>(grid.tiles.begin() + 4, grid.tiles.end()), false, 2);
  EXPECT_EQ(grid.v.size(), 4 * 7);
  EXPECT_EQ(block_9()[2], 3.0);
  EXPECT_EQ(grid.v[static_cast<std::size_t>(grid.tiles[4].block[0])][7][2], 0.0);
}

/// Counts what is begun and done with each block and tile, and fails where one goes before another that it
/// needs, or touches what another still reads.
class PassesWatched {
 public:
  explicit PassesWatched(TileGrid<3>& grid)
      : grid_(grid), blocks_(grid.blocks.size()), tiles_(grid.tiles.size()) {}

  /// `first`: the number of the pass when it comes for the first time, `each` how many there are till it
  /// comes again.
  auto pass(int first, bool blocks_done, int each = 0) {
    return GridPass{blocks_done,
                    [this, first, each](int b, int time) {
                      const int number = first + each * time;
                      visit(blocks_[static_cast<std::size_t>(b)], number, tiles_,
                            grid_.blocks[static_cast<std::size_t>(b)].tile, number - 1);
                    },
                    [this, first, each, blocks_done](int t, int time) {
                      const int number = first + each * time;
                      visit(tiles_[static_cast<std::size_t>(t)], number, blocks_,
                            grid_.tiles[static_cast<std::size_t>(t)].block, blocks_done ? 0 : number);
                    }};
  }
  void block_done(int b, int number) {
    blocks_[static_cast<std::size_t>(b)].begun = number, blocks_[static_cast<std::size_t>(b)].done = number;
  }

  void expect_all_done(int number) const {
    for (const auto* of : {&blocks_, &tiles_})
      for (const Seen& one : *of) EXPECT_EQ(one.done, number);
    EXPECT_FALSE(wrong_);
  }

 private:
  struct Seen {
    std::atomic<int> begun = 0, done = 0;
  };

  /// `others` must be done with pass `needed`, and not begin another until this is done.
  void visit(Seen& one, int number, const std::vector<Seen>& others, const std::array<int, 8>& which,
             int needed) {
    if (one.begun++ != number - 1) wrong_ = true;
    const auto look = [&] {
      for (const int i : which)
        if (i >= 0) {
          const Seen& other = others[static_cast<std::size_t>(i)];
          if (other.done < needed || (needed > 0 && other.begun > needed)) wrong_ = true;
        }
    };
    look();
    // Now this, now that thread is held up, longer than all the rest of a pass takes.
    if ((&one - (&others == &tiles_ ? blocks_ : tiles_).data() + 7 * number) % 11 == 0)
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    look();
    ++one.done;
  }

  TileGrid<3>& grid_;
  std::vector<Seen> blocks_, tiles_;
  std::atomic<bool> wrong_ = false;
};

void expect_in_order(TileGrid<3>& grid) {
  PassesWatched watched(grid);
  run_passes(grid, watched.pass(1, false), watched.pass(2, false));
  watched.expect_all_done(2);
  run_passes(grid, watched.pass(3, false));
  watched.expect_all_done(3);
  for_each_block(grid, [&](int b) { watched.block_done(b, 4); });
  run_passes(grid, watched.pass(4, true), watched.pass(5, false));
  watched.expect_all_done(5);
  for (int done = 5; done < 150; done += 14) {
    repeat_passes(grid, 7, watched.pass(done + 1, false, 2), watched.pass(done + 2, false, 2));
    watched.expect_all_done(done + 14);
  }
}

TEST(Tiles, PassesWaitForWhatTheyNeed) {
  for (const int n : {0, 1, 2, 7, 40})
    for (const int threads : {1, 2, 3, 16}) {
      TileGrid<3> grid = row_of_tiles<3>(n, threads);
      expect_in_order(grid);
    }
}

// Sheets of tiles that close on themselves in two directions: their last blocks are their first.
TEST(Tiles, PassesWaitForWhatTheyNeedOnPeriodicAxes) {
  for (const int n : {1, 2, 5})
    for (const int threads : {1, 2, 3, 16}) {
      TileGrid<3> grid;
      for (Axis& axis : grid.axes) axis = {.periodic = true, .n_cells = n * tile_cells};
      grid.axes[2] = {.n_cells = 64};
      std::vector<Tile<3>> tiles;
      for (int t = 0; t < n * n; ++t) {
        tiles.push_back({.first_group = 3 * t, .last_group = 3 * t + 3});
        tiles.back().at = {t / n, t % n, 0};
      }
      lay_tiles<3>(grid, tiles, false, threads);
      EXPECT_EQ(std::ssize(grid.blocks), 2 * n * n);
      expect_in_order(grid);
    }
}

}  // namespace
}  // namespace tremie
