#pragma once

// What wall terms at nodes take over from the last step. ADMM's stresses and rates: by_factors.hpp, by_iteration.hpp.

#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// Terms at nodes go on from the forces of the last step at the same nodes; so does a yield force that the pressure makes.
template <class Geometry>
void carry_over_terms(const std::vector<NodeTerm<Geometry::dim>>& old,
                      const IndexMap<Geometry::dim>& old_nodes, const WallLaw& law,
                      const ActiveGrid<Geometry::dim>& grid, std::vector<NodeTerm<Geometry::dim>>& terms) {
  std::vector<int> last_at(old_nodes.value.size(),
                           -1);  // by old node: the last of its entries, walls before held nodes
  for (std::size_t k = 0; k < old.size(); ++k) last_at[old[k].node] = static_cast<int>(k);
  for (auto& t : terms) {
    const int node = old_nodes.value.empty() ? -1 : old_nodes.at(grid.node_index[t.node]);
    if (node < 0 || last_at[node] < 0 || old[last_at[node]].normal_axis != t.normal_axis) continue;
    const NodeTerm<Geometry::dim>& before = old[last_at[node]];
    if (t.normal_axis >= 0 && follows_pressure(law)) t.limit = before.limit;
    t.force = before.force;
    t.slip = before.slip;
  }
}

}  // namespace tremie::detail
