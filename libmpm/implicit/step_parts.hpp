#pragma once

// The parts of a step that implicit_step.hpp puts together: walls, what is carried over from the last step,
// posing and solving its convex problem, updating the state.

#include <algorithm>
#include <cmath>
#include <optional>

#include "libmpm/boundary/rigid_wall.hpp"
#include "libmpm/implicit/state.hpp"
#include "libmpm/implicit/free_surface.hpp"
#include "libmpm/implicit/step_size.hpp"

namespace tremie::detail {

/// Whether the linear systems of a step are solved by iteration: a body in space that is not tiny.
template <class Geometry>
bool by_iteration(const ImplicitBody<Geometry>& body, const StepSettings& settings) {
  return Geometry::dim == 3 && settings.method != YieldMethod::newton &&
         body.grid.n_nodes() * Geometry::dim >= settings.admm.direct_below;
}

/// AdmmState of cells that were active before go on from where they were; new cells start unstressed.
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
template <class Geometry, class Law>
void carry_over_admm_state(const IndexMap<Geometry::dim>& old_map, const Law& law, const StepSettings& settings,
                 ImplicitBody<Geometry>& body) {
  if constexpr (Geometry::dim == 3) {
    AdmmState<ThreeD>& admm_state = body.admm_state;
    if (by_iteration(body, settings)) {
      if (!admm_state.stress.empty()) {
        const PackedAdmmState now = pack(admm_state, body.quadrature);
        admm_state = {};
        admm_state.space = now;
      }
      admm_state.space = carried(old_map, body.grid, admm_state.space);
      return;
    }
    if (!admm_state.space.empty()) admm_state = unpack(law, admm_state.space);
  }
  carry_over_admm_state<Geometry>(old_map, body.grid, body.admm_state);
}

/// Stress of the yield part at place k of cell c.
template <class Geometry, class Law>
Vec<Geometry::n_strain> stress_of(const Law& law, const AdmmState<Geometry>& admm_state, int c, int k) {
  if constexpr (Geometry::dim == 3)
    if (!admm_state.space.empty()) return stress_of(law, admm_state.space, c, k);
  return admm_state.stress[c][k];
}

/// Walls at the ends of the axes: which components they prescribe, and where friction acts. Nodes behind a
/// plane of symmetry are no unknowns.
template <int D>
void apply_flat_walls(const ActiveGrid<D>& grid, const WallVelocities<D>& walls, std::vector<char>& fixed,
                      std::vector<FrictionNode<D>>& friction, std::vector<Vec<D>>& v) {
  fixed.assign(grid.node_index.size() * D, 0);
  for (const MirrorNode<D>& m : grid.mirrors) std::fill_n(&fixed[m.node * D], D, 1);
  for (int i = 0; i < grid.n_nodes(); ++i) {
    if (fixed[i * D]) continue;
    for (int a = 0; a < D; ++a) {
      const Axis& axis = grid.axes[a];
      const int j = grid.node_index[i][a];
      const FaceKind face = axis.on_low_wall(j)    ? axis.low
                            : axis.on_high_wall(j) ? axis.high
                                                   : FaceKind::open;
      if (face == FaceKind::open) continue;
      for (int d = 0; d < D; ++d)
        if (d == a || face == FaceKind::no_slip) {
          fixed[i * D + d] = 1;
          v[i][d] = walls.v[a][axis.on_low_wall(j) ? 0 : 1][d];
        }
      if (face == FaceKind::friction) {
        FrictionNode<D> node;
        node.node = i;
        node.normal_axis = a;
        friction.push_back(node);
      }
    }
  }
}

/// Blocks prescribe the velocities of their nodes.
template <int D>
void apply_blocks(const ActiveGrid<D>& grid, std::vector<char>& fixed, std::vector<Vec<D>>& v) {
  if (grid.blocks.empty()) return;
  for (int i = 0; i < grid.n_nodes(); ++i) {
    const Block<D>* block = block_of_node<D>(grid, grid.node_index[i]);
    if (!block) continue;
    v[i] = block->velocity(grid.node_position(i));
    for (int d = 0; d < D; ++d) fixed[i * D + d] = 1;
  }
}

/// ln J of the points from the mean divergence of their cells, the same that the step's pressure used.
template <class Geometry>
void update_volumes(const YieldProblem<Geometry>& problem, const std::vector<Vec<Geometry::dim>>& v,
                    Points<Geometry::dim>& points) {
#pragma omp parallel for schedule(static)
  for (int c = 0; c < problem.grid.n_cells(); ++c) {
    const double d_ln_J = problem.dt * divergence(problem, v, c);
    for (int i = problem.grid.cell_begin[c]; i < problem.grid.cell_begin[c + 1]; ++i)
      points.ln_J[problem.grid.order[i]] += d_ln_J;
  }
}

/// lambda of every point, equation (3).
template <class Geometry>
void update_flocculation(const ImplicitBody<Geometry>& body, double dt, Points<Geometry::dim>& points) {
  std::vector<double> gamma_dot;
  shear_rate_at_points<Geometry>(body.grid, body.v, points, gamma_dot);
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < points.size(); ++p)
    points.lambda[p] = flocculation_step(points.lambda[p], *body.mix.thixotropy, body.mix.tau_0,
                                         points.gamma_dot[p], gamma_dot[p], dt);
  points.gamma_dot.swap(gamma_dot);
}

