#pragma once

// The pressures' matrix S by its entries, in single precision: what conjugate gradients multiply with.
//
// A cell is coupled with those within two of it in every direction, 125 with itself. S is symmetric: the 63
// entries with itself and the cells ahead are kept, and a product uses each twice, for the cell and for the
// one ahead; 252 bytes a cell are read where the rows of B would be 864. The cells lie in columns along the
// body's longest way, sixteen of them go side by side, and every cell adds up its own entries in one order:
// the bits do not depend on the threads.

#include <algorithm>
#include <array>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/step/cell_lanes.hpp"

namespace tremie {

class PressureEntries {
 public:
  /// Makes room for the cells of a grid that is not periodic in all directions; all entries zero.
  void reset(const ActiveGrid<3>& grid);
  /// Adds to S(c, other) and S(other, c). Threads may add to different entries.
  void add(const ActiveGrid<3>& grid, int c, int other, float value);
  float diagonal(int c) const { return entries_[first_[c]]; }
  /// Calls use(c, other, value) for every entry on and ahead of the diagonal.
  template <class Use>
  void for_each(Use use) const;
  /// Sp = S p. To be called by all threads of a parallel region.
  void multiply_in_region(const Eigen::VectorXf& p, Eigen::VectorXf& Sp);

 private:
  static constexpr int reach = 2, kept = 63;
  static constexpr int slack = batch_size + 2 * reach;  ///< of reading whole batches

  /// Cells next to each other along way_[2], with what lies between them if they have gaps.
  struct Column {
    Index<2> across;
    int low, end;
    std::size_t at = 0;  ///< its first entry; those with the same neighbour follow each other
    int size() const { return end - low; }
  };
  struct Ghost {
    int place, cell;
  };

  static int offset(int a, int b, int c) { return 5 * (5 * a + b) + c; }
  int place(const Index<3>& at) const { return (at[0] * extent_[1] + at[1]) * extent_[2] + at[2]; }
  void find_columns(const std::vector<Index<3>>& at);
  void find_ghosts(const ActiveGrid<3>& grid, const std::vector<Index<3>>& at);
  void multiply_column(const Column& column);

  Index<3> way_{}, extent_{};  ///< axes, the longest one last; the box with a margin on all sides
  std::vector<Column> columns_;
  std::vector<int> column_at_;       ///< by place across, -1 where none
  std::vector<int> place_, column_;  ///< of each cell
  std::vector<std::size_t> first_;   ///< each cell's diagonal entry
  std::vector<Ghost> ghosts_;        ///< places in the margin that repeat a cell on a periodic axis
  std::vector<float> entries_, x_,
      y_;  ///< x_, y_: a vector and its product in the box, zero where no cell is
};

inline void PressureEntries::find_columns(const std::vector<Index<3>>& at) {
  const auto across = [&](const Index<2>& a) { return static_cast<std::size_t>(a[0] * extent_[1] + a[1]); };
  const int n = static_cast<int>(at.size());
  column_at_.assign(across({extent_[0], 0}), -1);
  columns_.clear();
  for (const Index<3>& cell : at) {
    int& k = column_at_[across({cell[0], cell[1]})];
    if (k < 0) {
      k = static_cast<int>(columns_.size());
      columns_.push_back({.across = {cell[0], cell[1]}, .low = cell[2], .end = cell[2] + 1});
    }
    columns_[k].low = std::min(columns_[k].low, cell[2]);
    columns_[k].end = std::max(columns_[k].end, cell[2] + 1);
  }
  std::sort(columns_.begin(), columns_.end(),
            [](const Column& a, const Column& b) { return a.across < b.across; });
  std::size_t size = slack;
  for (std::size_t k = 0; k < columns_.size(); ++k) {
    Column& column = columns_[k];
    column.at = size;
    column_at_[across(column.across)] = static_cast<int>(k);
    size += static_cast<std::size_t>(kept * column.size());
  }
  make_room(entries_, size + slack);
  std::fill(entries_.begin(), entries_.end(), 0.0f);
  make_room(place_, at.size()), make_room(column_, at.size()), make_room(first_, at.size());
  for (int c = 0; c < n; ++c) {
    column_[c] = column_at_[across({at[c][0], at[c][1]})];
    const Column& column = columns_[column_[c]];
    place_[c] = place(at[c]);
    first_[c] = column.at + static_cast<std::size_t>(at[c][2] - column.low);
  }
}

/// Places beside the ends of periodic axes; their columns are those of the cells that they repeat.
inline void PressureEntries::find_ghosts(const ActiveGrid<3>& grid, const std::vector<Index<3>>& at) {
  ghosts_.clear();
  Index<2> turns{}, period{};
  for (int d = 0; d < 2; ++d)
    if (const Axis& axis = grid.axes[way_[d]]; axis.periodic) turns[d] = reach, period[d] = axis.n_cells;
  if (turns == Index<2>{}) return;
  for (int i = -turns[0]; i <= turns[0]; ++i)
    for (int j = -turns[1]; j <= turns[1]; ++j)
      for (std::size_t c = 0; c < at.size() && (i != 0 || j != 0); ++c) {
        const Index<3> to{at[c][0] + i * period[0], at[c][1] + j * period[1], at[c][2]};
        if (to[0] < 0 || to[0] >= extent_[0] || to[1] < 0 || to[1] >= extent_[1]) continue;
        ghosts_.push_back({place(to), static_cast<int>(c)});
        column_at_[to[0] * extent_[1] + to[1]] = column_[c];
      }
}

inline void PressureEntries::reset(const ActiveGrid<3>& grid) {
  const auto length = [&](int d) { return grid.axes[d].periodic ? 0 : grid.cell_map.extent[d]; };
  way_ = {0, 1, 2};
  std::stable_sort(way_.begin(), way_.end(), [&](int a, int b) { return length(a) < length(b); });
  for (int d = 0; d < 3; ++d) extent_[d] = grid.cell_map.extent[way_[d]] + 2 * reach;
  extent_[2] += batch_size;
  std::vector<Index<3>> at(grid.cell_index.size());
  for (std::size_t c = 0; c < at.size(); ++c)
    for (int d = 0; d < 3; ++d) at[c][d] = grid.cell_index[c][way_[d]] - grid.cell_map.low[way_[d]] + reach;
  find_columns(at);
  find_ghosts(grid, at);
  const auto box = static_cast<std::size_t>(extent_[0]) * extent_[1] * extent_[2] + slack;
  x_.assign(box, 0.0f), y_.assign(box, 0.0f);
}

inline void PressureEntries::add(const ActiveGrid<3>& grid, int c, int other, float value) {
  Index<3> step;
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid.axes[way_[d]];
    step[d] = grid.cell_index[other][way_[d]] - grid.cell_index[c][way_[d]];
    if (axis.periodic && std::abs(step[d]) > reach) step[d] -= step[d] > 0 ? axis.n_cells : -axis.n_cells;
  }
  const int k = offset(step[0], step[1], step[2]), from = k < 0 ? other : c;
  entries_[first_[from] + static_cast<std::size_t>(std::abs(k) * columns_[column_[from]].size())] += value;
}

