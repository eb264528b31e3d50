#pragma once

// How hard the points in the cells at a wall hold.
//
// A front rolls over a floor that it sticks to, and its points never settle: half of the cells above the
// floor stays empty, and a sum over points gives the floor that share of the concrete's resistance
// (docs/theory/mpm_step.md). But a cell inside the body is full, by geometry: its points' viscous and
// yield stress is integrated over the whole cell. Pressure, mass and volume stay the points' own. The
// pressure's row moves to where the points are (cell_pressures.hpp), so that the flow fills what is hollow.

#include "libmpm/explicit/state.hpp"

namespace tremie {

namespace detail {

/// Points stand for four times their volume at most: a cell that has fewer would need shorter steps.
inline constexpr double most_hold = 4.0;
/// How far points may move, in cells, before the cells are looked into again.
inline constexpr double hold_drift = 0.05;

inline bool holds(FaceKind kind) { return kind == FaceKind::no_slip || kind == FaceKind::wall_law; }

/// Direction and side of a wall that holds the concrete in a cell; 0 in `into` where there is none.
struct HeldAt {
  int axis = 0, into = 0;
};
template <int D>
HeldAt held_at(const std::array<Axis, D>& axes, const Index<D>& cell) {
  for (int d = 0; d < D; ++d) {
    if (holds(axes[d].low) && cell[d] == 0) return {d, 1};
    if (holds(axes[d].high) && cell[d] == axes[d].n_cells - 1) return {d, -1};
  }
  return {};
}

/// Whether cells at a wall that holds, or the ones beside them, are among those of a tile.
template <int D>
bool near_holding_wall(const std::array<Axis, D>& axes, const Index<D>& tile) {
  for (int d = 0; d < D; ++d) {
    if (holds(axes[d].low) && tile[d] <= 0) return true;
    if (holds(axes[d].high) && (tile[d] + 1) * tile_cells + 3 > axes[d].n_cells) return true;
  }
  return false;
}

/// Share of each cell that is concrete, in a box around the tiles near walls.
template <class Geometry>
class CellFills {
 public:
  static constexpr int D = Geometry::dim;

  CellFills(const ExplicitState<Geometry>& state) : axes_(state.grid.axes) {
    Index<D> low, high;
    low.fill(std::numeric_limits<int>::max()), high.fill(std::numeric_limits<int>::min());
    for (const Tile<D>& tile : state.grid.tiles)
      for (int d = 0; d < D; ++d) {
        const int first = tile.at[d] * tile_cells;
        low[d] = axes_[d].periodic ? 0 : std::min(low[d], first - 3);
        high[d] = axes_[d].periodic ? axes_[d].n_cells : std::max(high[d], first + tile_cells + 3);
      }
    box_.reset(low, high);
    fill_.assign(box_.value.size(), {});
    for (const Tile<D>& tile : state.grid.tiles)
      if (near_holding_wall<D>(axes_, tile.at))
        for (int g = tile.first_group; g < tile.last_group; ++g)
          add_group(state.points, static_cast<std::size_t>(g));
  }

  double at(const Index<D>& cell) const { return fill_[number(cell)].share; }

  /// Mean distance of the points from the low face of a cell at a wall, in cells.
  double height(const Index<D>& cell) const {
    const Fill& of = fill_[number(cell)];
    return of.share > 0.0 ? of.height / of.share : 0.5;
  }

  /// Whether all cells around one hold concrete.
  bool inside(const Index<D>& cell) const {
    return is_surrounded<D>(axes_, cell, [&](const Index<D>& n) { return at(n) != 0.0; });
  }

 private:
  struct Fill {
    double share = 0.0,
           height = 0.0;  ///< of the cell's volume; sum of share times place along the wall's axis
  };

  std::size_t number(const Index<D>& cell) const {
    Index<D> in_box;
    for (int d = 0; d < D; ++d) in_box[d] = axes_[d].cell(cell[d]);
    return box_.offset(in_box);
  }

  void add_group(const LanePoints<D>& points, std::size_t g) {
    const f64x8 volume = points.V0[g] * exp(points.ln_J[g]);
    for (std::size_t l = 0; l < f64x8_size && points.id[g][l] >= 0; ++l) {
      Index<D> cell;
      Vec<D> middle, place;
      double full = 1.0;
      for (int d = 0; d < D; ++d) {
        const Axis& a = axes_[d];
        const double x = (points.x[d][g][l] - a.origin) / a.h, low = std::floor(x);
        cell[d] = static_cast<int>(low), place[d] = x - low;
        middle[d] = a.origin + (low + 0.5) * a.h;
        full *= a.h;
      }
      Fill& of = fill_[number(cell)];
      const double share = volume[l] / (full * Geometry::measure(middle));
      of.share += share;
      of.height += share * place[held_at<D>(axes_, cell).axis];
    }
  }

  const std::array<Axis, D>& axes_;
  IndexMap<D> box_;
  std::vector<Fill> fill_;
};

}  // namespace detail

/// What points in a cell at a wall stand for, in units of their own volume: a full cell where it is inside
/// the body, though not more than twice what the cell on its other side has.
template <class Geometry>
double represented_volume(const detail::CellFills<Geometry>& fills,
                          const std::array<Axis, Geometry::dim>& axes, const Index<Geometry::dim>& cell) {
  const detail::HeldAt wall = detail::held_at<Geometry::dim>(axes, cell);
  if (wall.into == 0 || fills.at(cell) == 0.0 || !fills.inside(cell)) return 1.0;
  Index<Geometry::dim> next = cell;
  next[wall.axis] += wall.into;
  return std::min(detail::most_hold, std::min(1.0, 2.0 * fills.at(next)) / fills.at(cell));
}

/// Looks into the cells at walls again where points have moved.
template <class Geometry>
void look_into_wall_cells(ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  Holding<D>& holding = state.holding;
  const auto& axes = state.grid.axes;
  if (holding.drift < detail::hold_drift) return;
  holding.drift = 0.0;
  holding.of_tile.assign(state.grid.tiles.size(), -1);
  holding.cells.clear();
  bool any = false;
  for (const Axis& a : axes) any = any || detail::holds(a.low) || detail::holds(a.high);
  if (!any) return;
  const detail::CellFills<Geometry> fills(state);
  for (std::size_t t = 0; t < state.grid.tiles.size(); ++t) {
    const Tile<D>& tile = state.grid.tiles[t];
    if (!detail::near_holding_wall<D>(axes, tile.at)) continue;
    holding.of_tile[t] = static_cast<int>(holding.cells.size());
    HeldCells<D>& held = holding.cells.emplace_back();
    for (int k = 0; k < power(tile_pressure_cells, D); ++k) {
      Index<D> cell;
      for (int d = D - 1, rest = k; d >= 0; --d, rest /= tile_pressure_cells)
        cell[d] = axes[d].cell(tile.at[d] * tile_cells + rest % tile_pressure_cells - 2);
      HeldCell<D>& held_cell = held[k];
      held_cell.hold = 1.0F;
      held_cell.place.fill(0.5F);
      const detail::HeldAt wall = detail::held_at<D>(axes, cell);
      if (wall.into == 0) continue;
      held_cell.hold = static_cast<float>(represented_volume<Geometry>(fills, axes, cell));
      held_cell.place[wall.axis] = static_cast<float>(fills.height(cell));
    }
  }
}

}  // namespace tremie
