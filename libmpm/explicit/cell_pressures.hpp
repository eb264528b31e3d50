#pragma once

// One divergence and one pressure row a cell, against locking.
//
// All points of a cell change their volume with the divergence at one place of it, and their pressures push
// by the same row: what a change of volume costs is what the pressure does.
//
// The place is the centre of mass of the points: at the cell's own centre the row would push nodes that
// the points hardly reach, in a cell that they have just entered, by any multiple of the node's mass.
// (With the row at the mean place s of the points, a node whose spline is s^2/2 has at least the mass of
// s^2/2 of them, and slope s.) Of two points at two faces of a cell, though, none reaches the node across,
// which the row between them would push. So points that leave out a corner have the mean of their own rows:
// its slope squared is nowhere more than twice their share of the node's mass.
//
// GIMP's rows are the slopes of the hats of the cell's corners. Its steps with the stress first read the
// divergence from velocities that the points have brought to the grid, which know nothing of such a push: there
// the place is the cell's centre, whose row is the same in every cell. But in a cell at a wall that holds it is
// as high as the points on average: where they fill the upper half alone, what they carry away is what the cell
// loses, and with the rate at the centre it would stay hollow.

#include "libmpm/explicit/state.hpp"
#include "libmpm/transfer/tile_sums.hpp"

namespace tremie::detail {

/// Pressure cells of a group's points.
using GroupCells = std::array<int, f64x8_size>;

/// What fills up a group need not have stayed with its points: it is taken with the first of them.
template <class Real, int D>
GroupCells cells_of_group(const StencilFrame<Real, D>& frame, const LanePoints<D>& points, std::size_t g) {
  GroupCells cells = find_pressure_cells<Real, D>(frame, places_of<D>(points, g));
  for (auto l = static_cast<std::size_t>(filled<D>(points, g)); l < cells.size(); ++l) cells[l] = cells[0];
  return cells;
}

/// The pressure cells of one tile.
template <class Real, class Geometry>
class PressureCells {
 public:
  static constexpr int D = Geometry::dim, n = power(tile_pressure_cells, D);
  using Cube = NodeCube<Real, D>;

  /// `held`: the tile's cells at walls that hold, if there are any. Without `wanted` nothing may be entered.
  PressureCells(const std::array<Axis, D>& axes, const Index<D>& tile, const StencilFrame<Real, D>& frame,
                StressUpdate stress, const HeldCells<D>* held, bool wanted)
      : axes_(axes), tile_(tile), frame_(frame), held_(held) {
    splines_ = frame.kind == ShapeFunctions::b_spline, follows_ = splines_ || stress == StressUpdate::last;
    if (!wanted) return;
    points_.fill(0), impulse_.fill(0.0);
    if (follows_) moment_.fill(f64x4{});
  }

  /// Enters the points of group g, whose cells these are.
  void enter(const LanePoints<D>& points, std::size_t g, const GroupCells& cells) {
    for (int l = 0; l < filled<D>(points, g); ++l) {
      const auto c = static_cast<std::size_t>(cells[static_cast<std::size_t>(l)]);
      std::uint8_t& count = points_[c];
      if (follows_) {
        f64x4 moment = {};
        moment[D] = points.mass[g][l];
        for (int d = 0; d < D; ++d) moment[d] = points.mass[g][l] * points.x[d][g][l];
        moment_[c] += moment;
        if (splines_ && count <= few) first_points_[c][count] = moment;
      }
      if (count <= few) ++count;
    }
  }

  /// Reads the divergence of all cells, when all points have entered.
  void read(const Cube& v) {
    for_each_row([&](std::size_t cell, double share, std::size_t base, const Rows& rows) {
      RowOf<Real> sum = {};
      for_each_node_row([&](int r) { sum = sum + rows[r] * load_row<Real>(&v[base] + row_offset<D>(r)); });
      const NodeOf<Real> along = detail::sum_of_row<Real>(sum);
      for (int d = 0; d < D; ++d) divergence_[cell] += share * static_cast<double>(along[d]);
    });
  }

  /// Of the cells of eight points.
  f64x8 divergence(const GroupCells& cells) const {
    f64x8 of;
    for (std::size_t l = 0; l < cells.size(); ++l) of[l] = divergence_[cells[l]];
    return of;
  }

  /// Adds the impulses of n points, pressure times volume times step.
  void push(const GroupCells& cells, int points, const f64x8& impulse) {
    for (int l = 0; l < points; ++l) impulse_[cells[l]] += impulse[l];
  }

  /// Gives the nodes the impulses of all cells, when all points have pushed.
  void scatter_impulses(Cube& sums) {
    for_each_row([&](std::size_t cell, double share, std::size_t base, const Rows& rows) {
      const Real impulse = static_cast<Real>(share * impulse_[cell]);
      for_each_node_row([&](int r) {
        NodeOf<Real>* to = &sums[base] + row_offset<D>(r);
        store_row<Real>(load_row<Real>(to) + impulse * rows[r], to);
      });
    });
  }

 private:
  static constexpr bool hooped = std::is_same_v<Geometry, Axisymmetric>;
  /// What a velocity of each node is in the divergence of a cell, and a pressure's impulse at it.
  using Rows = RowOf<Real>[power(3, D - 1)];

  static Index<D> index_of(std::size_t cell) {
    Index<D> at{};
    for (int d = D - 1; d >= 0; --d, cell /= tile_pressure_cells)
      at[d] = static_cast<int>(cell % tile_pressure_cells) - 2;
    return at;
  }

