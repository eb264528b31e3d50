#pragma once

// One divergence and one pressure row a cell, against locking.
//
// All points of a cell change their volume with the divergence at one place of it, and their pressures push
// by the same row: what a change of volume costs is what the pressure does.
//
// The place is the centre of mass of the points: at the cell's own centre the row would push controls that
// the points hardly reach, in a cell that they have just entered, by any multiple of the control's mass.
// (With the row at the mean place s of the points, a control whose spline is s^2/2 has at least the mass of
// s^2/2 of them, and slope s.) GIMP's steps with the stress first read the divergence from velocities that
// the points have brought to the grid, which know nothing of such a push: there the place is the cell's
// centre, whose row is the same in every cell. But in a cell at a wall that holds it is as high as the points
// on average: where they fill the upper half alone, what they carry away is what the cell loses, and with the
// rate at the centre it would stay hollow.

#include "libmpm/space/gradients.hpp"
#include "libmpm/step/explicit_body.hpp"
#include "libmpm/transfer/lane_sums.hpp"

namespace tremie::detail {

/// Node: of the tile's controls that the rows read and push.
template <class Space, class Node>
class PressureCells {
 public:
  static constexpr int D = Space::dim, n = power(tile_pressure_cells, D);
  using Real = std::remove_cvref_t<decltype(Node{}[0])>;
  using Cube = NodeCube<Node, TileGrid<D>::tile_nodes>;

  /// `held`: the tile's cells at walls that hold, if there are any. Without `wanted` nothing may be entered.
  PressureCells(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile,
                StressUpdate stress, const HeldCells<D>* held, bool wanted)
      : axes_(axes),
        shape_(shape),
        tile_(tile),
        follows_(shape.kind == ShapeFunctions::b_spline || stress == StressUpdate::last),
        held_(held) {
    if (!wanted) return;
    slot_.fill(-1);
    for (int d = 0; d < D; ++d) {
      origin_[d] = axes[d].origin, per_cell_[d] = 1.0 / axes[d].h, first_[d] = tile[d] * tile_cells;
      along_[d][d] = static_cast<Real>(per_cell_[d]);
      for (int e = 0; e < D; ++e) across_[d][e] = e == d ? 0 : 1;
    }
  }

  /// Whether a row's place is known only when all points have entered.
  bool follows_points() const { return follows_; }

  /// Enters the cells of the points of group g, with their places.
  void add_group(const LanePoints<D>& points, std::size_t g, std::array<int, octet_size>& cells) {
    const std::array<Octet, D> x = places_of<D>(points, g);
    find_pressure_cells<D>(axes_, shape_, tile_, x, cells);
    if (!follows_) {
      for (const int cell : cells) row_of(cell);
      return;
    }
    Octet column[4] = {};
    column[D] = points.mass[g];
    for (int d = 0; d < D; ++d) column[d] = column[D] * x[d];
    if (in_one(cells)) {
      Row& row = row_of(cells[0]);
      for (int c = 0; c <= D; ++c) row.moment[c] += sum(column[c]);
      return;
    }
    NodeLanes moment[octet_size];
    to_rows(column, moment);
    for (std::size_t l = 0; l < octet_size; ++l)
      if (moment[l][D] > 0.0) row_of(cells[l]).moment += moment[l];
  }

  /// Divergence of a cell whose points have all entered, read from the velocities the first time.
  double divergence(const Cube& v, int cell) {
    Row& row = row_of(cell);
    if (!row.read) row.read = true, row.divergence = read_divergence(v, row);
    return row.divergence;
  }

  /// Adds the impulses of n points, pressure times volume times step.
  void push(const std::array<int, octet_size>& cells, int points, const Octet& impulse) {
    if (in_one(cells)) {
      row_of(cells[0]).impulse += sum(impulse);
      return;
    }
    for (int l = 0; l < points; ++l) row_of(cells[static_cast<std::size_t>(l)]).impulse += impulse[l];
  }

