#pragma once

// One divergence and one pressure row a cell, against locking.
//
// All points of a cell change their volume with the divergence at one place of it, and their pressures push
// by the same row: what a change of volume costs is what the pressure does. The place is the centre of mass
// of the points: at the cell's own centre the row would push controls that the points hardly reach, in a cell
// that they have just entered, by any multiple of the control's mass. (With the row at the mean place s of
// the points, a control whose spline is s^2/2 has at least the mass of s^2/2 of them, and slope s.) And where
// points fill the upper half of a cell alone, what they carry away is what the cell loses: with the rate at
// the centre the cell above the floor would stay hollow.

#include "libmpm/space/gradients.hpp"
#include "libmpm/step/explicit_body.hpp"
#include "libmpm/transfer/lane_sums.hpp"

namespace tremie::detail {

template <class Space>
class PressureCells {
 public:
  static constexpr int D = Space::dim, n = power(tile_pressure_cells, D);
  using Cube = std::array<NodeLanes, TileGrid<D>::tile_nodes>;

  PressureCells(const std::array<Axis, D>& axes, const Shape<D>& shape, const Index<D>& tile)
      : axes_(axes), shape_(shape), tile_(tile) {
    slot_.fill(-1);
  }

  /// Enters the cells of the points of group g, with their places.
  void add_group(const LanePoints<D>& points, std::size_t g, std::array<int, octet_size>& cells) {
    const std::array<Octet, D> x = places_of<D>(points, g);
    find_pressure_cells<D>(axes_, shape_, tile_, x, cells);
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

  void read_divergences(const Cube& v) {
    for (int i = 0; i < count_; ++i) {
      Row& row = rows_[i];
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
    double divergence, impulse;
    NodeLanes moment;  ///< mass times place, and mass
  };

  Row& row_of(int cell) {
    if (slot_[cell] < 0) {
      slot_[cell] = static_cast<std::int16_t>(count_);
      rows_[count_] = Row{cell, 0.0, 0.0, NodeLanes{}};
      ++count_;
    }
    return rows_[slot_[cell]];
  }

  static bool in_one(const std::array<int, octet_size>& cells) {
    bool one = true;
    for (const int cell : cells) one = one && cell == cells[0];
    return one;
  }

  /// use(base, weights, first coordinate) at the row's place: three controls a direction, or the cell's two
  /// corners where GIMP's points would see no other from there.
  template <class Use>
  void with_row(const Row& row, Use use) const {
    Index<D> at;
    std::array<double, D> s;  // place in the cell
    for (int d = D - 1, rest = row.cell; d >= 0; --d, rest /= tile_pressure_cells) {
      at[d] = rest % tile_pressure_cells - 2;
      const double x = (row.moment[d] / row.moment[D] - axes_[d].origin) / axes_[d].h;
      s[d] = x - (tile_[d] * tile_cells + at[d]);
    }
    const double x_0 = row.moment[0] / row.moment[D];
    if (shape_.kind == ShapeFunctions::b_spline) {
      PointWeights<D, 3> weights{};
      int base = 0;
      for (int d = 0; d < D; ++d) {
        base = base * tile_span + at[d] + 1;
        const SplineValues one = splines(axes_[d], tile_[d] * tile_cells + at[d], s[d]);
        for (int k = 0; k < 3; ++k) weights.w[d][k] = one.N[k], weights.dw[d][k] = one.dN[k];
      }
      use(base, weights, x_0);
    } else if (corners_alone(s)) {
      use_corners(at, s, x_0, use);
    } else {
      use_averaged_hats(at, s, x_0, use);
    }
  }

  bool corners_alone(const std::array<double, D>& s) const {
    bool alone = true;
    for (int d = 0; d < D; ++d) alone = alone && s[d] >= shape_.half[d] && s[d] <= 1.0 - shape_.half[d];
    return alone;
  }
  template <class Use>
  void use_corners(const Index<D>& at, const std::array<double, D>& s, double x_0, Use use) const {
    PointWeights<D, 2> weights{};
    int base = 0;
    for (int d = 0; d < D; ++d) {
      base = base * tile_span + at[d] + 2;
      weights.w[d][0] = 1.0 - s[d], weights.w[d][1] = s[d];
      weights.dw[d][1] = 1.0 / axes_[d].h, weights.dw[d][0] = -weights.dw[d][1];
    }
    use(base, weights, x_0);
  }
  template <class Use>
  void use_averaged_hats(const Index<D>& at, const std::array<double, D>& s, double x_0, Use use) const {
    const StencilFrame<D> frame = stencil_frame<D>(axes_, shape_, tile_);
    PointWeights<D, 3> weights{};
    int base = 0;
    for (int d = 0; d < D; ++d) {
      const int corner = std::clamp(at[d] + (s[d] < 0.5 ? 0 : 1), -1, tile_cells);
      base = base * tile_span + corner + 1;
      Octet w[3], dw[3], arm[3];
      gimp_weights(frame.axis[d], all_lanes(corner), all_lanes(at[d] + s[d] - corner), w, dw, arm);
      for (int k = 0; k < 3; ++k) weights.w[d][k] = w[k][0], weights.dw[d][k] = dw[k][0];
    }
    use(base, weights, x_0);
  }

  const std::array<Axis, D>& axes_;
  const Shape<D>& shape_;
  const Index<D>& tile_;
  int count_ = 0;
  std::array<std::int16_t, n> slot_;
  std::array<Row, n> rows_;
};

}  // namespace tremie::detail
