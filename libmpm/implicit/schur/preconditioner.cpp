#include "libmpm/implicit/schur/preconditioner.hpp"

namespace tremie {

void SchurComplementPreconditioner::order_across_the_thin_way(const ActiveGrid<3>& grid) {
  way_ = {0, 1, 2};
  std::stable_sort(way_.begin(), way_.end(),
                   [&](int a, int b) { return grid.cell_map.extent[a] > grid.cell_map.extent[b]; });
  std::vector<std::pair<std::int64_t, int>> by_place(grid.cell_index.size());
  const Index<3>&low = grid.cell_map.low, &extent = grid.cell_map.extent;
  for (int c = 0; c < grid.n_cells(); ++c) {
    std::int64_t place = 0;
    for (int d : way_) place = place * extent[d] + (grid.cell_index[c][d] - low[d]);
    by_place[c] = {place, c};
  }
  if (way_ != Index<3>{0, 1, 2}) std::sort(by_place.begin(), by_place.end());  // that is the cells' own order
  order_.resize(by_place.size());
  for (std::size_t k = 0; k < by_place.size(); ++k) order_[k] = by_place[k].second;
}

void SchurComplementPreconditioner::number_cells(const std::vector<char>& left_out) {
  number_.resize(order_.size());
  int n = 0;
  for (int c : order_) number_[c] = left_out[c] ? -1 : n++;
  first_.resize(n);
}

/// Calls use(cell, offset) for the cells within two of `cell` in every direction, which are those that share
/// a node with it, in the order of their numbers; until one returns false.
template <class Use>
void SchurComplementPreconditioner::for_each_neighbour(const ActiveGrid<3>& grid, int cell, Use use) const {
  const auto& map = grid.cell_map;
  std::array<std::array<std::ptrdiff_t, 5>, 3> at;  // what each offset adds to the place in the map; -1: none
  std::ptrdiff_t stride = 1;
  for (int d = 2; d >= 0; stride *= map.extent[d--])
    for (int o = -2; o <= 2; ++o) {
      const int i = grid.axes[d].cell(grid.cell_index[cell][d] + o) - map.low[d];
      at[d][o + 2] = i < 0 || i >= map.extent[d] ? -1 : i * stride;
    }
  const auto [a, b, c] = way_;
  Index<3> offset;
  for (offset[a] = -2; offset[a] <= 2; ++offset[a])
    for (offset[b] = -2; offset[b] <= 2; ++offset[b]) {
      const std::ptrdiff_t at_a = at[a][offset[a] + 2], at_b = at[b][offset[b] + 2];
      if (at_a < 0 || at_b < 0) continue;
      for (offset[c] = -2; offset[c] <= 2; ++offset[c]) {
        const std::ptrdiff_t at_c = at[c][offset[c] + 2];
        if (at_c < 0) continue;
        const int other = map.value[at_a + at_b + at_c];
        if (other >= 0 && !use(other, offset)) return;
      }
    }
}

void SchurComplementPreconditioner::find_first_columns(const ActiveGrid<3>& grid) {
  bool wraps = false;
  for (const Axis& a : grid.axes) wraps = wraps || a.periodic;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    if (number_[c] < 0) continue;
    int& first = first_[number_[c]];
    first = number_[c];
    for_each_neighbour(grid, c, [&](int other, const Index<3>&) {
      if (number_[other] < 0) return true;
      first = std::min(first, number_[other]);
      return wraps;  // else the first neighbour is the farthest
    });
  }
}

namespace detail {

/// Sum of products over a box of so many nodes a direction; the last direction runs fastest.
template <int n0, int n1, int n2>
float box_sum(const Eigen::Vector4f* a, const Eigen::Vector4f* b) {
  Eigen::Vector4f sum = Eigen::Vector4f::Zero();
  for (int i = 0; i < n0; ++i)
    for (int j = 0; j < n1; ++j)
      for (int k = 9 * i + 3 * j; k < 9 * i + 3 * j + n2; ++k) sum += a[k].cwiseProduct(b[k]);
  return sum.sum();
}

/// The sums over all boxes of one to three nodes a direction, the last direction fastest.
template <int... k>
constexpr auto box_sums(std::integer_sequence<int, k...>) {
  return std::array{box_sum<1 + k / 9, 1 + k / 3 % 3, 1 + k % 3>...};
}

/// The sum over the box of nodes that a cell with the values a shares with the one at `offset`, which has b.
float box_product(const Index<3>& offset, const Eigen::Vector4f* a, const Eigen::Vector4f* b) {
  static constexpr auto sums = box_sums(std::make_integer_sequence<int, 27>{});
  const auto [x, y, z] = offset;
  const int own = 9 * std::max(0, x) + 3 * std::max(0, y) + std::max(0, z), shift = 9 * x + 3 * y + z;
  return sums[26 - 9 * std::abs(x) - 3 * std::abs(y) - std::abs(z)](a + own, b + own - shift);
}

}  // namespace detail

