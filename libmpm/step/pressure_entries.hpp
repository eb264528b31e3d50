#pragma once

// The pressures' matrix S by its entries, in single precision: what conjugate gradients multiply with.
//
// A cell is coupled with those within two of it in every direction, 125 with itself. S is symmetric: the 63
// entries with itself and the cells ahead are kept, and a product uses each twice, for the cell and for the
// one ahead; 252 bytes a cell are read, in the order in which they lie, where the rows of B would be 864. The
// cells lie in columns along the body's longest way, sixteen of them go side by side. Columns go together in
// strips, eight wide, each of which gives what its entries make of x to room of its own; where strips meet,
// it is added up in their order: the bits do not depend on the threads.

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
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
  static constexpr int strip = 8,
                       strip_span = strip + 2 * reach;  ///< columns across: its own, and that it reaches

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
  int n_strips() const { return (extent_[1] - 1) / strip + 1; }
  std::size_t strip_size() const { return static_cast<std::size_t>(extent_[0]) * strip_span * extent_[2]; }
  /// Where the column at `across` begins in the room of a strip.
  std::size_t place_in_strip(int which, const Index<2>& across) const {
    const int beside = across[1] - strip * which + reach;
    return strip_size() * which + static_cast<std::size_t>((across[0] * strip_span + beside) * extent_[2]);
  }
  void multiply_column(const Column& column, float* in_strip);
  void add_up_strips(const Index<2>& across, const Column& column);

  Index<3> way_{}, extent_{};        ///< axes, the longest one last; the box with a margin on all sides
  std::vector<Column> columns_;      ///< those of a strip follow each other
  std::vector<int> strip_begin_;     ///< strip k has the columns strip_begin_[k] .. strip_begin_[k + 1]
  std::vector<int> column_at_;       ///< by place across, -1 where none
  std::vector<int> place_, column_;  ///< of each cell
  std::vector<std::size_t> first_;   ///< each cell's diagonal entry
  std::vector<Ghost> ghosts_;        ///< places in the margin that repeat a cell on a periodic axis
  std::vector<float> entries_, x_,
      y_;                         ///< x_, y_: a vector, zero where no cell is, and its product in the box
  std::vector<float> in_strips_;  ///< the product's parts
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
  const auto strip_of = [](const Column& column) { return column.across[1] / strip; };
  std::sort(columns_.begin(), columns_.end(), [&](const Column& a, const Column& b) {
    return std::pair(strip_of(a), a.across) < std::pair(strip_of(b), b.across);
  });
  strip_begin_.assign(static_cast<std::size_t>(n_strips() + 1), 0);
  for (const Column& column : columns_) ++strip_begin_[strip_of(column) + 1];
  std::partial_sum(strip_begin_.begin(), strip_begin_.end(), strip_begin_.begin());
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
  make_room(in_strips_, strip_size() * static_cast<std::size_t>(n_strips()) + slack);
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

/// What a column's entries make of x, sixteen cells at a time, for its own cells and for those of the columns
/// ahead; `in_strip`: where the column begins in its strip. Beyond the ends of a column entries of others are
/// read, finite and times zero, or for places that have no cell.
inline void PressureEntries::multiply_column(const Column& column, float* in_strip) {
  using Sixteen = Eigen::Map<const Lanes<float>>;
  const auto at = [](const float* from) { return Sixteen(from); };
  const auto add_to = [](float* y, const Lanes<float>& more) { Eigen::Map<Lanes<float>>{y} += more; };
  const int size = column.size();
  const float* const x = &x_[place({column.across[0], column.across[1], column.low})];
  const float* const own = &entries_[column.at];
  float* const y = in_strip + column.low;
  for (int i = 0; i < size; i += batch_size) {
    Lanes<float> sum = at(own + i) * at(x + i);
    for (int d = 1; d <= reach; ++d)
      sum += at(own + d * size + i) * at(x + i + d) + at(own + d * size + i - d) * at(x + i - d);
    add_to(y + i, sum);
  }
  for (int a = 0; a <= reach; ++a)
    for (int b = a == 0 ? 1 : -reach; b <= reach; ++b) {
      const int k = column_at_[(column.across[0] + a) * extent_[1] + column.across[1] + b];
      if (k < 0) continue;
      // Of both columns the places that have a neighbour in the other, from the own column's low on.
      const int low = columns_[k].low - column.low, end = columns_[k].end - column.low;
      const float* const entries = own + offset(a, b, 0) * size;
      const float* const x_there = x + place({a, b, 0});
      float* const y_there = y + (a * strip_span + b) * extent_[2];
      for (int i = std::max(0, low - reach); i < std::min(size, end + reach); i += batch_size) {
        Lanes<float> sum = at(entries + i) * at(x_there + i);
        for (int d = 1; d <= reach; ++d)
          sum += at(entries + d * size + i) * at(x_there + i + d) +
                 at(entries - d * size + i) * at(x_there + i - d);
        add_to(y + i, sum);
      }
      for (int i = std::max(-reach, low); i < std::min(size + reach, end); i += batch_size) {
        Lanes<float> sum = at(entries + i) * at(x + i);
        for (int d = 1; d <= reach; ++d)
          sum +=
              at(entries + d * size + i - d) * at(x + i - d) + at(entries - d * size + i + d) * at(x + i + d);
        add_to(y_there + i, sum);
      }
    }
}

/// The product along a column at `across`, of all strips that reach it.
inline void PressureEntries::add_up_strips(const Index<2>& across, const Column& column) {
  const int first = std::max(0, (across[1] - reach) / strip);
  const int last = std::min(n_strips() - 1, (across[1] + reach) / strip);
  float* const y = &y_[place({across[0], across[1], column.low})];
  for (int which = first; which <= last; ++which) {
    const float* const part =
        &in_strips_[place_in_strip(which, across) + static_cast<std::size_t>(column.low)];
    for (int i = 0; i < column.size(); ++i) y[i] = which == first ? part[i] : y[i] + part[i];
  }
}

inline void PressureEntries::multiply_in_region(const Eigen::VectorXf& p, Eigen::VectorXf& Sp) {
  const int n = static_cast<int>(place_.size()), strips = n_strips();
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) x_[place_[c]] = p[c];
#pragma omp for schedule(static)
  for (std::size_t g = 0; g < ghosts_.size(); ++g) x_[ghosts_[g].place] = p[ghosts_[g].cell];
#pragma omp for schedule(dynamic)
  for (int which = 0; which < strips; ++which) {
    std::fill_n(in_strips_.begin() + static_cast<std::ptrdiff_t>(strip_size()) * which, strip_size(), 0.0f);
    for (int k = strip_begin_[which]; k < strip_begin_[which + 1]; ++k)
      multiply_column(columns_[k], &in_strips_[place_in_strip(which, columns_[k].across)]);
  }
#pragma omp for schedule(static)
  for (int across = 0; across < static_cast<int>(column_at_.size()); ++across)
    if (const int k = column_at_[across]; k >= 0)
      add_up_strips({across / extent_[1], across % extent_[1]}, columns_[k]);
#pragma omp single
  for (const Ghost& g : ghosts_) y_[place_[g.cell]] += y_[g.place];
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) Sp[c] = y_[place_[c]];
}

}  // namespace tremie
