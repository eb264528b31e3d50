#include "libmpm/grid/active_grid.hpp"

#include <cstddef>
#include <utility>

namespace tremie {

namespace detail {
namespace {

template <int D>
void sort_points_by_cell(ActiveGrid<D>& grid, const std::vector<Index<D>>& cell) {
  std::vector<int>& slot = grid.cell_map.value;
  std::vector<int> cell_slot(cell.size());
  std::vector<int> count(slot.size(), 0);
  for (std::size_t p = 0; p < cell.size(); ++p) {
    cell_slot[p] = static_cast<int>(grid.cell_map.offset(cell[p]));
    ++count[cell_slot[p]];
  }
  const auto active = static_cast<std::size_t>(count.size()) -
                      static_cast<std::size_t>(std::count(count.begin(), count.end(), 0));
  resize_for_overwrite(grid.cell_index, active), grid.cell_index.clear();
  grid.cell_begin.assign(1, 0);
  for_each_index(grid.cell_map, [&](const Index<D>& i, std::size_t o) {
    if (count[o] == 0) return;
    slot[o] = grid.n_cells();
    grid.cell_index.push_back(i);
    grid.cell_begin.push_back(grid.cell_begin.back() + count[o]);
  });
  std::vector<int> next(grid.cell_begin.begin(), grid.cell_begin.end() - 1);
  resize_for_overwrite(grid.order, cell.size());
  for (std::size_t p = 0; p < cell.size(); ++p) {
    const int c = slot[cell_slot[p]];
    grid.order[next[c]++] = static_cast<int>(p);
  }
}

template <int D>
void number_nodes(ActiveGrid<D>& grid) {
  Index<D> low, high;
  for (int d = 0; d < D; ++d) {
    const Axis& a = grid.axes[d];
    low[d] = a.periodic ? 0 : a.first_node(grid.cell_map.low[d]);
    high[d] = a.periodic ? a.n_cells + a.n_repeated_knots() - 1
                         : a.first_node(grid.cell_map.low[d] + grid.cell_map.extent[d] - 1) + 2;
  }
  grid.node_map.reset(low, high);
  std::array<std::ptrdiff_t, D> stride;  // of the map
  stride[D - 1] = 1;
  for (int d = D - 1; d > 0; --d) stride[d - 1] = stride[d] * grid.node_map.extent[d];
  // Calls visit(k, place in the map) for each node of a cell.
  const auto for_each_local_node = [&](const Index<D>& cell, auto visit) {
    std::array<std::array<std::ptrdiff_t, 3>, D> at;  // what each node adds, direction by direction
    for (int d = 0; d < D; ++d) {
      const Axis& a = grid.axes[d];
      const int first = a.first_node(cell[d]);
      for (int o = 0; o < 3; ++o) at[d][o] = (a.node(first + o) - low[d]) * stride[d];
    }
    for (int k = 0; k < ActiveGrid<D>::n_local; ++k) {
      const Index<D> o = local_offset<D>(k);
      std::ptrdiff_t place = 0;
      for (int d = 0; d < D; ++d) place += at[d][o[d]];
      visit(k, static_cast<std::size_t>(place));
    }
  };
  for (const Index<D>& cell : grid.cell_index)
    for_each_local_node(cell, [&](int, std::size_t place) { grid.node_map.value[place] = 0; });
  const auto& map = grid.node_map.value;
  resize_for_overwrite(grid.node_index, static_cast<std::size_t>(std::count(map.begin(), map.end(), 0)));
  grid.node_index.clear();
  for_each_index(grid.node_map, [&](const Index<D>& j, std::size_t o) {
    if (grid.node_map.value[o] < 0) return;
    grid.node_map.value[o] = grid.n_nodes();
    grid.node_index.push_back(j);
  });
  resize_for_overwrite(grid.cell_nodes, grid.cell_index.size());
#pragma omp parallel for schedule(static)
  for (std::size_t c = 0; c < grid.cell_index.size(); ++c)
    for_each_local_node(grid.cell_index[c], [&](int k, std::size_t place) {
      grid.cell_nodes[c][k] = grid.node_map.value[place];
    });
}

template <int D>
void find_mirrors(ActiveGrid<D>& grid) {
  grid.mirrors.clear();
  for (int i = 0; i < grid.n_nodes(); ++i) {
    MirrorNode<D> m{i, i, Vec<D>::Ones()};
    Index<D> j = grid.node_index[i];
    for (int d = 0; d < D; ++d) {
      const int of = grid.axes[d].mirrored(j[d]);
      if (of == j[d]) continue;
      j[d] = of;
      m.sign[d] = -1.0;
    }
    m.of = grid.node_map.at(j);  // active too: every cell that sees the one sees the other
    if (m.of != i) grid.mirrors.push_back(m);
  }
}

}  // namespace
}  // namespace detail

template <int D>
std::int64_t count_active_cells(const std::array<Axis, D>& axes, const std::vector<Vec<D>>& positions) {
  if (positions.empty()) return 0;
  Index<D> low = detail::cell_of<D>(axes, positions.front()), high = low;
  for (const Vec<D>& x : positions) {
    const Index<D> cell = detail::cell_of<D>(axes, x);
    for (int d = 0; d < D; ++d) low[d] = std::min(low[d], cell[d]), high[d] = std::max(high[d], cell[d]);
  }
  IndexMap<D> seen;
  seen.reset(low, high);
  std::int64_t cells = 0;
  for (const Vec<D>& x : positions) {
    int& slot = seen.value[seen.offset(detail::cell_of<D>(axes, x))];
    if (slot < 0) ++cells;
    slot = 0;
  }
  return cells;
}

template <int D>
void activate(ActiveGrid<D>& grid, const std::vector<Vec<D>>& x) {
  std::vector<Index<D>> cell(x.size());
  Index<D> low{}, high{};
  for (std::size_t p = 0; p < x.size(); ++p) {
    cell[p] = detail::cell_of<D>(grid.axes, x[p]);
    for (int d = 0; d < D; ++d) {
      low[d] = p == 0 ? cell[p][d] : std::min(low[d], cell[p][d]);
      high[d] = p == 0 ? cell[p][d] : std::max(high[d], cell[p][d]);
    }
  }
  grid.cell_map.reset(low, high);
  detail::sort_points_by_cell<D>(grid, cell);
  detail::number_nodes(grid);
  detail::find_mirrors(grid);
}

#define TREMIE_ACTIVATE_IN(D)                                         \
  template void activate(ActiveGrid<D>&, const std::vector<Vec<D>>&); \
  template std::int64_t count_active_cells<D>(const std::array<Axis, D>&, const std::vector<Vec<D>>&);
TREMIE_ACTIVATE_IN(1)
TREMIE_ACTIVATE_IN(2)
TREMIE_ACTIVATE_IN(3)

}  // namespace tremie
