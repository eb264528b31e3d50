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
// GIMP's steps with the stress first read the divergence from velocities that the points have brought to the
// grid, which know nothing of such a push: there the place is the cell's centre, whose row is the same in
// every cell. But in a cell at a wall that holds it is as high as the points on average: where they fill the
// upper half alone, what they carry away is what the cell loses, and with the rate at the centre it would
// stay hollow.

#include <bit>

#include "libmpm/explicit/body.hpp"
#include "libmpm/geometry/gradients.hpp"
#include "libmpm/transfer/simd_sums.hpp"

namespace tremie::detail {

/// `of`, and of[0] where the id is that of no point.
inline std::array<int, f64x8_size> in_place_of_none(const std::array<std::int32_t, f64x8_size>& id,
                                                    const std::array<int, f64x8_size>& of) {
  i32x8 ids, values;
  std::memcpy(&ids, id.data(), sizeof ids), std::memcpy(&values, of.data(), sizeof values);
  const i32x8 chosen = ids < 0 ? i32x8{} + of[0] : values;
  std::array<int, f64x8_size> result;
  std::memcpy(result.data(), &chosen, sizeof chosen);
  return result;
}

/// Node: of the tile's nodes that the rows read and push.
template <class Geometry, class Node>
class PressureCells {
 public:
  static constexpr int D = Geometry::dim, n = power(tile_pressure_cells, D);
  using Real = std::remove_cvref_t<decltype(Node{}[0])>;
  using Cube = NodeCube<Node, TileGrid<D>::tile_nodes>;

  /// `held`: the tile's cells at walls that hold, if there are any. Without `wanted` nothing may be entered.
  PressureCells(const std::array<Axis, D>& axes, const Index<D>& tile, const StencilFrame<D>& frame,
                StressUpdate stress, const HeldCells<D>* held, bool wanted)
      : axes_(axes),
        tile_(tile),
        frame_(frame),
        follows_(frame.kind == ShapeFunctions::b_spline || stress == StressUpdate::last),
        held_(held) {
    if (!wanted) return;
    entered_.fill(0), impulse_.fill(0.0);
    if (follows_) moment_.fill(f64x4{}), points_.fill(0);
    for (int d = 0; d < D; ++d) {
      origin_[d] = frame.axis[d].origin, per_cell_[d] = frame.axis[d].ih, first_[d] = frame.axis[d].first;
      along_[d][d] = static_cast<Real>(per_cell_[d]);
      for (int e = 0; e < D; ++e) across_[d][e] = e == d ? 0 : 1;
    }
    centre_ = edges_at(f64x4{} + 0.5);
  }

  /// Enters the points of group g: `cells` are theirs.
  void enter(const LanePoints<D>& points, std::size_t g, std::array<int, f64x8_size>& cells) {
    const std::array<f64x8, D> x = places_of<D>(points, g);
    find_pressure_cells<D, Real>(frame_, x, cells);
    // What fills up a group need not have stayed with its points: it must not enter a cell of its own.
    cells = in_place_of_none(points.id[g], cells);
    for (const int cell : cells) entered_[static_cast<std::size_t>(cell)] = 1;
    if (!follows_) return;
    f64x8 column[4] = {};
    column[D] = points.mass[g];
    for (int d = 0; d < D; ++d) column[d] = column[D] * x[d];
    f64x4 moment[f64x8_size];
    to_rows(column, moment);
    for (std::size_t l = 0; l < f64x8_size; ++l) moment_[static_cast<std::size_t>(cells[l])] += moment[l];
    if (frame_.kind != ShapeFunctions::b_spline) return;
    for (std::size_t l = 0; l < f64x8_size; ++l) {
      const auto c = static_cast<std::size_t>(cells[l]);
      if (moment[l][D] > 0.0 && points_[c] < few + 1) first_points_[c][points_[c]++] = moment[l];
    }
  }

  /// Reads the divergence of all cells, when all points have entered.
  void read(const Cube& v) {
    for_each_cell([&](std::size_t cell) { divergence_[cell] = read_divergence(v, cell); });
  }

  /// Of the cells of eight points.
  f64x8 divergence(const std::array<int, f64x8_size>& cells) const {
    return look_up(divergence_.data(), cells);
  }

  /// Adds the impulses of n points, pressure times volume times step.
  void push(const std::array<int, f64x8_size>& cells, int points, const f64x8& impulse) {
    for (int l = 0; l < points; ++l)
      impulse_[static_cast<std::size_t>(cells[static_cast<std::size_t>(l)])] += impulse[l];
  }

