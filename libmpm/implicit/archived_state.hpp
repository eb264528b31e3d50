#pragma once

// What goes on from one implicit step to the next: a body that is read back steps to the same bits.

#include "libmpm/body/archive.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie {

template <int D>
inline constexpr bool stored_plainly<FrictionNode<D>> = true;
template <int D>
inline constexpr bool stored_plainly<BarDrag<D>> = true;
template <>
inline constexpr bool stored_plainly<PackedAdmmState::Batch> = true;

template <int D>
void visit(Archive& archive, Points<D>& points) {
  archive(points.x, points.v, points.C, points.mass, points.V0, points.ln_J, points.lambda, points.gamma_dot);
}

template <int D>
void visit(Archive& archive, IndexMap<D>& map) {
  archive(map.low, map.extent, map.value);
}

inline void visit(Archive& archive, PackedAdmmState& state) { archive(state.batch, state.r); }

template <class Geometry>
void visit(Archive& archive, AdmmState<Geometry>& state) {
  archive(state.stress, state.rate);
  if constexpr (Geometry::dim == 3) archive(state.packed);
}

/// Stresses, rates, friction and the drag of bars stand by the cells and nodes that were active in the last step. A
/// grid's axes and its blocks are the scene's; matrices and factors follow from the grid.
template <class Geometry>
void visit(Archive& archive, ImplicitBody<Geometry>& body) {
  archive(body.points, body.time, body.dt, body.motion, body.walls.v);
  archive(body.grid.cell_map, body.grid.node_map, body.admm_state, body.friction, body.bar_drag.drag);
  archive(body.quadrature.tau_y, body.time_error, body.shear_rate);
}

}  // namespace tremie
