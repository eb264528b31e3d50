#pragma once

// After the solve: what the new velocities make of the state of the points, and what a step tells of itself.

#include "libmpm/implicit/solve.hpp"
#include "libmpm/particles/layer_mean.hpp"

namespace tremie::detail {

/// Forces of the flat walls, which balance what is left of every prescribed component, and the dissipated
/// power.
template <class Form, class Geometry>
void keep_forces(const YieldProblem<Geometry>& problem, const YieldLaw& law, ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  body.dissipation = 0.0;
  const auto stress = stress_in<Form, Geometry>(problem, law, body);
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

/// Sets the shear rate to 0 in cells whose stress is below the yield stress throughout: the grid's velocities keep the
/// solver's error there, some 1e-5 1/s, which breaks structure down where breakdown hardly depends on the rate.
template <class Form, class Geometry>
void clear_rigid_cells(const YieldProblem<Geometry>& problem, const YieldLaw& law,
                       const ImplicitBody<Geometry>& body, std::vector<double>& gamma_dot) {
  constexpr double yields = 1.0 - 1e-6;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < problem.grid.n_cells(); ++c) {
    bool rigid = true;
    for (int k = 0; k < power(2, Geometry::dim) && rigid; ++k)
      rigid = Form::stress(law, body.admm_state, c, k).norm() < yields * problem.quadrature.tau_y[c][k];
    for (int i = problem.grid.cell_begin[c]; rigid && i < problem.grid.cell_begin[c + 1]; ++i)
      gamma_dot[problem.grid.order[i]] = 0.0;
  }
}

/// lambda of every point, by the kinetics of the mix.
template <class Form, class Geometry>
void update_flocculation(const YieldProblem<Geometry>& problem, const YieldLaw& law,
                         const ImplicitBody<Geometry>& body, double dt, Points<Geometry::dim>& points) {
  std::vector<double> gamma_dot;
  shear_rate_at_points<Geometry>(body.grid, body.v, points, gamma_dot);
  if (is_exact(law) && slow_shear_breaks_down(body.mix.thixotropy->kinetics))
    clear_rigid_cells<Form>(problem, law, body, gamma_dot);
  if (const double layer = body.mix.thixotropy->layer; layer > 0.0)
    gamma_dot = layer_means<Geometry>(body.grid, points, gamma_dot, layer);
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < points.size(); ++p)
    points.lambda[p] = flocculation_step(points.lambda[p], *body.mix.thixotropy, body.mix.tau_0,
                                         points.gamma_dot[p], gamma_dot[p], dt,
                                         [&](std::size_t i) -> double& { return points.lambda_parts[i][p]; });
  points.gamma_dot.swap(gamma_dot);
}

}  // namespace tremie::detail
