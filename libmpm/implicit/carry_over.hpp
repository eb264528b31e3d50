#pragma once

// What a step takes over from the last one: ADMM's stresses and rates cell by cell, friction forces node by node.

#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// Whether the linear systems of a step are solved by iteration: a body in 3D that is not tiny.
template <class Geometry>
bool by_iteration(const ImplicitBody<Geometry>& body, const StepSettings& settings) {
  return Geometry::dim == 3 && settings.method != YieldMethod::newton &&
         body.grid.n_nodes() * Geometry::dim >= settings.admm.direct_below;
}

/// Cells that were active before go on from their stresses and rates; new cells start unstressed.
template <class Geometry>
void carry_over_admm_state(const IndexMap<Geometry::dim>& old_map, const ActiveGrid<Geometry::dim>& grid,
                           AdmmState<Geometry>& admm_state) {
  AdmmState<Geometry> now;
  now.stress.resize(grid.cell_index.size());
  now.rate.resize(grid.cell_index.size());
  for (int c = 0; c < grid.n_cells(); ++c) {
    const int old = old_map.value.empty() ? -1 : old_map.at(grid.cell_index[c]);
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      now.stress[c][k].setZero();
      now.rate[c][k].setZero();
      if (old < 0) continue;
      now.stress[c][k] = admm_state.stress[old][k];
      now.rate[c][k] = admm_state.rate[old][k];
    }
  }
  admm_state = std::move(now);
}

/// The same in the form that this step's solver takes, which may not be the last one's.
template <class Geometry>
void carry_over_admm_state(const IndexMap<Geometry::dim>& old_map, const YieldLaw& law,
                           const StepSettings& settings, ImplicitBody<Geometry>& body) {
  if constexpr (Geometry::dim == 3) {
    AdmmState<ThreeD>& admm_state = body.admm_state;
    if (by_iteration(body, settings)) {
      if (!admm_state.stress.empty()) {
        const PackedAdmmState now = pack(admm_state, body.quadrature);
        admm_state = {};
        admm_state.packed = now;
      }
      admm_state.packed = carried(old_map, body.grid, admm_state.packed);
      return;
    }
    if (!admm_state.packed.empty()) admm_state = unpack(law, admm_state.packed);
  }
  carry_over_admm_state<Geometry>(old_map, body.grid, body.admm_state);
}

/// Friction goes on from the forces of the last step at the same nodes.
template <class Geometry>
void carry_friction(const std::vector<FrictionNode<Geometry::dim>>& old,
                    const IndexMap<Geometry::dim>& old_nodes, const ActiveGrid<Geometry::dim>& grid,
                    std::vector<FrictionNode<Geometry::dim>>& friction) {
  std::vector<int> last_at(old_nodes.value.size(),
                           -1);  // by old node: the last of its entries, walls before held nodes
  for (std::size_t k = 0; k < old.size(); ++k) last_at[old[k].node] = static_cast<int>(k);
  for (auto& f : friction) {
    const int node = old_nodes.value.empty() ? -1 : old_nodes.at(grid.node_index[f.node]);
    if (node < 0 || last_at[node] < 0 || old[last_at[node]].normal_axis != f.normal_axis) continue;
    const FrictionNode<Geometry::dim>* it = &old[last_at[node]];
    if (f.normal_axis >= 0) f.limit = it->limit;
    f.force = it->force;
    f.slip = it->slip;
  }
}

}  // namespace tremie::detail