  /// Place in a cell of what has this moment: mass times place, and mass.
  Vec<D> place_in(const Index<D>& cell, const f64x4& moment) const {
    Vec<D> place;
    for (int d = 0; d < D; ++d) {
      const StencilAxis<Real>& axis = frame_.axis[d];
      place[d] = (moment[d] / moment[D] - axis.origin) * axis.per_cell - axis.first - cell[d];
    }
    return place;
  }

  /// Where the row of a cell is, in the cell.
  Vec<D> place_of(std::size_t cell, const Index<D>& at) const {
    if (follows_) return place_in(at, moment_[cell]);
    Vec<D> place = Vec<D>::Constant(0.5);
    for (int d = 0; d < D && held_; ++d) place[d] = static_cast<double>((*held_)[cell].place[d]);
    return place;
  }

  /// Whether the few points of a cell together weigh less at one of its corners, by the product of their
  /// distances from the faces across, than half of what they would all at the mean of their places.
  bool leaves_out_a_corner(std::size_t cell, const Index<D>& in) const {
    const std::size_t count = points_[cell];
    if (count == 1 || count > few) return false;
    for (int k = 0; k < power(2, D); ++k) {
      const auto weight = [&in, at = corner<D>(k), this](const f64x4& moment) {
        const Vec<D> s = place_in(in, moment);
        double w = moment[D];
        for (int d = 0; d < D; ++d) w *= at[d] == 1 ? s[d] : 1.0 - s[d];
        return w;
      };
      double together = 0.0;
      for (std::size_t p = 0; p < count; ++p) together += weight(first_points_[cell][p]);
      if (together < 0.5 * weight(moment_[cell])) return true;
    }
    return false;
  }

  /// use(cell, share, base, rows) for all cells with points.
  template <class Use>
  void for_each_row(Use use) {
    const bool same = !follows_ && !held_ && !hooped;  // in every cell
    Rows rows;
    bool made = false;
    for (std::size_t cell = 0; cell < n; ++cell) {
      if (points_[cell] == 0) continue;
      const Index<D> at = index_of(cell);
      const auto with_row = [&](const Vec<D>& place, double share) {
        std::size_t base = 0;
        for (int d = 0; d < D; ++d)
          base = base * tile_span + static_cast<std::size_t>(at[d] + (splines_ ? 1 : 2));
        if (!same || !made) make_rows(at, place, rows);
        made = true;
        use(cell, share, base, rows);
      };
      if (splines_ && leaves_out_a_corner(cell, at))
        for (std::size_t p = 0; p < points_[cell]; ++p)
          with_row(place_in(at, first_points_[cell][p]), first_points_[cell][p][D] / moment_[cell][D]);
      else
        with_row(place_of(cell, at), 1.0);
    }
  }

  /// use(r) for the rows of nodes that a cell's row reaches: with hats, those of its corners.
  template <class Use>
  [[gnu::always_inline]] void for_each_node_row(Use use) const {
    for (int r = 0; r < power(3, D - 1); ++r)
      if (splines_ || (r % 3 < 2 && r / 3 < 2)) use(r);
  }

  void make_rows(const Index<D>& cell, const Vec<D>& place, Rows& rows) const {
    PointWeights<Real, D, 1> weights{};
    AtPoint<Real, D, 1> gradient = {};
    for (int d = 0; d < D; ++d) row_along(d, cell[d], place[d], weights), gradient.along[0][d][d] = 1;
    if (hooped)
      gradient.value[0] = static_cast<Real>(
          1.0 / (axes_[0].origin + (tile_[0] * tile_cells + cell[0] + place[0]) * axes_[0].h));
    for (RowOf<Real>& row : rows) row = RowOf<Real>{};
    scatter<D, 1, false, Real>(weights, gradient, rows);
  }

  /// A row's weights in direction d: three nodes, or the cell's two corners.
  void row_along(int d, int cell, double place, PointWeights<Real, D, 1>& weights) const {
    const double slope = 1.0 / axes_[d].h;
    const SplineValues spline = splines_ ? splines(axes_[d], tile_[d] * tile_cells + cell, place)
                                         : SplineValues{{1.0 - place, place, 0.0}, {-slope, slope, 0.0}};
    for (int k = 0; k < 3; ++k) {
      const auto w = static_cast<Real>(spline.N[k]), a = static_cast<Real>(spline.dN[k]);
      if (d < D - 1)
        weights.w[d][k] = w, weights.a[0][d][k] = a;
      else
        weights.w_row[k] = w, weights.a_row[0][k] = a;
    }
  }

  static constexpr std::size_t few = 7;  ///< less than a cell is seeded with in space

  const std::array<Axis, D>& axes_;
  const Index<D>& tile_;
  const StencilFrame<Real, D>& frame_;
  const HeldCells<D>* held_;
  bool splines_, follows_;              ///< follows: the rows' places are those of the points
  std::array<std::uint8_t, n> points_;  ///< in a cell; one more than a few stands for all that are more
  std::array<double, n> divergence_{}, impulse_;
  std::array<f64x4, n> moment_;                             ///< of its points: mass times place, and mass
  std::array<std::array<f64x4, few + 1>, n> first_points_;  ///< the moments of a few, where they are splines
};

}  // namespace tremie::detail
