#pragma once

// Parts of an explicit step: sorting the points, and how long the next step is.

#include "libmpm/explicit/nodes.hpp"

namespace tremie {

/// Brings the state of the points to body.points.
template <class Geometry>
void write_back(ExplicitState<Geometry>& state, Body<Geometry>& body) {
  write_back<Geometry::dim>(state.points, state.grid.axes, body.points);
}

namespace detail {

/// Points are sorted anew before any can have left the cells that its tile sees: one cell beyond its own. A
/// step may add half a cell.
inline constexpr double drift_allowed = 0.45;

/// Sorting takes as long as this many passes over points that are no longer with those of their cell, more
/// than over those that are.
inline constexpr double passes_for_sorting = 4.0;
/// In single precision it takes as long as this many runs of one stencil more, for each group.
inline constexpr double runs_for_sorting = 60.0;

template <class Geometry>
void sort_points(const ExplicitSettings& settings, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  auto sorted = sort_into_tiles<D>(state.grid.axes, state.shape.stencil_shift(), state.points,
                                   settings.single_precision);
  lay_tiles(state.grid, std::move(sorted.tiles), settings.transfer.flip);
  for (NodeBlock<D>& block : state.grid.blocks)
    block.on_walls = nodes_on_walls<D>(state.grid.axes, state.shape, block.at);
  state.drift = 0.0;
  state.mixed_groups = settings.single_precision ? -1 : sorted.mixed;
  state.mixed_since = 0;
  state.wall_drift = state.holding.drift = 1e300;
  ++state.sorts;
}

/// Whether the points have drifted too far, or sorting them again pays.
template <class Geometry>
bool should_sort(const ExplicitState<Geometry>& state) {
  const double paid = static_cast<double>(state.mixed_since),
               price = state.grid.single ? runs_for_sorting : passes_for_sorting;
  return state.drift > drift_allowed || paid > price * static_cast<double>(state.points.groups());
}

/// The limits of the step to come, and its length.
template <class Geometry, class Law>
void choose_next_step(const Body<Geometry>& body, const Law& law, const ExplicitSettings& settings,
                      ExplicitState<Geometry>& state) {
  double h = state.grid.axes[0].h;
  for (const Axis& a : state.grid.axes) h = std::min(h, a.h);
  const double tau_y = static_yield_stress(state.lambda_max, body.mix.tau_0);
  state.limits = stability_limits(body.mix, law, tau_y, largest_eigenvalues(state.shape.kind), h);
  state.next_dt = settings.fixed_dt.value_or(
      std::min({settings.dt_max, settings.safety * state.limits.together,
                state.max_speed > 0.0 ? settings.cfl * h / state.max_speed : settings.dt_max}));
}

}  // namespace detail
}  // namespace tremie
