#pragma once

// The convex problem of a step over dt: inertia with gravity, viscosity and yield, bulk, and all walls.

#include <optional>
#include <type_traits>

#include "libmpm/boundary/flat_walls.hpp"
#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/implicit/bar_drag.hpp"
#include "libmpm/implicit/free_surface.hpp"
#include "libmpm/implicit/problem/cell_weights.hpp"
#include "libmpm/implicit/problem/wetted_areas.hpp"
#include "libmpm/implicit/strip_stress.hpp"

namespace tremie::detail {

/// What two layers one behind the other take, each from its own speed, where the speeds add up to `speed`: as one yield
/// stress and the drag that gives the rest at this speed.
inline WallStress in_series(WallStress first, WallStress then, double speed) {
  if (then.yield < first.yield) std::swap(first, then);
  const double alone = first.viscous > 0.0 ? (then.yield - first.yield) / first.viscous : unbounded;
  if (speed <= alone) return first;
  const double both = then.viscous > 0.0 ? 1.0 / (1.0 / first.viscous + 1.0 / then.viscous) : 0.0;
  return {first.yield, (then.yield - first.yield + both * (speed - alone)) / speed};
}

/// The side walls of a section averaged over the width W. Where the concrete sticks to them, they hold each node with their share
/// of the yield stress (side_walls.hpp) and, for the parabola between two plates, the viscous stress 6 mu v / W on both sides; a
/// layer at the wall that slides is in series with that.
template <class Geometry>
void add_side_walls(double W, const YieldLaw& law, const WallLaw& wall_law,
                    const std::vector<Vec<Geometry::dim>>& v, YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  std::vector<double> V(grid.node_index.size(), 0.0), limit = V;
  std::vector<double> mu_V(problem.quadrature.mu.empty() ? 0 : V.size(),
                           0.0);  // where it is not one everywhere
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < power(2, D); ++k) {
      const Stencil<D> st = stencil<D>(grid.axes, grid.cell_index[c], problem.quadrature.place[c][k]);
      for (int i = 0; i < power(3, D); ++i) {
        V[grid.cell_nodes[c][i]] += st.N[i] * problem.quadrature.V[c][k];
        limit[grid.cell_nodes[c][i]] +=
            st.N[i] * problem.quadrature.V[c][k] * problem.quadrature.wall_yield[c][k] * 2.0 / W;
        if (!mu_V.empty())
          mu_V[grid.cell_nodes[c][i]] += st.N[i] * problem.quadrature.V[c][k] * problem.quadrature.mu[c][k];
      }
    }
  fold_mirrors<D>(grid, V);
  fold_mirrors<D>(grid, limit);
  if (!mu_V.empty()) fold_mirrors<D>(grid, mu_V);
  const std::optional<WallStress> layer = wall_stress(wall_law);
  for (std::size_t i = 0; i < V.size(); ++i) {
    const double tau_y = V[i] > 0.0 ? 0.5 * W * limit[i] / V[i] : 0.0;
    const double own = mu_V.empty() || !(V[i] > 0.0) ? problem.mu : mu_V[i] / V[i],
                 mu = own + viscosity(law, 6.0 * v[i].norm() / W, tau_y);
    NodeTerm<D> held;
    held.node = static_cast<int>(i);
    held.normal_axis = -1;
    held.reach = W / std::sqrt(12.0);
    held.limit = limit[i];
    held.viscous = 12.0 * mu / (W * W) * V[i];
    if (layer) {
      const WallStress both = in_series(*layer, {tau_y, 6.0 * mu / W}, v[i].norm());
      held.limit = 2.0 / W * V[i] * both.yield, held.viscous = 2.0 / W * V[i] * both.viscous;
    }
    problem.wall_nodes.push_back(held);
  }
}

/// A wall law that holds with a stress does so on the area that is wetted. One that holds with more than the concrete's
/// yield stress must not be the laxer for it.
template <class Geometry>
void set_wall_stresses(const WallLaw& law, double tau_0, YieldProblem<Geometry>& problem) {
  const std::optional<WallStress> stress = wall_stress(law);
  if (!stress || problem.wall_nodes.empty()) return;
  const NodeAreas<Geometry::dim> areas = wetted_areas(problem.grid, problem.quadrature);
  for (auto& t : problem.wall_nodes) {
    const double area = areas[t.node][std::max(0, t.normal_axis)];
    t.limit = stress->yield * area;
    t.scale = std::max(tau_0, no_stress) * area;
    t.viscous = stress->viscous * area;
  }
}