/// Mean shear rate of every cell over its Gauss places, and the volume mean of all [1/s].
template <class Geometry>
double shear_rates(const YieldProblem<Geometry>& problem, const StepSettings& settings, const ImplicitBody<Geometry>& body,
                   std::vector<double>& of_cell) {
  double sum = 0.0, volume = 0.0;
  if constexpr (Geometry::dim == 3)
    if (by_iteration(body, settings)) {
      body.matrix_free.shear_rates(problem, body.v, of_cell, sum);
      return sum;
    }
  of_cell.assign(body.grid.cell_index.size(), 0.0);
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < power(2, Geometry::dim); ++k) {
      const double gamma_dot = strain_rate(problem, body.v, c, k).norm();
      of_cell[c] += gamma_dot / power(2, Geometry::dim);
      sum += problem.quadrature.V[c][k] * gamma_dot;
      volume += problem.quadrature.V[c][k];
    }
  return volume > 0.0 ? sum / volume : 0.0;
}

/// Displacements that even out the fill of the cells.
template <class Geometry>
std::vector<Vec<Geometry::dim>> particle_shift(const YieldProblem<Geometry>& problem, const StepSettings& settings,
                                           const std::vector<double>& gamma_dot, ImplicitBody<Geometry>& body) {
  const CellFill cells = cell_fill(problem, body.points, gamma_dot, settings.particle_shifting);
  if constexpr (Geometry::dim == 3)
    if (by_iteration(body, settings)) return shifting_displacement_3d(problem, cells, body.matrix_free);
  return shifting_displacement(problem, cells, body.system);
}

/// Weight and inertia that the residual of a Newton step is measured against [N].
template <class Geometry>
double force_scale(const ImplicitBody<Geometry>& body, double dt) {
  double scale = 0.0;
  for (int i = 0; i < body.grid.n_nodes(); ++i)
    scale += body.nodes.mass[i] * (body.gravity.norm() + 1e-3 * body.nodes.v[i].norm() / dt);
  return scale;
}

/// Solves with the chosen method; `automatic` is ADMM, and Newton where ADMM does not converge.
template <class Geometry, class Law>
SolveReport solve_yield(YieldProblem<Geometry>& problem, const Law& law, const StepSettings& settings,
                        ImplicitBody<Geometry>& body) {
  if constexpr (Geometry::dim == 3)
    if (by_iteration(body, settings))
      return solve_admm_3d(problem, law, settings.admm, body.matrix_free, body.v, body.admm_state.space);
  const double scale = force_scale(body, problem.dt);
  body.system.set_pattern(body.grid);
  if (settings.method == YieldMethod::newton)
    return solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
  SolveReport report = solve_admm(problem, law, settings.admm, body.system, body.v, body.admm_state);
  if (report.converged || settings.method == YieldMethod::admm) return report;
  const int before = report.iterations;
  report = solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
  report.iterations += before;
  return report;
}

