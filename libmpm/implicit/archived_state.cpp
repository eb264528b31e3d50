#include "libmpm/implicit/archived_state.hpp"

#include "libmpm/geometry/spaces.hpp"

namespace tremie {

template <int D>
inline constexpr bool stored_plainly<NodeTerm<D>> = true;
template <int D>
inline constexpr bool stored_plainly<PointTerm<D>> = true;
template <>
inline constexpr bool stored_plainly<PackedAdmmState::Batch> = true;

template <int D>
void visit(Archive& archive, Points<D>& points) {
  archive(points.x, points.v, points.C, points.mass, points.V0, points.ln_J, points.lambda, points.gamma_dot,
          points.mix);
  for (std::vector<double>& part : points.lambda_parts) archive(part);
}

template <int D>
void visit(Archive& archive, IndexMap<D>& map) {
  archive(map.low, map.extent, map.value);
}

inline void visit(Archive& archive, PackedAdmmState& state) { archive(state.batch, state.r); }

template <class Geometry>
void visit(Archive& archive, AdmmState<Geometry>& state) {
  archive(state.stress, state.rate, state.wall_share);
  if constexpr (Geometry::dim == 3) archive(state.packed);
}

template <class Geometry>
void visit(Archive& archive, ImplicitBody<Geometry>& body) {
  archive(body.points, body.time, body.dt, body.motion, body.walls.v);
  archive(body.grid.cell_map, body.grid.node_map, body.admm_state, body.wall_nodes, body.bar_drag);
  archive(body.quadrature.tau_y, body.time_error, body.shear_rate);
}

#define TREMIE_ARCHIVED_IN(Geometry) template void visit(Archive&, ImplicitBody<Geometry>&);
TREMIE_IN_ALL_SPACES(TREMIE_ARCHIVED_IN)
template void visit(Archive&, Points<2>&);

}  // namespace tremie
