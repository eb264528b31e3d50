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

/// How far points may drift, in cells, before they are sorted anew: a step may add half a cell, and a tile sees one
/// beyond its own. Rows that follow the points miss what has come into their cell from the next tile: sooner for them.
inline double drift_allowed(const ExplicitSettings& settings) {
  return settings.stress == StressUpdate::last && settings.cell_pressure ? 0.1 : 0.45;
}

template <class Real, class Geometry>
void sort_points(const ExplicitSettings& settings, ExplicitState<Geometry>& state) {
  constexpr int D = Geometry::dim;
  lay_tiles<Real, D>(state.grid,
                     sort_into_tiles<D>(state.grid.axes, state.shape.stencil_shift(), state.points),
                     settings.transfer.flip);
  state.drift = 0.0;
  state.wall_drift = state.holding.drift = 1e300;
  ++state.sorts;
}

/// The limits of the step to come, and its length.
template <class Geometry>
void choose_next_step(const Body<Geometry>& body, const YieldLaw& law, const ExplicitSettings& settings,
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
