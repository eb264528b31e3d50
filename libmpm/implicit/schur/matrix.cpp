#include "libmpm/implicit/schur/matrix.hpp"

namespace tremie {

void SchurMatrix::reset(const ActiveGrid<3>& grid) {
  layout.lay_out(grid);
  resize_for_overwrite(entries_, kept * layout.n_places() + 2 * slack);
  std::fill(entries_.begin(), entries_.end(), 0.0f);
  resize_for_overwrite(in_chunks_, chunk_size() * static_cast<std::size_t>(layout.n_chunks()) + slack);
}

void SchurMatrix::add(const ActiveGrid<3>& grid, int c, int other, float value) {
  Index<3> step;
  for (int d = 0; d < 3; ++d) {
    const Axis& axis = grid.axes[layout.way[d]];
    step[d] = grid.cell_index[other][layout.way[d]] - grid.cell_index[c][layout.way[d]];
    if (axis.periodic && std::abs(step[d]) > reach) step[d] -= step[d] > 0 ? axis.n_cells : -axis.n_cells;
  }
  const int k = offset(step[0], step[1], step[2]), from = k < 0 ? other : c;
  const Column& column = layout.columns[layout.column_of[from]];
  const int i = layout.place_of[from] - layout.begin_of(column);
  entries_[slack + kept * column.first + static_cast<std::size_t>(std::abs(k) * column.size() + i)] += value;
}

/// What a column's entries make of x, sixteen cells at a time, for its own cells and for those of the columns
/// ahead; `in_chunk`: where the column begins in its chunk. Beyond the ends of a column entries of others are
/// read, finite and times zero, or for places that have no cell.
void SchurMatrix::multiply_column(const Column& column, float* in_chunk) {
  using LanesAt = Eigen::Map<const Lanes<float>>;
  const auto at = [](const float* from) { return LanesAt(from); };
  const auto add_to = [](float* y, const Lanes<float>& more) { Eigen::Map<Lanes<float>>{y} += more; };
  const int size = column.size();
  const float* const x = &layout.x[layout.begin_of(column)];
  const float* const own = of_column(column);
  float* const y = in_chunk + column.low;
  for (int i = 0; i < size; i += batch_size) {
    Lanes<float> sum = at(own + i) * at(x + i);
    for (int d = 1; d <= reach; ++d)
      sum += at(own + d * size + i) * at(x + i + d) + at(own + d * size + i - d) * at(x + i - d);
    add_to(y + i, sum);
  }
  for (int a = 0; a <= reach; ++a)
    for (int b = a == 0 ? 1 : -reach; b <= reach; ++b) {
      const int k = layout.beside(column, a, b);
      if (k < 0) continue;
      // Of both columns the places that have a neighbour in the other, from the own column's low on.
      const int low = layout.columns[k].low - column.low, end = layout.columns[k].end - column.low;
      const float* const entries = own + offset(a, b, 0) * size;
      for (int i = -reach * size; i < (reach + 1) * size; i += batch_size)
        __builtin_prefetch(entries + asked_for + i);
      const float* const x_there = x + layout.place_at({a, b, 0});
      float* const y_there = y + (a * chunk_span + b) * layout.extent[2];
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

/// The product along a column at `across`, of all chunks that reach it.
void SchurMatrix::add_up_chunks(const Index<2>& across, const Column& column) {
  const int first = std::max(0, (across[1] - reach) / chunk);
  const int last = std::min(layout.n_chunks() - 1, (across[1] + reach) / chunk);
  float* const y = &layout.y[layout.place_at({across[0], across[1], column.low})];
  for (int which = first; which <= last; ++which) {
    const float* const part =
        &in_chunks_[position_in_chunk(which, across) + static_cast<std::size_t>(column.low)];
    for (int i = 0; i < column.size(); ++i) y[i] = which == first ? part[i] : y[i] + part[i];
  }
}

void SchurMatrix::multiply_in_region(const Eigen::VectorXf& p, Eigen::VectorXf& Sp) {
  const auto& ghosts = layout.ghosts;
  const int n = static_cast<int>(layout.place_of.size());
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) layout.x[layout.place_of[c]] = p[c];
#pragma omp for schedule(static)
  for (std::size_t g = 0; g < ghosts.size(); ++g) layout.x[ghosts[g].place] = p[ghosts[g].cell];
#pragma omp for schedule(dynamic)
  for (int which = 0; which < layout.n_chunks(); ++which) {
    std::fill_n(in_chunks_.begin() + static_cast<std::ptrdiff_t>(chunk_size()) * which, chunk_size(), 0.0f);
    for (int k = layout.chunk_begin[which]; k < layout.chunk_begin[which + 1]; ++k)
      multiply_column(layout.columns[k], &in_chunks_[position_in_chunk(which, layout.columns[k].across)]);
  }
#pragma omp for schedule(static)
  for (int across = 0; across < static_cast<int>(layout.column_at.size()); ++across)
    if (const int k = layout.column_at[across]; k >= 0)
      add_up_chunks({across / layout.extent[1], across % layout.extent[1]}, layout.columns[k]);
#pragma omp single
  for (const CellColumns::Ghost& g : ghosts) layout.y[layout.place_of[g.cell]] += layout.y[g.place];
#pragma omp for schedule(static)
  for (int c = 0; c < n; ++c) Sp[c] = layout.y[layout.place_of[c]];
}

}  // namespace tremie
