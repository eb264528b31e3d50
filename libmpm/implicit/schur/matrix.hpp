#pragma once

// The pressures' matrix S by its entries, in single precision: what conjugate gradients multiply with.
//
// A cell is coupled with those within two of it in every direction, 125 with itself. S is symmetric: the 63
// entries with itself and the cells ahead are kept, and a product uses each twice, for the cell and for the
// one ahead; 252 bytes a cell are read, in the order in which they lie, where the rows of B would be 864.
// They lie by columns of cells (cell_chunks.hpp), sixteen cells of which go side by side. A chunk of columns
// gives what its entries make of x to a buffer of its own; where chunks meet, it is added up in their order: the
// bits do not depend on the threads.

#include <algorithm>
#include <utility>
#include <vector>

#include "libmpm/implicit/schur/cell_chunks.hpp"

namespace tremie {

class SchurMatrix {
 public:
  using Column = CellColumns::Column;
  static constexpr int reach = CellColumns::reach;

  /// Allocates the cells of a grid that is not periodic in all directions; all entries zero.
  void reset(const ActiveGrid<3>& grid);
  /// Adds to S(c, other) and S(other, c). Threads may add to different entries.
  void add(const ActiveGrid<3>& grid, int c, int other, float value);
  /// Calls use(c, other, value) for every entry on and ahead of the diagonal.
  template <class Use>
  void for_each(Use use) const;
  /// Sp = S p. To be called by all threads of a parallel region.
  void multiply_in_region(const Eigen::VectorXf& p, Eigen::VectorXf& Sp);

  /// Which of a cell's entries is that with the cell at an offset, ahead of it or itself, by the axes of the
  /// columns. Negative where that one is behind.
  static constexpr int offset(int a, int b, int c) { return 5 * (5 * a + b) + c; }
  /// Entry k of the cell at low + i of a column is [k size + i] of what this returns.
  const float* of_column(const Column& column) const { return &entries_[slack + kept * column.first]; }

  CellColumns layout;  ///< with the vectors in which products are made

 private:
  static constexpr int kept = 63, slack = CellColumns::slack, chunk = CellColumns::chunk;
  static constexpr int chunk_span = chunk + 2 * reach;  ///< columns across: its own, and that it reaches
  static constexpr int asked_for = 1536;                ///< how many entries before they are multiplied

  std::size_t chunk_size() const {
    return static_cast<std::size_t>(layout.extent[0]) * chunk_span * layout.extent[2];
  }
  /// Where the column at `across` begins in the buffer of a chunk.
  std::size_t position_in_chunk(int which, const Index<2>& across) const {
    const int beside = across[1] - chunk * which + reach;
    return chunk_size() * which +
           static_cast<std::size_t>((across[0] * chunk_span + beside) * layout.extent[2]);
  }
  void multiply_column(const Column& column, float* in_chunk);
  void add_up_chunks(const Index<2>& across, const Column& column);

  std::vector<float> entries_;    ///< column by column; those of a column with the same neighbour together
  std::vector<float> in_chunks_;  ///< a product's parts
};

template <class Use>
void SchurMatrix::for_each(Use use) const {
  const int n = static_cast<int>(layout.place_of.size());
  std::vector<int> cell(layout.x.size(), -1);
  for (int c = 0; c < n; ++c) cell[layout.place_of[c]] = c;
  for (const CellColumns::Ghost& g : layout.ghosts) cell[g.place] = g.cell;
  for (int c = 0; c < n; ++c) {
    const Column& column = layout.columns[layout.column_of[c]];
    const float* const own = of_column(column) + (layout.place_of[c] - layout.begin_of(column));
    for (int a = 0; a <= reach; ++a)
      for (int b = a == 0 ? 0 : -reach; b <= reach; ++b)
        for (int d = a == 0 && b == 0 ? 0 : -reach; d <= reach; ++d)
          if (const int other = cell[layout.place_of[c] + layout.place_at({a, b, d})]; other >= 0)
            use(c, other, own[offset(a, b, d) * column.size()]);
  }
}

}  // namespace tremie
