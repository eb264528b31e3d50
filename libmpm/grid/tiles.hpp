#pragma once

// The grid of the explicit steps: tiles of 4 cells a direction where there is concrete, and nothing
// elsewhere.
//
// A tile's points see the controls 4a - 1 ... 4a + 6 of each direction: its own cells and one more on either
// side, so that points may drift by a cell before they are sorted again. Controls are kept in blocks, 4b - 1
// ... 4b + 2; a tile reads exactly 2^D of them. What its points add to the controls goes into the tile's own
// buffer, and each block sums up the buffers of its 2^D tiles in one fixed order: no locks, and the same bits
// for any number of threads. Points reach about half of the rows that their tile sees (a row: the controls
// along the last direction); each tile knows which, and the others are neither cleared nor read nor summed.

#include <omp.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "libmpm/grid/active_grid.hpp"

namespace tremie {

inline constexpr int tile_cells = 4;
inline constexpr int tile_span = 2 * tile_cells;  ///< controls that a tile sees in each direction

/// One entry a control: components 0 to D-1 a vector, component D the mass.
using NodeLanes [[gnu::vector_size(32)]] = double;

/// Rows of the controls that a tile sees, one bit each; the direction before the last runs fastest.
using TileRows = std::uint64_t;
template <int D>
inline constexpr TileRows all_rows = D == 2 ? (1 << tile_span) - 1 : ~TileRows{0};

template <int D>
struct Tile {
  Index<D> at{};                         ///< its cells are 4 at ... 4 at + 3
  int first_group = 0, last_group = 0;   ///< its points, in groups of eight: [first, last)
  std::array<int, power(2, D)> block{};  ///< blocks at + offset, the last direction running fastest
};

template <int D>
struct NodeBlock {
  Index<D> at{};
  std::array<int, power(2, D)> tile{};  ///< tiles at - offset; -1: none
  int cost = 0;                         ///< of the blocks up to this one: of a tile 1, of a block 1
};

/// The controls that a tile sees, aligned so that an even one and the next make one vector of eight.
template <int n>
struct alignas(64) NodeCube : std::array<NodeLanes, n> {};

template <int D>
struct TileGrid {
  static constexpr int tile_nodes = power(tile_span, D), block_nodes = power(tile_cells, D);
  using Buffer = NodeCube<tile_nodes>;
  using Nodes = std::array<NodeLanes, block_nodes>;

  std::array<Axis, D> axes;
  std::vector<Tile<D>> tiles;
  std::vector<NodeBlock<D>> blocks;
  std::vector<Buffer> sums;    ///< a tile: momentum and mass that its points give
  std::vector<Buffer> forces;  ///< a tile: impulse of the stresses, for FLIP alone
  std::vector<TileRows> rows;  ///< a tile: what its points reached when they last gave to the controls
  std::vector<Nodes> v;        ///< a block: velocity and mass, in the rows that a tile reaches
  std::vector<Nodes> v_start;  ///< a block: velocity before the step's forces, for FLIP alone

  int n_tiles() const { return static_cast<int>(tiles.size()); }
  int n_blocks() const { return static_cast<int>(blocks.size()); }
};

/// Distance between neighbours in direction d within a cube of `span` entries a direction.
template <int D>
constexpr int stride(int span, int d) {
  return power(span, D - 1 - d);
}

/// Offset (0 or 1 in each direction) of the k-th corner; the last direction runs fastest.
template <int D>
constexpr Index<D> corner(int k) {
  Index<D> o{};
  for (int d = D - 1; d >= 0; --d, k /= 2) o[d] = k % 2;
  return o;
}

namespace detail {

/// Tile or block index on a periodic axis, wrapped.
inline int wrapped(const Axis& axis, int at) {
  const int n = axis.n_cells / tile_cells;
  return axis.periodic ? ((at % n) + n) % n : at;
}

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
    grid.blocks[b].cost = 1 + (b > 0 ? grid.blocks[b - 1].cost : 0);
    for (int k = 0; k < power(2, D); ++k) {
      grid.blocks[b].tile[k] = find_at<D>(grid.tiles, neighbour(at[b], k, -1));
      grid.blocks[b].cost += grid.blocks[b].tile[k] < 0 ? 0 : 1;
    }
  }
  for (Tile<D>& t : grid.tiles)
    for (int k = 0; k < power(2, D); ++k) t.block[k] = find_at<D>(grid.blocks, neighbour(t.at, k, 1));
}

}  // namespace detail

/// Lays the grid under these tiles, sorted by `at`. Velocities of controls that were there are kept.
template <int D>
void lay_tiles(TileGrid<D>& grid, std::vector<Tile<D>> tiles, bool flip) {
  const std::vector<NodeBlock<D>> old = std::move(grid.blocks);
  std::vector<typename TileGrid<D>::Nodes> v = std::move(grid.v), v_start = std::move(grid.v_start);
  grid.tiles = std::move(tiles);
  grid.blocks = {};
  detail::join_blocks<D>(grid);
  grid.sums.resize(grid.tiles.size());
  grid.rows.assign(grid.tiles.size(), all_rows<D>);
  grid.v.assign(grid.blocks.size(), {});
  if (flip) grid.forces.resize(grid.tiles.size()), grid.v_start.assign(grid.blocks.size(), {});
  for (std::size_t b = 0; b < grid.blocks.size(); ++b) {
    const int was = detail::find_at<D>(old, grid.blocks[b].at);
    if (was < 0) continue;
    grid.v[b] = v[static_cast<std::size_t>(was)];
    if (flip) grid.v_start[b] = v_start[static_cast<std::size_t>(was)];
  }
}

