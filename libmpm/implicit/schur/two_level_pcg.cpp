#include "libmpm/implicit/schur/two_level_pcg.hpp"

namespace tremie {

/// Numbers the cubes with the shortest way across the body running fastest.
void TwoLevelPcg::find_aggregates(const ActiveGrid<3>& grid) {
  Index<3> way{0, 1, 2};
  std::stable_sort(way.begin(), way.end(),
                   [&](int a, int b) { return grid.cell_map.extent[a] > grid.cell_map.extent[b]; });
  const int n = grid.n_cells();
  std::vector<Index<3>> at(n);
  for (int c = 0; c < n; ++c)
    for (int d = 0; d < 3; ++d) at[c][d] = (grid.cell_index[c][way[d]] - grid.cell_map.low[way[d]]) / cube;
  aggregate_cell_.resize(n);
  for (int c = 0; c < n; ++c) aggregate_cell_[c] = c;
  std::sort(aggregate_cell_.begin(), aggregate_cell_.end(),
            [&](int a, int b) { return at[a] != at[b] ? at[a] < at[b] : a < b; });
  cube_.resize(n);
  aggregate_begin_.clear();
  for (int k = 0; k < n; ++k) {
    if (k == 0 || at[aggregate_cell_[k]] != at[aggregate_cell_[k - 1]]) aggregate_begin_.push_back(k);
    cube_[aggregate_cell_[k]] = static_cast<int>(aggregate_begin_.size()) - 1;
  }
  aggregate_begin_.push_back(n);
}

/// P' S P.
void TwoLevelPcg::fill_coarse() {
  const int n = static_cast<int>(aggregate_begin_.size()) - 1;
  std::vector<int> first(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) first[k] = k;
  entries.for_each([&](int c, int other, float) {
    const auto [low, high] = std::minmax(cube_[c], cube_[other]);
    first[high] = std::min(first[high], low);
  });
  band_.reset(first);
  coarse_.setZero(n);
  entries.for_each([&](int c, int other, float value) {
    const int k = cube_[c], l = cube_[other];
    band_.add(std::max(k, l), std::min(k, l), k == l && c != other ? 2.0f * value : value);
  });
}

bool TwoLevelPcg::build(const ActiveGrid<3>& grid) {
  near_.build(entries);
  find_aggregates(grid);
  fill_coarse();
  return band_.factorise();
}

void TwoLevelPcg::multiply(const Eigen::VectorXf& p, Eigen::VectorXf& Sp) {
#pragma omp parallel
  entries.multiply_in_region(p, Sp);
}

void TwoLevelPcg::precondition(const Eigen::VectorXf& r, Eigen::VectorXf& z) {
  const int n = static_cast<int>(coarse_.size());
  z.resize(r.size());
#pragma omp parallel
  {
#pragma omp for schedule(static)
    for (int k = 0; k < n; ++k) {
      coarse_[k] = 0.0f;
      for (int j = aggregate_begin_[k]; j < aggregate_begin_[k + 1]; ++j) coarse_[k] += r[aggregate_cell_[j]];
    }
    band_.solve_in_region(coarse_);
    near_.apply_in_region(entries.layout, r);
#pragma omp for schedule(static)
    for (Eigen::Index c = 0; c < r.size(); ++c) {
      const auto cell = static_cast<std::size_t>(c);
      z[c] = entries.layout.x[entries.layout.place_of[cell]] + 0.5f * coarse_[cube_[cell]];
    }
  }
}

void TwoLevelPcg::solve(double reduction, Eigen::VectorXf& p) {
  Eigen::VectorXf rest = p;
  conjugate_gradients([&](const Eigen::VectorXf& x, Eigen::VectorXf& Sx) { multiply(x, Sx); },
                      [&](const Eigen::VectorXf& r, Eigen::VectorXf& z) { precondition(r, z); },
                      {.reduction = reduction, .most = 200}, rest, p);
}

}  // namespace tremie