  /// Gives the nodes the impulses of all cells, when all points have pushed.
  void scatter_impulses(Cube& sums) {
    for_each_cell([&](std::size_t cell) {
      const double impulse = impulse_[cell];
      if (at_corners()) {
        with_corners(cell, [&](int at, const auto& slopes) {
          store_two(load_two(&sums[at]) + static_cast<Real>(impulse) * slopes, &sums[at]);
        });
        return;
      }
      with_rows(cell, [&](double share, int base, const auto& weights, double x_0) {
        constexpr int width = std::remove_cvref_t<decltype(weights)>::n_controls;
        f64x4 value = {}, slope[D] = {};
        const f64x4 moment[D] = {};
        if (std::is_same_v<Geometry, Axisymmetric>) value[0] = share * impulse / x_0;
        for (int d = 0; d < D; ++d) slope[d][d] = share * impulse;
        scatter<D, width>(&sums[base], weights, value, slope, moment);
      });
    });
  }

 private:
  /// Slopes of a cell's corners in all directions, two by two along its edges in the last.
  static constexpr int n_edges = power(2, D - 1);
  struct Edges {
    decltype(load_two(static_cast<const Node*>(nullptr))) of[n_edges];
  };

  /// use(cell) of all that have been entered, by their numbers: eight at once are asked.
  template <class Use>
  void for_each_cell(Use use) const {
    static_assert(std::endian::native == std::endian::little);
    for (std::size_t first = 0; first < entered_.size(); first += 8) {
      std::uint64_t eight;
      std::memcpy(&eight, &entered_[first], sizeof eight);
      for (; eight != 0; eight &= eight - 1)
        use(first + static_cast<std::size_t>(__builtin_ctzll(eight)) / 8);
    }
  }

  double read_divergence(const Cube& v, std::size_t cell) const {
    if (at_corners()) {
      decltype(load_two(&v[0])) total = {};
      with_corners(cell, [&](int at, const auto& slopes) { total += slopes * load_two(&v[at]); });
      const Node both = __builtin_shufflevector(total, total, 0, 1, 2, 3) +
                        __builtin_shufflevector(total, total, 4, 5, 6, 7);
      Real sum = both[0];
      for (int d = 1; d < D; ++d) sum += both[d];
      return static_cast<double>(sum);
    }
    double mean = 0.0;
    with_rows(cell, [&](double share, int base, const auto& weights, double x_0) {
      constexpr int width = std::remove_cvref_t<decltype(weights)>::n_controls;
      const auto at = gather<D, width, slopes_only>(&v[base], weights);
      double L[D][D], q[Geometry::n_strain], divergence;
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) L[a][b] = at.slope[b][a];
      const double v_0 = at.value[0];
      strain_rate_of<Geometry, double>(L, v_0, x_0, q, divergence);
      mean += share * divergence;
    });
    return mean;
  }

  static constexpr Index<D> index_of(std::size_t cell) {
    Index<D> at{};
    for (int d = D - 1; d >= 0; --d, cell /= tile_pressure_cells)
      at[d] = static_cast<int>(cell % tile_pressure_cells) - 2;
    return at;
  }

  /// Each cell's first corner among the nodes that the tile sees.
  static constexpr std::array<std::int16_t, n> first_corner = [] {
    std::array<std::int16_t, n> first{};
    for (std::size_t cell = 0; cell < first.size(); ++cell) {
      int at = 0;
      for (const int i : index_of(cell)) at = at * tile_span + i + 2;
      first[cell] = static_cast<std::int16_t>(at);
    }
    return first;
  }();

  /// Place in a cell of what has this moment: mass times place, and mass.
  f64x4 place_in(std::size_t cell, const f64x4& moment) const {
    const Index<D> at = index_of(cell);
    f64x4 begin = first_;
    for (int d = 0; d < D; ++d) begin[d] += at[d];
    return (moment * (1.0 / moment[D]) - origin_) * per_cell_ - begin;
  }

  /// Where the row of a cell is, in the cell.
  f64x4 place_of(std::size_t cell) const {
    if (follows_) return place_in(cell, moment_[cell]);
    f64x4 place = f64x4{} + 0.5;
    for (int d = 0; d < D && held_; ++d) place[d] = static_cast<double>((*held_)[cell].place[d]);
    return place;
  }

  /// GIMP's rows are the slopes of the hats of the cell's corners. Averaged over an extent they would see
  /// other nodes too, but no longer add up to a uniform push along a row of points.
  bool at_corners() const {
    return frame_.kind == ShapeFunctions::gimp && !std::is_same_v<Geometry, Axisymmetric>;
  }

  Edges edges_at(const f64x4& place) const {
    Node side[D][2];  // a corner's slopes are the product of its sides in all directions
    for (int d = 0; d < D; ++d) {
      const auto s = static_cast<Real>(place[d]);
      side[d][0] = (1 - s) * across_[d] - along_[d];
      side[d][1] = s * across_[d] + along_[d];
    }
    const auto last = both(side[D - 1][0], side[D - 1][1]);
    Edges edges;
    for (int e = 0; e < n_edges; ++e) {
      const Node edge = D == 2 ? side[0][e] : side[0][e / 2] * side[1][e % 2];
      edges.of[e] = last * both(edge, edge);
    }
    return edges;
  }