template <class Use>
void PressureEntries::for_each(Use use) const {
  std::vector<int> cell(x_.size(), -1);
  for (std::size_t c = 0; c < place_.size(); ++c) cell[place_[c]] = static_cast<int>(c);
  for (const Ghost& g : ghosts_) cell[g.place] = g.cell;
  for (int c = 0; c < static_cast<int>(place_.size()); ++c)
    for (int a = 0; a <= reach; ++a)
      for (int b = a == 0 ? 0 : -reach; b <= reach; ++b)
        for (int d = a == 0 && b == 0 ? 0 : -reach; d <= reach; ++d)
          if (const int other = cell[place_[c] + place({a, b, d})]; other >= 0)
            use(c, other,
                entries_[first_[c] +
                         static_cast<std::size_t>(offset(a, b, d) * columns_[column_[c]].size())]);
}

/// Products of sixteen cells at a time. Beyond the ends of a column entries of others are read, finite and
/// times zero.
inline void PressureEntries::multiply_column(const Column& column) {
  using Sixteen = Eigen::Map<const Lanes<float>>;
  const auto at = [](const float* from) { return Sixteen(from); };
  const int size = column.size(), start = place({column.across[0], column.across[1], column.low});
  for (int i = 0; i < size; i += batch_size) {
    const float *x = &x_[start + i], *own = &entries_[column.at + static_cast<std::size_t>(i)];
    Lanes<float> to = at(own) * at(x), from = Lanes<float>::Zero();
    for (int d = 1; d <= reach; ++d) {
      to += at(own + d * size) * at(x + d);
      from += at(own + d * size - d) * at(x - d);
    }
    const auto beside = [&](int a, int b) -> const Column* {
      const int k = column_at_[(column.across[0] + a) * extent_[1] + column.across[1] + b];
      if (k < 0) return nullptr;
      const Column& other = columns_[k];
      const int first = column.low + i;
      return first - reach < other.end && first + batch_size + reach > other.low ? &other : nullptr;
    };
    for (int a = 0; a <= reach; ++a)
      for (int b = a == 0 ? 1 : -reach; b <= reach; ++b) {
        const int there = place({a, b, 0});
        if (beside(a, b))
          for (int d = -reach; d <= reach; ++d) to += at(own + offset(a, b, d) * size) * at(x + there + d);
        if (const Column* other = beside(-a, -b)) {
          const float* theirs = entries_.data() + other->at + (column.low + i - other->low);
          for (int d = -reach; d <= reach; ++d)
            from += at(theirs + offset(a, b, d) * other->size() - d) * at(x - there - d);
        }
      }
    Eigen::Map<Lanes<float>> y(&y_[start + i]);
    y = to + from;
  }
}

inline void PressureEntries::multiply_in_region(const Eigen::VectorXf& p, Eigen::VectorXf& Sp) {
  const int n = static_cast<int>(place_.size());
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) x_[place_[c]] = p[c];
#pragma omp for schedule(static)
  for (std::size_t g = 0; g < ghosts_.size(); ++g) x_[ghosts_[g].place] = p[ghosts_[g].cell];
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < columns_.size(); ++k) multiply_column(columns_[k]);
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) Sp[c] = y_[place_[c]];
}

}  // namespace tremie