  void scatter_impulses(Cube& sums) {
    for (int i = 0; i < count_; ++i) {
      Row& row = rows_[i];
      settle(row);
      if (at_corners()) {
        with_corners(row, [&](int at, const auto& slopes) {
          store_two(load_two(&sums[at]) + static_cast<Real>(row.impulse) * slopes, &sums[at]);
        });
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
    bool settled, read;
    double divergence, impulse, x_0;
    NodeLanes moment;  ///< mass times place, and mass; once settled, the place in the cell
  };

  double read_divergence(const Cube& v, Row& row) {
    settle(row);
    double divergence = 0.0;
    if (at_corners()) {
      decltype(load_two(&v[0])) total = {};
      with_corners(row, [&](int at, const auto& slopes) { total += slopes * load_two(&v[at]); });
      const Node both = __builtin_shufflevector(total, total, 0, 1, 2, 3) +
                        __builtin_shufflevector(total, total, 4, 5, 6, 7);
      Real sum = both[0];
      for (int d = 1; d < D; ++d) sum += both[d];
      return static_cast<double>(sum);
    }
    with_row(row, [&](int base, const auto& weights, double x_0) {
      constexpr int width = std::remove_cvref_t<decltype(weights)>::n_controls;
      const auto at = gather<D, width, slopes_only>(&v[base], weights);
      double L[D][D], q[Space::n_strain];
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) L[a][b] = at.slope[b][a];
      const double v_0 = at.value[0];
      strain_rate_of<Space, double>(L, v_0, x_0, q, divergence);
    });
    return divergence;
  }

  Row& row_of(int cell) {
    if (slot_[cell] < 0) {
      slot_[cell] = static_cast<std::int16_t>(count_);
      rows_[count_] = Row{cell, false, false, 0.0, 0.0, 0.0, NodeLanes{}};
      ++count_;
    }
    return rows_[slot_[cell]];
  }

  static bool in_one(const std::array<int, octet_size>& cells) {
    bool one = true;
    for (const int cell : cells) one = one && cell == cells[0];
    return one;
  }

  static Index<D> index_of(int cell) {
    Index<D> at;
    for (int d = D - 1; d >= 0; --d, cell /= tile_pressure_cells) at[d] = cell % tile_pressure_cells - 2;
    return at;
  }

  /// Finds the row's place: all points have entered.
  void settle(Row& row) {
    if (row.settled) return;
    row.settled = true;
    const Index<D> at = index_of(row.cell);
    NodeLanes cell = first_;
    for (int d = 0; d < D; ++d) cell[d] += at[d];
    if (follows_) {
      const NodeLanes x = row.moment * (1.0 / row.moment[D]);
      row.moment = (x - origin_) * per_cell_ - cell;
    } else {
      row.moment += 0.5;
      if (held_)
        for (int d = 0; d < D; ++d) row.moment[d] = static_cast<double>((*held_)[row.cell].place[d]);
    }
    row.x_0 = origin_[0] + (cell[0] + row.moment[0]) * axes_[0].h;
  }

  /// GIMP's rows are the slopes of the hats of the cell's corners. Averaged over an extent they would see
  /// other controls too, but no longer add up to a uniform push along a row of points.
  bool at_corners() const {
    return shape_.kind == ShapeFunctions::gimp && !std::is_same_v<Space, Axisymmetric>;
  }

  /// use(control, slopes in all directions of it and of the next) along the cell's edges in the last
  /// direction.
  template <class Use>
  void with_corners(const Row& row, Use use) const {
    const Index<D> at = index_of(row.cell);
    Node side[D][2];  // a corner's slopes are the product of its sides in all directions
    int base = 0;
    for (int d = 0; d < D; ++d) {
      base = base * tile_span + at[d] + 2;
      const auto s = static_cast<Real>(row.moment[d]);
      side[d][0] = (1 - s) * across_[d] - along_[d];
      side[d][1] = s * across_[d] + along_[d];
    }
    const auto last = both(side[D - 1][0], side[D - 1][1]);
    for (int i = 0; i < 2; ++i) {
      if constexpr (D == 2) {
        use(base + i * tile_span, last * both(side[0][i], side[0][i]));
      } else {
        for (int j = 0; j < 2; ++j) {
          const Node edge = side[0][i] * side[1][j];
          use(base + (i * tile_span + j) * tile_span, last * both(edge, edge));
        }
      }
    }
  }

  /// use(base, weights, first coordinate) at the row's place: three controls a direction, or the cell's two
  /// corners.
  template <class Use>
  void with_row(const Row& row, Use use) const {
    const Index<D> at = index_of(row.cell);
    if (shape_.kind == ShapeFunctions::gimp) {
      PointWeights<D, 2> weights{};
      int base = 0;
      for (int d = 0; d < D; ++d) {
        base = base * tile_span + at[d] + 2;
        weights.w[d][0] = 1.0 - row.moment[d], weights.w[d][1] = row.moment[d];
        weights.dw[d][1] = per_cell_[d], weights.dw[d][0] = -per_cell_[d];
      }
      use(base, weights, row.x_0);
      return;
    }
    PointWeights<D, 3> weights{};
    int base = 0;
    for (int d = 0; d < D; ++d) {
      base = base * tile_span + at[d] + 1;
      const SplineValues one = splines(axes_[d], tile_[d] * tile_cells + at[d], row.moment[d]);
      for (int k = 0; k < 3; ++k) weights.w[d][k] = one.N[k], weights.dw[d][k] = one.dN[k];
    }
    use(base, weights, row.x_0);
  }

  const std::array<Axis, D>& axes_;
  const Shape<D>& shape_;
  const Index<D>& tile_;
  bool follows_;  ///< the rows' places are those of the points
  const HeldCells<D>* held_;
  NodeLanes origin_ = {}, per_cell_ = {}, first_ = {};
  Node across_[D] = {}, along_[D] = {};  ///< ones but in direction d; 1/h in it
  int count_ = 0;
  std::array<std::int16_t, n> slot_;
  std::array<Row, n> rows_;
};

}  // namespace tremie::detail
