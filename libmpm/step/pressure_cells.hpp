#pragma once

// One divergence and one pressure row a cell, against locking.
//
// All points of a cell change their volume with the divergence at one place of it, and their pressures push
// by the same row: what a change of volume costs is what the pressure does. For GIMP the place is the cell's
// centre, where the corners' hats are taken. For splines it is the centre of mass of the points: at the
// cell's own centre the row would push controls that the points hardly reach, in a cell that they have just
// entered, by any multiple of the control's mass. (With the row at the mean place s of the points, a control
// whose spline is s^2/2 has at least the mass of s^2/2 of them, and slope s.)

#include "libmpm/space/gradients.hpp"
#include "libmpm/step/explicit_body.hpp"

namespace tremie::detail {

template <class Space>
class PressureCells {
 public:
  static constexpr int D = Space::dim, n = power(tile_pressure_cells, D);
  using Cube = std::array<NodeLanes, TileGrid<D>::tile_nodes>;

  PressureCells(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile)
      : axes_(axes), shape_(shape), tile_(tile) {
    slot_.fill(-1);
    for (int k = 0; k < power(2, D); ++k) {
      const Index<D> o = corner<D>(k);
      corners_[k] = NodeLanes{};
      for (int d = 0; d < D; ++d) {
        corner_at_[k] = (d == 0 ? 0 : corner_at_[k] * tile_span) + o[d];
        corners_[k][d] = (o[d] ? 2.0 : -2.0) / (power(2, D) * axes[d].h);
      }
    }
  }

  /// Enters the cells of the points of group g, with their places.
  void add_group(const LanePoints<D>& points, std::size_t g, std::array<int, octet_size>& cells) {
    std::array<Octet, D> x;
    for (int d = 0; d < D; ++d) x[d] = points.x[d][g];
    find_pressure_cells<D>(axes_, shape_, tile_, x, cells);
    if (shape_.kind == ShapeFunctions::gimp) {
      for (const int cell : cells) row_of(cell);
      return;
    }
    const Octet mass = points.mass[g];
    if (in_one(cells)) {
      Row& row = row_of(cells[0]);
      row.weight += sum(mass);
      for (int d = 0; d < D; ++d) row.moment[d] += sum(mass * x[d]);
      return;
    }
    for (int l = 0; l < octet_size; ++l) {
      if (mass[l] == 0.0) continue;
      Row& row = row_of(cells[static_cast<std::size_t>(l)]);
      row.weight += mass[l];
      for (int d = 0; d < D; ++d) row.moment[d] += mass[l] * x[d][l];
    }
  }

  void read_divergences(const Cube& v) {
    for (int i = 0; i < count_; ++i) {
      Row& row = rows_[i];
      if (at_corners()) {
        const NodeLanes* node = &v[corner_base(row)];
        NodeLanes total = {};
        for (int k = 0; k < power(2, D); ++k) total += corners_[k] * node[corner_at_[k]];
        row.divergence = 0.0;
        for (int d = 0; d < D; ++d) row.divergence += total[d];
        continue;
      }
      with_row(row, [&](int base, const auto& weights, double x_0) {
        constexpr int width = std::remove_cvref_t<decltype(weights)>::n_controls;
        const auto at = gather<D, width, slopes_only>(&v[base], weights);
        double L[D][D], q[Space::n_strain];
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) L[a][b] = at.slope[b][a];
        const double v_0 = at.value[0];
        strain_rate_of<Space, double>(L, v_0, x_0, q, row.divergence);
      });
    }
  }

  double divergence(int cell) const { return rows_[slot_[cell]].divergence; }

  /// Adds the impulses of n points, pressure times volume times step.
  void push(const std::array<int, octet_size>& cells, int points, const Octet& impulse) {
    if (in_one(cells)) {
      row_of(cells[0]).impulse += sum(impulse);
      return;
    }
    for (int l = 0; l < points; ++l) row_of(cells[static_cast<std::size_t>(l)]).impulse += impulse[l];
  }

