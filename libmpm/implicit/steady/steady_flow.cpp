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
double penalty_at(const Mix& mix, double eta, double rate) {
  return penalty * (1.0 + mix.tau_0 / (rate * eta));
}

/// The middles of all cells that no block fills.
template <int D>
std::vector<Vec<D>> free_middles(const ActiveGrid<D>& grid) {
  IndexMap<D> cells;
  Index<D> last{};
  for (int d = 0; d < D; ++d) last[d] = grid.axes[d].n_cells - 1;
  cells.reset({}, last);
  std::vector<Vec<D>> middles;
  detail::for_each_index(cells, [&](const Index<D>& cell, std::size_t) {
    if (!block_of_cell<D>(grid, cell))
      middles.push_back(position_in_cell<D>(grid.axes, cell, Vec<D>(Vec<D>::Constant(0.5))));
  });
  return middles;
}

}  // namespace

template <class Geometry>
void lay_out_steady_flow(ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim, n = power(2, D);
  auto& grid = body.grid;
  activate<D>(grid, free_middles<D>(grid));
  const auto cells = grid.cell_index.size();
  auto& quad = body.quadrature;
  quad.resize(cells);
  std::fill(quad.p.begin(), quad.p.end(), 0.0);
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c) {
    const Index<D>& cell = grid.cell_index[c];
    std::array<Vec<D>, n> x;
    std::array<Stencil<D>, n> st;
    for (int k = 0; k < n; ++k) {
      quad.place[c][k] = quadrature_point<D>(k);
      x[k] = position_in_cell<D>(grid.axes, cell, quadrature_point<D>(k));
      st[k] = stencil<D>(grid.axes, cell, quadrature_point<D>(k));
    }
    quad.V[c] = detail::full_volumes<Geometry>(grid.axes, x);
    quad.V_cell[c] = std::accumulate(quad.V[c].begin(), quad.V[c].end(), 0.0);
    quad.tau_y[c].fill(body.mix.tau_0);
    detail::lay_out_rows<Geometry>(st, x, c, quad);
  }
  body.nodes.mass.assign(grid.node_index.size(), no_mass);
  body.nodes.v.assign(grid.node_index.size(), Vec<D>::Zero());
  body.v = body.nodes.v;
  body.admm_state.resize(cells);
}

template <class Geometry>
SolveReport solve_steady_flow(ImplicitBody<Geometry>& body, const YieldLaw& law, const WallLaw& wall_law,
                              double rate, int max_iterations) {
  constexpr double dt = 1.0;
  body.dt = dt;
  body.shear_rate = rate;
  StepSettings step;
  step.wall_law = wall_law;
  std::optional<YieldProblem<Geometry>> problem;
  const std::vector<Vec<Geometry::dim>> v = body.v;
  detail::pose<Geometry>(body, law, step, {}, v, {}, dt, problem);
  AdmmSettings settings;
  settings.tolerance = tolerance;
  settings.max_iterations = max_iterations;
  settings.penalty = penalty_at(body.mix, problem->eta, rate);
  problem->K = body.mix.K = bulk_stiffness * (problem->eta + body.mix.tau_0 / rate) / dt;
  body.system.set_pattern(body.grid);
  FactorisedAdmm<Geometry> form{*problem, law, settings, body.system, body.admm_state};
  const SolveReport report = solve_admm(*problem, settings, form, body.v);
  detail::keep_forces<detail::ByFactors>(*problem, law, body);
  return report;
}

#define TREMIE_STEADY_IN(Geometry)                                                                         \
  template void lay_out_steady_flow(ImplicitBody<Geometry>&);                                              \
  template SolveReport solve_steady_flow(ImplicitBody<Geometry>&, const YieldLaw&, const WallLaw&, double, \
                                         int);
TREMIE_STEADY_IN(Polar)
TREMIE_STEADY_IN(Cylindrical)

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