/// What the nodes' velocities become over dt by gravity alone.
template <class Geometry>
void add_gravity(ImplicitBody<Geometry>& body, WeightRule rule, const std::vector<Vec<Geometry::dim>>& v_old,
                 double dt) {
  for (std::size_t i = 0; i < v_old.size(); ++i) body.nodes.v[i] = v_old[i] + dt * body.gravity;
  if constexpr (std::is_same_v<Geometry, ThreeD>) {
    const std::vector<double> weight = node_weights(body.grid, body.points, body.quadrature);
    for (std::size_t i = 0; i < v_old.size(); ++i)
      if (body.nodes.mass[i] > 0.0)
        body.nodes.v[i] += dt * (weight[i] / body.nodes.mass[i] - 1.0) * body.gravity;
  } else if constexpr (requires { Geometry::up; }) {
    if (rule == WeightRule::points) return;
    const auto force = balanced_weights(body.grid, body.points, body.quadrature, body.gravity,
                                        rule == WeightRule::balanced_inside);
    for (std::size_t i = 0; i < v_old.size(); ++i)
      if (body.nodes.mass[i] > 0.0) body.nodes.v[i] = v_old[i] + dt / body.nodes.mass[i] * force[i];
  }
}

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
    if (t.limit == 0.0) t.force.setZero();
  }
}

/// The step's convex problem over dt: inertia with gravity, viscosity and yield, bulk, walls.
template <class Geometry>
void pose(ImplicitBody<Geometry>& body, const YieldLaw& law, const StepSettings& settings,
          const RigidWall<Geometry::dim>& wall, const std::vector<Vec<Geometry::dim>>& v_old,
          const IndexMap<Geometry::dim>& old_nodes, double dt, std::optional<YieldProblem<Geometry>>& posed) {
  constexpr int D = Geometry::dim;
  body.v = v_old;
  add_gravity(body, settings.weight, v_old, dt);
  posed.emplace(YieldProblem<Geometry>{
      body.grid, body.quadrature, body.nodes, dt, body.mix.mu, body.mix.K, {}, {}, {}, {}, {}, {}, {}});
  posed->eta += viscosity(
      law, std::clamp(body.shear_rate, viscosity_scale_rates[0], viscosity_scale_rates[1]), body.mix.tau_0);
  posed->zeta = settings.alternating_viscosity * posed->eta;
  apply_flat_walls<D>(body.grid, body.walls, posed->fixed, posed->wall_nodes, body.v);
  apply_blocks<D>(body.grid, posed->fixed, body.v);
  apply_sheets<D>(body.grid, posed->fixed, posed->wall_nodes, body.v);
  fill_mirrors<D>(body.grid, body.v);
  set_wall_stresses(settings.wall_law, body.mix.tau_0, *posed);
  if (settings.side_wall_distance > 0.0)
    add_side_walls(settings.side_wall_distance, law, settings.wall_law, body.v, *posed);
  posed->drag = viscous_drag(posed->wall_nodes, body.v.size());
  posed->bound = find_penalty_points(body.grid, body.nodes, body.boundary, dt, settings.boundary_stiffness);
  if (!body.bars.empty()) add_bars(body, law, *posed);
  if (!body.strips.empty())
    if (const std::optional<WallStress> stress = wall_stress(settings.wall_law))
      add_strips(body, *stress, static_cast<int>(body.bars.size()), *posed);
  if constexpr (requires { Geometry::up; })
    if (settings.moving_surface) posed->surface = surface_of_pool(body, dt);
  carry_over_terms<Geometry>(body.wall_nodes, old_nodes, settings.wall_law, body.grid, posed->wall_nodes);
  posed->contact = find_contact(body.grid, body.points, wall, body.time + dt, dt, settings.wall_gap,
                                settings.wall_penalty, body.mix.K);
  update_active<D>(posed->contact, body.grid.cell_nodes, body.v);
}

}  // namespace tremie::detail