  /// use(node, slopes in all directions of it and of the next) along the cell's edges in the last
  /// direction.
  template <class Use>
  void with_corners(std::size_t cell, Use use) const {
    const int base = first_corner[cell];
    const bool at_centre = !follows_ && !held_;
    const Edges own = at_centre ? Edges{} : edges_at(place_of(cell));
    const Edges& edges = at_centre ? centre_ : own;
    for (int e = 0; e < n_edges; ++e)
      use(base + (D == 2 ? e : e / 2 * tile_span + e % 2) * tile_span, edges.of[e]);
  }

  /// Whether the few points of a cell together weigh less at one of its corners, by the product of their
  /// distances from the faces across, than half of what they would all at the mean of their places.
  bool leaves_out_a_corner(std::size_t cell) const {
    const std::size_t count = points_[cell];
    if (count == 1 || count > few) return false;
    const f64x4 mean = place_of(cell);
    f64x4 place[few];
    for (std::size_t p = 0; p < count; ++p) place[p] = place_in(cell, first_points_[cell][p]);
    for (int k = 0; k < power(2, D); ++k) {
      const Index<D> at = corner<D>(k);
      const auto weight = [&at](const f64x4& s) {
        double w = 1.0;
        for (int d = 0; d < D; ++d) w *= at[d] == 1 ? s[d] : 1.0 - s[d];
        return w;
      };
      double together = 0.0;
      for (std::size_t p = 0; p < count; ++p) together += first_points_[cell][p][D] * weight(place[p]);
      if (together < 0.5 * moment_[cell][D] * weight(mean)) return true;
    }
    return false;
  }

  /// use(share, base, weights, first coordinate) at the row's place, or at the points'.
  template <class Use>
  void with_rows(std::size_t cell, Use use) const {
    const auto at_place = [&](const f64x4& place, double share) {
      with_row(cell, place,
               [&](int base, const auto& weights, double x_0) { use(share, base, weights, x_0); });
    };
    if (!follows_ || frame_.kind != ShapeFunctions::b_spline || !leaves_out_a_corner(cell)) {
      at_place(place_of(cell), 1.0);
      return;
    }
    for (std::size_t p = 0; p < points_[cell]; ++p) {
      const f64x4& point = first_points_[cell][p];
      at_place(place_in(cell, point), point[D] / moment_[cell][D]);
    }
  }

  /// use(base, weights, first coordinate) at a place in a cell: three nodes a direction, or the cell's two
  /// corners.
  template <class Use>
  void with_row(std::size_t cell, const f64x4& place, Use use) const {
    const Index<D> at = index_of(cell);
    const double x_0 = origin_[0] + (first_[0] + at[0] + place[0]) * frame_.axis[0].h;
    if (frame_.kind == ShapeFunctions::gimp) {
      PointWeights<D, 2> weights{};
      int base = 0;
      for (int d = 0; d < D; ++d) {
        base = base * tile_span + at[d] + 2;
        weights.w[d][0] = 1.0 - place[d], weights.w[d][1] = place[d];
        weights.dw[d][1] = per_cell_[d], weights.dw[d][0] = -per_cell_[d];
      }
      use(base, weights, x_0);
      return;
    }
    PointWeights<D, 3> weights{};
    int base = 0;
    for (int d = 0; d < D; ++d) {
      base = base * tile_span + at[d] + 1;
      const SplineValues one = splines(axes_[d], tile_[d] * tile_cells + at[d], place[d]);
      for (int k = 0; k < 3; ++k) weights.w[d][k] = one.N[k], weights.dw[d][k] = one.dN[k];
    }
    use(base, weights, x_0);
  }

  const std::array<Axis, D>& axes_;
  const Index<D>& tile_;
  const StencilFrame<D>& frame_;
  bool follows_;  ///< the rows' places are those of the points
  const HeldCells<D>* held_;
  f64x4 origin_ = {}, per_cell_ = {}, first_ = {};
  Node across_[D] = {}, along_[D] = {};                ///< ones but in direction d; 1/h in it
  Edges centre_;                                       ///< of a row at its cell's centre
  std::array<std::uint8_t, (n + 7) / 8 * 8> entered_;  ///< 1 where a cell has points
  std::array<double, n> divergence_, impulse_;
  // Where rows follow the points:
  static constexpr std::size_t few = 7;  ///< less than a cell is seeded with in space
  std::array<f64x4, n> moment_;          ///< mass times place, and mass
  std::array<std::uint8_t, n> points_;   ///< in a cell; one more than a few stands for all that are more
  std::array<std::array<f64x4, few + 1>, n> first_points_;  ///< their moments
};

}  // namespace tremie::detail
