#include "libmpm/implicit/steady/steady_flow.hpp"

namespace tremie {
namespace {

constexpr double no_mass = 1e-9;  // of a node [kg]: the flow has no inertia
constexpr double bulk_stiffness =
    1e4;  // K dt over the viscosity: the flow changes its volume by 1e-4 of its shear
constexpr double tolerance = 3e-4;  // of the stress residuals, relative to the stresses
constexpr double penalty = 3.0;     // r over the viscosity at the typical rate

/// r over the viscosity that scales the problem: as stiff as the concrete is at the typical rate. A multiple of the
/// plastic viscosity alone would leave a yield stress that dwarfs it unconverged.
double penalty_at(const SteadyBody& body, double eta, double rate) {
  return penalty * (1.0 + body.mix.tau_0 / (rate * eta));
}

}  // namespace

void lay_out_steady_flow(SteadyBody& body) {
  auto& grid = body.grid;
  std::vector<Vec<3>> middles;
  for (int i = 0; i < grid.axes[0].n_cells; ++i)
    for (int j = 0; j < grid.axes[1].n_cells; ++j)
      for (int k = 0; k < grid.axes[2].n_cells; ++k)
        if (const Index<3> cell{i, j, k}; !block_of_cell<3>(grid, cell))
          middles.push_back(position_in_cell<3>(grid.axes, cell, Vec<3>::Constant(0.5)));
  activate(grid, middles);
  const auto n = grid.cell_index.size();
  auto& quad = body.quadrature;
  quad.resize(n);
  std::fill(quad.p.begin(), quad.p.end(), 0.0);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const Index<3>& cell = grid.cell_index[c];
    std::array<Vec<3>, 8> x;
    std::array<Stencil<3>, 8> st;
    for (int k = 0; k < 8; ++k) {
      x[k] = position_in_cell<3>(grid.axes, cell, quadrature_point<3>(k));
      st[k] = stencil<3>(grid.axes, cell, quadrature_point<3>(k));
    }
    quad.V[c] = detail::full_volumes<Cylindrical>(grid.axes, x);
    quad.V_cell[c] = std::accumulate(quad.V[c].begin(), quad.V[c].end(), 0.0);
    quad.tau_y[c].fill(body.mix.tau_0);
    detail::lay_out_rows<Cylindrical>(st, x, c, quad);
  }
  body.nodes.mass.assign(grid.node_index.size(), no_mass);
  body.nodes.v.assign(grid.node_index.size(), Vec<3>::Zero());
  body.v = body.nodes.v;
  body.admm_state.resize(n);
}

SolveReport solve_steady_flow(SteadyBody& body, const YieldLaw& law, double rate, int max_iterations) {
  constexpr double dt = 1.0;
  body.dt = dt;
  body.shear_rate = rate;
  std::optional<YieldProblem<Cylindrical>> problem;
  const std::vector<Vec<3>> v = body.v;
  detail::pose<Cylindrical>(body, law, {}, {}, v, {}, dt, problem);
  AdmmSettings settings;
  settings.tolerance = tolerance;
  settings.max_iterations = max_iterations;
  settings.penalty = penalty_at(body, problem->eta, rate);
  problem->K = body.mix.K = bulk_stiffness * (problem->eta + body.mix.tau_0 / rate) / dt;
  body.system.set_pattern(body.grid);
  FactorisedAdmm<Cylindrical> form{*problem, law, settings, body.system, body.admm_state};
  const SolveReport report = solve_admm(*problem, settings, form, body.v);
  detail::keep_forces<detail::ByFactors>(*problem, law, body);
  return report;
}

double steady_pressure(const SteadyBody& body, int c) {
  double divergence = 0.0;
  for (std::size_t i = 0; i < 27; ++i)
    divergence += body.quadrature.b[c][i].dot(body.v[body.grid.cell_nodes[c][i]]);
  return -body.mix.K * body.dt * divergence;
}

Vec<3> velocity_in_middle(const SteadyBody& body, int c) {
  const Stencil<3> st = stencil<3>(body.grid.axes, body.grid.cell_index[c], Vec<3>::Constant(0.5));
  Vec<3> v = Vec<3>::Zero();
  for (std::size_t i = 0; i < 27; ++i) v += st.N[i] * body.v[body.grid.cell_nodes[c][i]];
  return v;
}

double shear_rate_of_cell(const SteadyBody& body, int c) {
  double mean = 0.0;
  for (const auto& rows : body.quadrature.B[c]) {
    Vec<5> q = Vec<5>::Zero();
    for (std::size_t i = 0; i < 27; ++i) q += rows[i] * body.v[body.grid.cell_nodes[c][i]];
    mean += q.norm() / 8.0;
  }
  return mean;
}

}  // namespace tremie
