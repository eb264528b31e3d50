#include "libmpm/implicit/schur/cell_chunks.hpp"

namespace tremie {

void CellColumns::find_columns(const std::vector<Index<3>>& at) {
  const auto across = [&](const Index<2>& a) { return static_cast<std::size_t>(a[0] * extent[1] + a[1]); };
  const int n = static_cast<int>(at.size());
  column_at.assign(across({extent[0], 0}), -1);
  columns.clear();
  for (const Index<3>& cell : at) {
    int& k = column_at[across({cell[0], cell[1]})];
    if (k < 0) {
      k = static_cast<int>(columns.size());
      columns.push_back({.across = {cell[0], cell[1]}, .low = cell[2], .end = cell[2] + 1});
    }
    columns[k].low = std::min(columns[k].low, cell[2]);
    columns[k].end = std::max(columns[k].end, cell[2] + 1);
  }
  const auto chunk_of = [](const Column& c) { return c.across[1] / chunk; };
  std::sort(columns.begin(), columns.end(), [&](const Column& a, const Column& b) {
    return std::pair(chunk_of(a), a.across) < std::pair(chunk_of(b), b.across);
  });
  chunk_begin.assign(static_cast<std::size_t>(n_chunks() + 1), 0);
  for (const Column& c : columns) ++chunk_begin[chunk_of(c) + 1];
  std::partial_sum(chunk_begin.begin(), chunk_begin.end(), chunk_begin.begin());
  std::size_t places = 0;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    columns[k].first = places;
    column_at[across(columns[k].across)] = static_cast<int>(k);
    places += static_cast<std::size_t>(columns[k].size());
  }
  resize_for_overwrite(place_of, at.size()), resize_for_overwrite(column_of, at.size());
  for (int c = 0; c < n; ++c) {
    column_of[c] = column_at[across({at[c][0], at[c][1]})];
    place_of[c] = place_at(at[c]);
  }
}

/// Places beside the ends of periodic axes; their columns are those of the cells that they repeat.
void CellColumns::find_ghosts(const ActiveGrid<3>& grid, const std::vector<Index<3>>& at) {
  ghosts.clear();
  Index<2> turns{}, period{};
  for (int d = 0; d < 2; ++d)
    if (const Axis& axis = grid.axes[way[d]]; axis.periodic) turns[d] = reach, period[d] = axis.n_cells;
  if (turns == Index<2>{}) return;
  for (int i = -turns[0]; i <= turns[0]; ++i)
    for (int j = -turns[1]; j <= turns[1]; ++j)
      for (std::size_t c = 0; c < at.size() && (i != 0 || j != 0); ++c) {
        const Index<3> to{at[c][0] + i * period[0], at[c][1] + j * period[1], at[c][2]};
        if (to[0] < 0 || to[0] >= extent[0] || to[1] < 0 || to[1] >= extent[1]) continue;
        ghosts.push_back({place_at(to), static_cast<int>(c)});
        column_at[to[0] * extent[1] + to[1]] = column_of[c];
      }
}

void CellColumns::lay_out(const ActiveGrid<3>& grid) {
  const auto length = [&](int d) { return grid.axes[d].periodic ? 0 : grid.cell_map.extent[d]; };
  way = {0, 1, 2};
  std::stable_sort(way.begin(), way.end(), [&](int a, int b) { return length(a) < length(b); });
  for (int d = 0; d < 3; ++d) extent[d] = grid.cell_map.extent[way[d]] + 2 * reach;
  extent[2] += batch_size;
  std::vector<Index<3>> at(grid.cell_index.size());
  for (std::size_t c = 0; c < at.size(); ++c)
    for (int d = 0; d < 3; ++d) at[c][d] = grid.cell_index[c][way[d]] - grid.cell_map.low[way[d]] + reach;
  find_columns(at);
  find_ghosts(grid, at);
  const auto box = static_cast<std::size_t>(extent[0]) * extent[1] * extent[2] + slack;
  for (std::vector<float>* v : {&x, &y}) resize_for_overwrite(*v, box), std::fill(v->begin(), v->end(), 0.0f);
}

}  // namespace tremie
