#pragma once

// A step whose linear systems are solved by a factor of the matrix: any geometry, any solver.

#include <optional>

#include "libmpm/implicit/problem/side_walls.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie::detail {

/// Cells that were active before go on from their stresses and rates; new cells start unstressed.
template <class Geometry>
void carry_over_admm_state(const IndexMap<Geometry::dim>& old_map, const ActiveGrid<Geometry::dim>& grid,
                           AdmmState<Geometry>& admm_state) {
  AdmmState<Geometry> now;
  now.resize(grid.cell_index.size());
  if (!admm_state.wall_share.empty()) now.wall_share.assign(grid.cell_index.size(), walls_hold_all<Geometry>);
  for (int c = 0; c < grid.n_cells() && !old_map.value.empty(); ++c)
    if (const int old = old_map.at(grid.cell_index[c]); old >= 0) {
      now.stress[c] = admm_state.stress[old];
      now.rate[c] = admm_state.rate[old];
      if (!now.wall_share.empty()) now.wall_share[c] = admm_state.wall_share[old];
    }
  admm_state = std::move(now);
}

/// Weight and inertia that the residual of a Newton step is measured against [N].
template <class Geometry>
double force_scale(const ImplicitBody<Geometry>& body, double dt) {
  double scale = 0.0;
  for (int i = 0; i < body.grid.n_nodes(); ++i)
    scale += body.nodes.mass[i] * (body.gravity.norm() + 1e-3 * body.nodes.v[i].norm() / dt);
  return scale;
}

struct ByFactors {
  /// Cells go on from the stresses and rates of the last step, in whichever form that had them.
  template <class Geometry>
  static void carry_over(const IndexMap<Geometry::dim>& old_cells, const YieldLaw& law,
                         ImplicitBody<Geometry>& body) {
    if constexpr (Geometry::dim == 3)
      if (!body.admm_state.packed.empty()) body.admm_state = unpack(law, body.admm_state.packed);
    carry_over_admm_state<Geometry>(old_cells, body.grid, body.admm_state);
  }

  /// What another try at the step starts from: the ADMM state that the step began with.
  template <class Geometry>
  static std::optional<AdmmState<Geometry>> first_guess(const ImplicitBody<Geometry>& body) {
    return body.admm_state;
  }
  template <class Geometry>
  static void guess_again(const std::optional<AdmmState<Geometry>>& first, const StepSettings&, double,
                          ImplicitBody<Geometry>& body) {
    if (first) body.admm_state = *first;
  }

  /// Stress of the yield part at quadrature point k of cell c.
  template <class Geometry>
  static Vec<Geometry::n_strain> stress(const YieldLaw&, const AdmmState<Geometry>& admm_state, int c,
                                        int k) {
    return admm_state.stress[c][k];
  }

  /// Solves with the chosen method; `automatic` is ADMM, and Newton where ADMM does not converge. With bars or several
  /// viscosities it is ADMM alone.
  template <class Geometry>
  static SolveReport solve(YieldProblem<Geometry>& problem, const YieldLaw& law, const StepSettings& settings,
                           ImplicitBody<Geometry>& body) {
    const double scale = force_scale(body, problem.dt);
    body.system.set_pattern(body.grid);
    const bool newton = problem.bars.empty() && problem.quadrature.mu.empty();
    if (settings.method == YieldMethod::newton && newton)
      return solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
    FactorisedAdmm<Geometry> form{problem, law, settings.admm, body.system, body.admm_state};
    SolveReport report = solve_admm(problem, settings.admm, form, body.v);
    if (report.converged || settings.method == YieldMethod::admm || !newton) return report;
    const int before = report.iterations;
    report = solve_newton(problem, law, settings.newton, scale, body.system, body.v, body.admm_state);
    report.iterations += before;
    return report;
  }

  /// Mean shear rate of every cell over its quadrature points, and the volume mean of all [1/s].
  template <class Geometry>
  static double shear_rates(const YieldProblem<Geometry>& problem, const ImplicitBody<Geometry>& body,
                            std::vector<double>& of_cell) {
    double sum = 0.0, volume = 0.0;
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

  /// Nodal displacements that even out the fill of the cells.
  template <class Geometry>
  static std::vector<Vec<Geometry::dim>> shifting(const YieldProblem<Geometry>& problem,
                                                  const CellFill& cells, ImplicitBody<Geometry>& body) {
    return shifting_displacement(problem, cells, body.system);
  }

  /// Gives back memory until the next step.
  template <class Geometry>
  static void release(ImplicitBody<Geometry>&) {}
};

}  // namespace tremie::detail