/// Normal forces of the friction nodes from the reactions; returns the relative change of their sum.
template <class Geometry, class Law>
double update_normal_forces(YieldProblem<Geometry>& problem, const Law& law, double coefficient,
                            const ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return problem.mu * q + stress_of(law, body.admm_state, c, k);
  };
  const Eigen::VectorXd R = residual(problem, body.v, stress);
  double change = 0.0, sum = 0.0;
  for (FrictionNode<D>& f : problem.friction) {
    if (f.normal_axis < 0) continue;
    // The reaction pushes into the concrete: against -e at a low wall, against +e at a high one.
    const bool low =
        problem.grid.axes[f.normal_axis].on_low_wall(problem.grid.node_index[f.node][f.normal_axis]);
    const double reaction = (low ? -1.0 : 1.0) * R[f.node * D + f.normal_axis];
    const double limit = coefficient * std::max(0.0, reaction);
    change += std::abs(limit - f.limit);
    sum += limit;
    f.limit = limit;
    const double size = f.force.norm();
    if (size > limit) f.force *= limit / size;
  }
  return sum > 0.0 ? change / sum : 0.0;
}

/// Forces of the flat walls, which balance what is left of every prescribed component, and the dissipated
/// power.
template <class Geometry, class Law>
void keep_forces(const YieldProblem<Geometry>& problem, const Law& law, ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  body.dissipation = 0.0;
  const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
    return problem.mu * q + stress_of(law, body.admm_state, c, k);
  };
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    for (int k = 0; k < power(2, D); ++k) {
      const auto q = strain_rate(problem, body.v, c, k);
      body.dissipation += problem.quadrature.V[c][k] * stress(c, k, q).dot(q);
    }
  const Eigen::VectorXd R = residual(problem, body.v, stress);
  body.wall_force.assign(body.v.size(), Vec<D>::Zero());
  for (int i = 0; i < problem.grid.n_nodes(); ++i)
    for (int d = 0; d < D; ++d)
      if (problem.fixed[i * D + d]) body.wall_force[i][d] = -R[i * D + d];
}

/// The side walls of a section averaged over the width W: the concrete sticks to them, so they hold each node
/// with the yield stress and, for the parabola between two plates, the viscous stress 6 mu v / W on both
/// sides.
template <class Geometry>
void add_side_walls(double W, YieldProblem<Geometry>& problem) {
  constexpr int D = Geometry::dim;
  const auto& grid = problem.grid;
  std::vector<double> V(grid.node_index.size(), 0.0), limit(grid.node_index.size(), 0.0);
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < power(2, D); ++k) {
      const Stencil<D> st = stencil<D>(grid.axes, grid.cell_index[c], problem.quadrature.place[c][k]);
      for (int i = 0; i < power(3, D); ++i) {
        V[grid.cell_nodes[c][i]] += st.N[i] * problem.quadrature.V[c][k];
        limit[grid.cell_nodes[c][i]] +=
            st.N[i] * problem.quadrature.V[c][k] * problem.quadrature.tau_y[c][k] * 2.0 / W;
      }
    }
  fold_mirrors<D>(grid, V);
  fold_mirrors<D>(grid, limit);
  problem.drag.resize(V.size());
  for (std::size_t i = 0; i < V.size(); ++i) {
    problem.drag[i] = 12.0 * problem.mu / (W * W) * V[i];
    FrictionNode<D> held;
    held.node = static_cast<int>(i);
    held.normal_axis = -1;
    held.reach = W / std::sqrt(12.0);
    held.limit = limit[i];
    problem.friction.push_back(held);
  }
}

