#include "libmpm/implicit/schur/fsai.hpp"

namespace tremie {

namespace detail {

/// Number of the column at an offset across from one; -1 where none is or only a repetition of one.
int own_column_beside(const CellColumns& layout, const CellColumns::Column& column, int a, int b) {
  const int k = layout.beside(column, a, b);
  return k >= 0 && layout.columns[k].across == Index<2>{column.across[0] + a, column.across[1] + b} ? k : -1;
}

/// Adds lanes to y, the first n of them if n is less than all.
void add_lanes(float* y, const Lanes<float>& more, int n) {
  if (n >= batch_size)
    Eigen::Map<Lanes<float>>{y} += more;
  else
    Eigen::Map<Eigen::ArrayXf>{y, n} += more.head(n);
}

void store_lanes(float* y, const Lanes<float>& value, int n) {
  if (n >= batch_size)
    Eigen::Map<Lanes<float>>{y} = value;
  else
    Eigen::Map<Eigen::ArrayXf>{y, n} = value.head(n);
}

}  // namespace detail

/// Of the cells of a row of F: where S has their diagonals, null where no cell is or nothing on the diagonal.
Fsai::Row Fsai::row_of(const SchurMatrix& S, const Columns& there, int place) {
  Row row{};
  for (std::size_t m = 0; m < kept; ++m) {
    const int at = place + ahead[m][2];
    if (there[m] == nullptr || at < there[m]->low || at >= there[m]->end) continue;
    const float* const entry = S.of_column(*there[m]) + (at - there[m]->low);
    if (*entry > 0.0f) row[m] = entry;
  }
  return row;
}

/// S among the cells of a row, on and below the diagonal; a place without a cell has 1 of its own.
Mat<Fsai::kept, Fsai::kept> Fsai::part_of(const Columns& there, const Row& row) {
  Mat<kept, kept> part = Mat<kept, kept>::Identity();
  for (std::size_t m = 0; m < kept; ++m)
    for (std::size_t n = 0; n <= m; ++n) {
      if (row[m] == nullptr || row[n] == nullptr) continue;
      const Index<3>&to = ahead[m], &from = ahead[n];
      const int k = SchurMatrix::offset(to[0] - from[0], to[1] - from[1], to[2] - from[2]);
      const float value = k < 0 ? row[m][-k * there[m]->size()] : row[n][k * there[n]->size()];
      part(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n)) = static_cast<double>(value);
    }
  return part;
}

/// The row f of F of a cell: with S among the cells of the row, S g = e, the cell's own unit vector, and
/// f = g / sqrt(g_own), so that F S F' has ones on its diagonal. Where rounding made that part of S
/// indefinite the diagonal is left.
void Fsai::fill_column(const SchurMatrix& S, const Column& column) {
  Columns there{};
  for (std::size_t m = 0; m < kept; ++m)
    if (const int k = detail::own_column_beside(S.layout, column, ahead[m][0], ahead[m][1]); k >= 0)
      there[m] = &S.layout.columns[k];
  const int size = column.size();
  float* const own = of_column(column);
  for (int i = 0; i < size; ++i) {
    const Row row = row_of(S, there, column.low + i);
    if (row[0] == nullptr) continue;
    const Eigen::LLT<Mat<kept, kept>> factor(part_of(there, row));
    const Vec<kept> g = factor.solve(Vec<kept>::Unit(0));
    if (factor.info() == Eigen::Success && g.allFinite())
      for (int k = 0; k < kept; ++k) own[k * size + i] = static_cast<float>(g[k] / std::sqrt(g[0]));
    else
      own[i] = 1.0f / std::sqrt(*row[0]);
  }
}

void Fsai::build(const SchurMatrix& S) {
  resize_for_overwrite(entries_, kept * S.layout.n_places() + 2 * slack);
  std::fill(entries_.begin(), entries_.end(), 0.0f);
#pragma omp parallel for schedule(static)
  for (std::size_t k = 0; k < S.layout.columns.size(); ++k) fill_column(S, S.layout.columns[k]);
}

/// y = F x along a column.
void Fsai::multiply_column(CellColumns& layout, const Column& column) const {
  using LanesAt = Eigen::Map<const Lanes<float>>;
  const int size = column.size(), begin = layout.begin_of(column);
  const float* const own = of_column(column);
  for (int i = 0; i < size; i += batch_size) {
    Lanes<float> sum = Lanes<float>::Zero();
    for (int k = 0; k < kept; ++k)
      sum += LanesAt(own + k * size + i) * LanesAt(&layout.x[begin + layout.place_at(ahead[k]) + i]);
    detail::store_lanes(&layout.y[begin + i], sum, size - i);
  }
}

/// x = F' y along a column: what those behind have for it. Before a column's first cell entries of others are
/// read, finite and times zero; what whole batches have beyond an end is not stored.
void Fsai::transposed_column(CellColumns& layout, const Column& column) const {
  using LanesAt = Eigen::Map<const Lanes<float>>;
  const int size = column.size(), begin = layout.begin_of(column);
  const float* const own = of_column(column);
  float* const x = &layout.x[begin];
  const float* const y = &layout.y[begin];
  for (int i = 0; i < size; i += batch_size) {
    Lanes<float> sum = LanesAt(own + i) * LanesAt(y + i);
    for (int d = 1; d <= CellColumns::reach; ++d) sum += LanesAt(own + d * size + i - d) * LanesAt(y + i - d);
    detail::store_lanes(x + i, sum, size - i);
  }
  for (int k = 1 + CellColumns::reach; k < kept; ++k) {
    const int which = detail::own_column_beside(layout, column, -ahead[k][0], -ahead[k][1]);
    if (which < 0) continue;
    const Column& behind = layout.columns[which];
    const int low = std::max(column.low, behind.low), end = std::min(column.end, behind.end);
    const float* const its = of_column(behind) + (k * behind.size() + low - behind.low);
    const float* const its_y = &layout.y[layout.begin_of(behind) + low - behind.low];
    for (int i = 0; i < end - low; i += batch_size)
      detail::add_lanes(x + (low - column.low + i), LanesAt(its + i) * LanesAt(its_y + i), end - low - i);
  }
}

void Fsai::apply_in_region(CellColumns& layout, const Eigen::VectorXf& r) const {
#pragma omp for schedule(static)
  for (Eigen::Index c = 0; c < r.size(); ++c) layout.x[layout.place_of[c]] = r[c];
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < layout.columns.size(); ++k) multiply_column(layout, layout.columns[k]);
#pragma omp for schedule(static)
  for (std::size_t k = 0; k < layout.columns.size(); ++k) transposed_column(layout, layout.columns[k]);
}

}  // namespace tremie