/// The first of a thread's tiles; those of thread + 1 are the end. Threads have neighbouring tiles, always
/// the same ones between two sortings, of about as many groups: what a tile keeps stays in its thread's
/// caches.
template <int D>
int first_tile_of(const TileGrid<D>& grid, int thread, int n_threads) {
  constexpr std::int64_t groups_worth = 8;  // what a tile's own arrays cost
  const auto cost = [&](const Tile<D>& tile) {
    return tile.last_group + groups_worth * (&tile - grid.tiles.data() + 1);
  };
  if (grid.tiles.empty()) return 0;
  const std::int64_t before = cost(grid.tiles.back()) * thread / n_threads;
  const auto first = std::partition_point(grid.tiles.begin(), grid.tiles.end(),
                                          [&](const Tile<D>& tile) { return cost(tile) <= before; });
  return static_cast<int>(first - grid.tiles.begin());
}

/// The first of a thread's blocks: neighbours too, with about as many tiles to sum up.
template <int D>
int first_block_of(const TileGrid<D>& grid, int thread, int n_threads) {
  const std::int64_t before =
      std::int64_t{grid.blocks.empty() ? 0 : grid.blocks.back().cost} * thread / n_threads;
  const auto first = std::partition_point(grid.blocks.begin(), grid.blocks.end(),
                                          [&](const NodeBlock<D>& block) { return block.cost <= before; });
  return static_cast<int>(first - grid.blocks.begin());
}

/// Visits each thread's tiles or blocks in that thread; `first`: first_tile_of or first_block_of.
template <int D, class Visit>
void for_each_share(const TileGrid<D>& grid, int (*first)(const TileGrid<D>&, int, int), Visit visit) {
#pragma omp parallel
  {
    const int thread = omp_get_thread_num(), n_threads = omp_get_num_threads();
    const int end = first(grid, thread + 1, n_threads);
    for (int i = first(grid, thread, n_threads); i < end; ++i) visit(i);
  }
}

/// Visits the numbers of the rows in `rows`.
template <class Visit>
[[gnu::always_inline]] inline void for_each_row(TileRows rows, Visit visit) {
  for (; rows != 0; rows &= rows - 1) visit(__builtin_ctzll(rows));
}

/// Rows of the stencil that begins at `base` in a tile's cube.
template <int D>
TileRows stencil_rows(int base) {
  constexpr TileRows three = D == 2 ? 7 : 7 | 7 << tile_span | 7 << 2 * tile_span;
  return three << (base / tile_span);
}

template <int D>
void clear_rows(TileRows rows, NodeCube<power(tile_span, D)>& cube) {
  for_each_row(rows, [&](int row) {
    for (int i = 0; i < tile_span; ++i) cube[row * tile_span + i] = NodeLanes{};
  });
}

/// Of a tile's rows those of its k-th block, four a direction.
template <int D>
unsigned rows_of_block(TileRows rows, int k) {
  const Index<D> c = corner<D>(k);
  constexpr TileRows four = (1 << tile_cells) - 1;
  if constexpr (D == 2) {
    return static_cast<unsigned>(rows >> (c[0] * tile_cells) & four);
  } else {
    unsigned in_block = 0;
    rows >>= (c[0] * tile_span + c[1]) * tile_cells;
    for (int i = 0; i < tile_cells; ++i)
      in_block |= static_cast<unsigned>(rows >> (i * tile_span) & four) << (i * tile_cells);
    return in_block;
  }
}

/// Where row `row` of a tile's k-th block begins in the tile's cube.
template <int D>
int row_in_cube(int k, int row) {
  const Index<D> c = corner<D>(k);
  int at = c[D - 1] * tile_cells;
  for (int d = D - 2; d >= 0; --d, row /= tile_cells)
    at += (c[d] * tile_cells + row % tile_cells) * stride<D>(tile_span, d);
  return at;
}

/// Copies rows of a tile's blocks into one cube of controls.
template <int D>
void read_blocks(const Tile<D>& tile, TileRows rows,
                 const std::vector<std::array<NodeLanes, power(tile_cells, D)>>& blocks,
                 std::array<NodeLanes, power(tile_span, D)>& cube) {
  for (int k = 0; k < power(2, D); ++k) {
    const auto& block = blocks[static_cast<std::size_t>(tile.block[k])];
    for_each_row(rows_of_block<D>(rows, k), [&](int row) {
      const int to = row_in_cube<D>(k, row);
      for (int i = 0; i < tile_cells; ++i) cube[to + i] = block[row * tile_cells + i];
    });
  }
}

/// Visits the rows of block b that any of its tiles reaches, with the sums over the tiles' buffers:
/// visit(row, totals of its controls).
template <int D, class Visit>
void sum_tiles(const TileGrid<D>& grid, int b, const std::vector<typename TileGrid<D>::Buffer>& buffers,
               Visit visit) {
  const NodeBlock<D>& block = grid.blocks[static_cast<std::size_t>(b)];
  unsigned reached = 0, reached_by[power(2, D)];
  for (int k = 0; k < power(2, D); ++k) {
    const int t = block.tile[k];
    reached_by[k] = t < 0 ? 0 : rows_of_block<D>(grid.rows[static_cast<std::size_t>(t)], k);
    reached |= reached_by[k];
  }
  for_each_row(reached, [&](int row) {
    std::array<NodeLanes, tile_cells> total{};
    for (int k = 0; k < power(2, D); ++k) {
      if ((reached_by[k] >> row & 1) == 0) continue;
      const NodeLanes* from =
          &buffers[static_cast<std::size_t>(block.tile[k])][static_cast<std::size_t>(row_in_cube<D>(k, row))];
      for (std::size_t i = 0; i < tile_cells; ++i) total[i] += from[i];
    }
    visit(row, total);
  });
}

}  // namespace tremie