/// Friction goes on from the forces of the last step at the same nodes.
template <class Geometry>
void carry_friction(const std::vector<FrictionNode<Geometry::dim>>& old, const IndexMap<Geometry::dim>& old_nodes,
                    const ActiveGrid<Geometry::dim>& grid, std::vector<FrictionNode<Geometry::dim>>& friction) {
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

/// The step's convex problem over dt: inertia with gravity, viscosity and yield, bulk, walls.
template <class Geometry>
void pose(ImplicitBody<Geometry>& body, const StepSettings& settings, const RigidWall<Geometry::dim>& wall,
          const std::vector<Vec<Geometry::dim>>& v_old, const IndexMap<Geometry::dim>& old_nodes, double dt,
          std::optional<YieldProblem<Geometry>>& posed) {
  constexpr int D = Geometry::dim;
  body.v = v_old;
  for (std::size_t i = 0; i < v_old.size(); ++i) body.nodes.v[i] = v_old[i] + dt * body.gravity;
  posed.emplace(YieldProblem<Geometry>{
      body.grid, body.quadrature, body.nodes, dt, body.mix.mu, body.mix.K, {}, {}, {}, {}, {}, {}});
  posed->zeta = settings.alternating_viscosity * body.mix.mu;
  apply_flat_walls<D>(body.grid, body.walls, posed->fixed, posed->friction, body.v);
  apply_blocks<D>(body.grid, posed->fixed, body.v);
  fill_mirrors<D>(body.grid, body.v);
  if (settings.side_wall_distance > 0.0) add_side_walls(settings.side_wall_distance, *posed);
  posed->bound = find_penalty_points(body.grid, body.nodes, body.boundary, dt, settings.boundary_stiffness);
  if constexpr (D == 2 && requires { Geometry::up; })
    if (settings.moving_surface) posed->surface = surface_of_pool(body, dt);
  carry_friction<Geometry>(body.friction, old_nodes, body.grid, posed->friction);
  posed->contact = find_contact(body.grid, body.points, wall, body.time + dt, dt, settings.wall_gap,
                                settings.wall_penalty, body.mix.K);
  update_active<D>(posed->contact, body.grid.cell_nodes, body.v);
}

/// Solves, with the normal forces of Coulomb friction frozen inside and renewed until they settle.
template <class Geometry, class Law>
SolveReport solve_step(YieldProblem<Geometry>& problem, const Law& law, const StepSettings& settings,
                       ImplicitBody<Geometry>& body) {
  SolveReport solve = solve_yield(problem, law, settings, body);
  for (int i = 0; i < 20 && !problem.friction.empty(); ++i) {
    if (update_normal_forces(problem, law, settings.friction_coefficient, body) < 0.02) break;
    const int before = solve.iterations;
    solve = solve_yield(problem, law, settings, body);
    solve.iterations += before;
  }
  return solve;
}

/// Whether the step would carry concrete so many cells or to nowhere: more of it than the share that may be
/// drops in the air. Nodes with next to no mass do not count: what they do moves no point.
template <class Geometry>
bool runs_away(const ImplicitBody<Geometry>& body, double share, double dt, double cells = 100.0) {
  const double reach = cells * body.grid.cell_size_min();
  double heaviest = 0.0, total = 0.0, gone = 0.0;
  for (double m : body.nodes.mass) heaviest = std::max(heaviest, m), total += m;
  for (std::size_t i = 0; i < body.v.size(); ++i) {
    if (!body.v[i].allFinite()) return true;
    const double m = body.nodes.mass[i];
    if (Geometry::advects && m > 1e-3 * heaviest && body.v[i].norm() * dt > reach) gone += m;
  }
  return gone > share * total;
}

/// Whether a long step carries more than some drops beyond a cell, or anything beyond ten: the speeds that it
/// was chosen for say nothing of what comes loose in it.
template <class Geometry>
bool starts_to_fall(const ImplicitBody<Geometry>& body, const StepSettings& settings, double dt) {
  return runs_away(body, detached_share, dt, 1.0) || runs_away(body, settings.detached, dt, 10.0);
}

/// The ADMM state that another try at a step over dt starts from: those that the step began with; in a large body,
/// where no room is spent on them, what the last try found, or none if that ran away.
template <class Geometry>
void guess_again(const std::optional<AdmmState<Geometry>>& first, const StepSettings& settings, double dt,
                 ImplicitBody<Geometry>& body) {
  if (first)
    body.admm_state = *first;
  else if constexpr (Geometry::dim == 3)
    if (runs_away(body, settings.detached, dt)) body.admm_state.space = zero_admm_state(body.grid.n_cells());
}

}  // namespace tremie::detail