  void scatter_impulses(Cube& sums) const {
    for (int i = 0; i < count_; ++i) {
      const Row& row = rows_[i];
      if (at_corners()) {
        NodeLanes* node = &sums[corner_base(row)];
        for (int k = 0; k < power(2, D); ++k) node[corner_at_[k]] += row.impulse * corners_[k];
        continue;
      }
      with_row(row, [&](int base, const auto& weights, double x_0) {
        constexpr int width = std::remove_cvref_t<decltype(weights)>::n_controls;
        NodeLanes value = {}, slope[D] = {};
        const NodeLanes moment[D] = {};
        if (std::is_same_v<Space, Axisymmetric>) value[0] = row.impulse / x_0;
        for (int d = 0; d < D; ++d) slope[d][d] = row.impulse;
        scatter<D, width>(&sums[base], weights, value, slope, moment);
      });
    }
  }

 private:
  struct Row {  // without defaults: most of a tile's cells are never entered
    int cell;
    double weight, divergence, impulse;
    std::array<double, D> moment;
  };

  Row& row_of(int cell) {
    if (slot_[cell] < 0) {
      slot_[cell] = static_cast<std::int16_t>(count_);
      rows_[count_] = {.cell = cell, .weight = 0.0, .divergence = 0.0, .impulse = 0.0, .moment = {}};
      ++count_;
    }
    return rows_[slot_[cell]];
  }

  static bool in_one(const std::array<int, octet_size>& cells) {
    bool one = true;
    for (const int cell : cells) one = one && cell == cells[0];
    return one;
  }

  /// GIMP's rows are the differences of the cell's corners, the same in each cell but next to an axis.
  bool at_corners() const {
    return shape_.kind == ShapeFunctions::gimp && !std::is_same_v<Space, Axisymmetric>;
  }
  static int corner_base(const Row& row) {
    int base = 0;
    for (int d = 0, n = power(tile_pressure_cells, D - 1); d < D; ++d, n /= tile_pressure_cells)
      base = base * tile_span + row.cell / n % tile_pressure_cells;
    return base;
  }

  /// use(base, weights, first coordinate) at the row's place: three controls a direction for splines, the
  /// cell's two corners for GIMP.
  template <class Use>
  void with_row(const Row& row, Use use) const {
    Index<D> at;
    int base = 0;
    for (int d = D - 1, rest = row.cell; d >= 0; --d, rest /= tile_pressure_cells)
      at[d] = rest % tile_pressure_cells - 2;
    if (shape_.kind == ShapeFunctions::gimp) {
      PointWeights<D, 2> weights{};
      for (int d = 0; d < D; ++d) {
        base = base * tile_span + at[d] + 2;
        weights.w[d][0] = weights.w[d][1] = 0.5;
        weights.dw[d][1] = 1.0 / axes_[d].h, weights.dw[d][0] = -weights.dw[d][1];
      }
      use(base, weights, axes_[0].origin + (tile_[0] * tile_cells + at[0] + 0.5) * axes_[0].h);
    } else {
      PointWeights<D, 3> weights{};
      for (int d = 0; d < D; ++d) {
        base = base * tile_span + at[d] + 1;
        const int cell = tile_[d] * tile_cells + at[d];
        const double s = (row.moment[d] / row.weight - axes_[d].origin) / axes_[d].h - cell;
        const SplineValues one = splines(axes_[d], cell, s);
        for (int k = 0; k < 3; ++k) weights.w[d][k] = one.N[k], weights.dw[d][k] = one.dN[k];
      }
      use(base, weights, row.moment[0] / row.weight);
    }
  }

  const std::array<Axis, D>& axes_;
  const Shape<D>& shape_;
  const Index<D>& tile_;
  int count_ = 0;
  std::array<int, power(2, D)> corner_at_;
  std::array<NodeLanes, power(2, D)> corners_;  ///< rows of divergence [1/m]
  std::array<std::int16_t, n> slot_;
  std::array<Row, n> rows_;
};

}  // namespace tremie::detail