/// Calls add(c, other, value) for the part of S below its diagonal on a grid whose nodes are numbered like
/// its cells: two cells share a box of nodes.
template <class Add>
void SchurComplementPreconditioner::fill_by_boxes(const ActiveGrid<3>& grid, Add add) const {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    add(c, c, rows_.softness[c]);
    if (rows_.left_out[c]) continue;
    std::array<Eigen::Vector4f, 27> w;
    for (std::size_t k = 0; k < 27; ++k)
      w[k] = DivergenceOperator::times(rows_.G_inverse[grid.cell_nodes[c][k]], rows_.of_cell(c)[k]);
    for_each_neighbour(grid, c, [&](int other, const Index<3>& offset) {
      if (!rows_.left_out[other])
        add(c, other, detail::box_product(offset, w.data(), rows_.of_cell(other).data()));
      return other != c;  // those behind are entered by themselves
    });
  }
}

/// The same on any grid.
template <class Add>
void SchurComplementPreconditioner::fill_by_nodes(const ActiveGrid<3>& grid, const CellBatches& batches,
                                                  Add add) const {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    add(c, c, rows_.softness[c]);
    for (int k = 0; k < 27 && !rows_.left_out[c]; ++k) {
      const int i = grid.cell_nodes[c][k];
      const Eigen::Vector4f w = DivergenceOperator::times(rows_.G_inverse[i], rows_.of_cell(c)[k]);
      for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e)
        if (const int other = CellBatches::cell_of(*e);
            !rows_.left_out[other] && number_[other] <= number_[c])
          add(c, other, w.dot(rows_.of_entry(*e)));
    }
  }
}

template <class Add>
void SchurComplementPreconditioner::fill(const ActiveGrid<3>& grid, const CellBatches& batches,
                                         Add add) const {
  bool by_boxes = true;  // a periodic axis repeats places, a repeated knot adds nodes
  for (const Axis& a : grid.axes) by_boxes = by_boxes && !a.periodic && a.n_repeated_knots() == 0;
  by_boxes ? fill_by_boxes(grid, add) : fill_by_nodes(grid, batches, add);
}

void SchurComplementPreconditioner::lay_out(const ActiveGrid<3>& grid, double most_band_operations) {
  order_across_the_thin_way(grid);
  number_cells(std::vector<char>(order_.size(), 0));
  find_first_columns(grid);
  double width = 0.0;
  for (int i = 0; i < grid.n_cells(); ++i) width = std::max(width, double(i - first_[i]));
  const double n = grid.n_cells();
  bool wraps = true;  // in all directions
  for (const Axis& a : grid.axes) wraps = wraps && a.periodic;
  by_band_ = wraps || n * width * width < most_band_operations;
  if (by_band_) return;
  for (int c = 0; c < grid.n_cells(); ++c) number_[c] = c;
  band_ = {};
  tremie::release(order_);
  tremie::release(first_);
}

bool SchurComplementPreconditioner::build(const ActiveGrid<3>& grid, const CellBatches& batches,
                                          const Quadrature<ThreeD>& quadrature,
                                          const std::vector<Mat<3, 3>>& G_inverse,
                                          const std::vector<double>& stiffness, double ratio) {
  // What S^-1 misses, C makes ratio times as large. Single precision leaves no less than a few millionths.
  reduction_ = std::clamp(0.3 / ratio, 5e-6, 1e-2);
  rows_.build(grid, quadrature, G_inverse, stiffness);
  if (!by_band_) {
    auto& S = iteration_.entries;
    S.reset(grid);
    fill(grid, batches, [&](int c, int other, float value) { S.add(grid, c, other, value); });
    return iteration_.build(grid);
  }
  number_cells(rows_.left_out);
  find_first_columns(grid);
  band_.reset(first_);
  fill(grid, batches, [&](int c, int other, float value) {
    if (number_[c] >= 0) band_.add(number_[c], number_[other], value);
  });
  return first_.empty() || band_.factorise();
}

void SchurComplementPreconditioner::apply(const CellBatches& batches, const ActiveGrid<3>& grid,
                                          const Eigen::VectorXf& r, ReductionBuffer& buffer,
                                          Eigen::VectorXf& z) {
  const int n_cells = grid.n_cells(), n_nodes = grid.n_nodes();
  z.resize(r.size());
  y_.resize(r.size());
  p_.resize(by_band_ ? static_cast<Eigen::Index>(first_.size()) : n_cells);
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i)
      y_.segment<4>(4 * i) = DivergenceOperator::times(rows_.G_inverse[i], r.segment<4>(4 * i));
#pragma omp for schedule(static)
    for (int c = 0; c < n_cells; ++c)
      if (number_[c] >= 0) p_[number_[c]] = rows_.divergence(grid, c, y_);
    if (by_band_ && p_.size() > 0) band_.solve_in_region(p_);
  }
  if (!by_band_) iteration_.solve(reduction_, p_);
#pragma omp parallel
  {
    const NodeReduction& reduction = batches.reduction();
    const auto give = [&](int chunk, float* to) {
      rows_.push(
          grid, reduction.first_cell(chunk), reduction.last_cell(chunk),
          [&](int c) { return number_[c] < 0 ? 0.0f : p_[number_[c]]; }, to);
    };
    reduction.sweep_in_region<float>(buffer, give, [&](int i) {
      z.segment<4>(4 * i) =
          y_.segment<4>(4 * i) -
          DivergenceOperator::times(rows_.G_inverse[i], reduction.sum_at<float, 4>(i, buffer));
    });
  }
  for (const MirrorNode<3>& m : grid.mirrors)
    z.segment<3>(4 * m.node) = m.sign.cast<float>().cwiseProduct(z.segment<3>(4 * m.of));
}

}  // namespace tremie
