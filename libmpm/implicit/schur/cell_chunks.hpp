#pragma once

// Cells in columns along the body's longest way, so that sixteen of them go side by side, in a box of places
// with a margin on all sides. Columns go together in chunks, eight wide across.

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/implicit/matrix_free/cell_simd.hpp"

namespace tremie {

struct CellColumns {
  static constexpr int reach = 2;                       ///< the margin, and how far cells are coupled
  static constexpr int slack = batch_size + 2 * reach;  ///< of reading whole batches
  static constexpr int chunk = 8;

  /// Cells next to each other along way[2], with what lies between them if they have gaps.
  struct Column {
    Index<2> across;
    int low, end;
    std::size_t first = 0;  ///< how many places the columns before it have
    int size() const { return end - low; }
  };
  struct Ghost {
    int place, cell;
  };

  /// Cells of a grid that is not periodic in all directions.
  void lay_out(const ActiveGrid<3>& grid);

  int place_at(const Index<3>& at) const { return (at[0] * extent[1] + at[1]) * extent[2] + at[2]; }
  int begin_of(const Column& column) const {
    return place_at({column.across[0], column.across[1], column.low});
  }
  /// Number of the column beside `column`, -1 where none; on a periodic axis it may be far away.
  int beside(const Column& column, int a, int b) const {
    return column_at[(column.across[0] + a) * extent[1] + column.across[1] + b];
  }
  std::size_t n_places() const { return columns.empty() ? 0 : columns.back().first + columns.back().size(); }
  int n_chunks() const { return (extent[1] - 1) / chunk + 1; }

  Index<3> way{}, extent{};      ///< axes, the longest one last; the box with its margin
  std::vector<Column> columns;   ///< those of a chunk follow each other
  std::vector<int> chunk_begin;  ///< chunk k has the columns chunk_begin[k] .. chunk_begin[k + 1]
  std::vector<int>
      column_at;  ///< by place across, -1 where none; beside the ends of a periodic axis, the one repeated
  std::vector<int> place_of, column_of;  ///< of each cell
  std::vector<Ghost> ghosts;             ///< places in the margin that repeat a cell on a periodic axis
  std::vector<float> x, y;               ///< two vectors by place; zero where neither cell nor ghost is

 private:
  void find_columns(const std::vector<Index<3>>& at);
  void find_ghosts(const ActiveGrid<3>& grid, const std::vector<Index<3>>& at);
};

}  // namespace tremie
