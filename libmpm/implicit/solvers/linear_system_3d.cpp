#include "libmpm/implicit/solvers/linear_system_3d.hpp"

namespace tremie {

void add_penalty_blocks(std::span<const PointTerm<3>> terms, const CellNodes<3>& cell_nodes,
                        std::vector<Mat<3, 3>>& blocks) {
  for (const PointTerm<3>& t : terms)
    for (int k = 0; k < 27; ++k) blocks[cell_nodes[t.cell][k]] += t.N[k] * t.N[k] * t.penalty;
}

void invert_blocks(const std::vector<char>& fixed, std::vector<Mat<3, 3>>& G) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < G.size(); ++i) {
    for (int d = 0; d < 3; ++d)
      if (fixed[3 * i + d]) G[i].row(d).setZero(), G[i].col(d).setZero(), G[i](d, d) = 1.0;
    G[i] = G[i].inverse().eval();
    for (int d = 0; d < 3; ++d)
      if (fixed[3 * i + d]) G[i](d, d) = 0.0;
  }
}

void MatrixFreeSystem::set_up(YieldProblem<ThreeD>& problem, double most_band_operations) {
  const auto& quad = problem.quadrature;
  batches.lay_out(problem.grid);
  preconditioner.lay_out(problem.grid, most_band_operations);
  resize_for_overwrite(weights_, static_cast<std::size_t>(batches.n_batches()));
  batches.reduction().resize_for_overwrite(forces);
#pragma omp parallel for schedule(static)
  for (int b = 0; b < batches.n_batches(); ++b) {
    const BatchVolumes<double> own = batch_volumes(quad, b);
    for (int k = 0; k < 8; ++k) weights_[b].V[k] = own.V[k].cast<float>();
    weights_[b].inverse_cell = own.inverse_cell.cast<float>();
  }
}

bool MatrixFreeSystem::prepare(YieldProblem<ThreeD>& problem, double eta_system) {
  eta_system_ = eta_system;
  const int n = problem.grid.n_nodes();
  const double trace = trace_of_mass(problem.nodes.mass);
  Eigen::VectorXd diagonal(3 * n);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i)
    diagonal.segment<3>(3 * i).setConstant(std::max(trace, problem.nodes.mass[i]) / problem.dt +
                                           (problem.drag.empty() ? 0.0 : problem.drag[i].k));
  if (!problem.wall_nodes.empty()) {
    Diagonal to{diagonal};
    add_node_stiffness_admm<3>(volumes_around_nodes(problem), eta_system, problem.wall_nodes, to);
  }
  free_.resize(4 * n), free_diagonal_.resize(4 * n);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) {
    auto free = free_.segment<4>(4 * i);
    for (int d = 0; d < 3; ++d) free[d] = problem.fixed[3 * i + d] ? 0.0f : 1.0f;
    free[3] = 0.0f;
    free_diagonal_.segment<4>(4 * i) << free.head<3>().cwiseProduct(diagonal.segment<3>(3 * i).cast<float>()),
        0.0f;
  }
  // What a product gives a node behind a plane of symmetry is kept until it is mirrored.
  for (const MirrorNode<3>& m : problem.grid.mirrors)
    free_.segment<4>(4 * m.node) = free_.segment<4>(4 * m.of);
  std::vector<double> stiffness(problem.grid.n_cells());
  for (int c = 0; c < problem.grid.n_cells(); ++c)
    stiffness[c] = problem.quadrature.V_cell[c] * problem.K * problem.dt;
  return preconditioner.build(problem.grid, batches, problem.quadrature, node_blocks(problem, diagonal),
                              stiffness, problem.K * problem.dt / eta_system);
}

/// Inverse blocks of D at the nodes. A node's own viscous block is V eta (|g|^2 I + g g'/3) with its gradient
/// g.
std::vector<Mat<3, 3>> MatrixFreeSystem::node_blocks(const YieldProblem<ThreeD>& problem,
                                                     const Eigen::VectorXd& diagonal) const {
  const auto& grid = problem.grid;
  using Symmetric = Eigen::Matrix<double, 8, 1>;  // xx, yy, zz, xy, yz, xz and two zeros, for whole vectors
  std::array<std::array<std::array<Symmetric, 27>, 8>, 64> viscous;
  std::array<bool, 64> done{};
  std::vector<unsigned char> kind(grid.n_cells());
  for (int c = 0; c < grid.n_cells(); ++c) {
    kind[c] = cell_kind(grid.axes, grid.cell_index[c]);
    if (done[kind[c]]) continue;
    done[kind[c]] = true;
    std::array<Stencil<3>, 8> at;
    for (int k = 0; k < 8; ++k) at[k] = stencil<3>(grid.axes, grid.cell_index[c], quadrature_point<3>(k));
    for (int k = 0; k < 8; ++k) {
      const Stencil<3>& st = at[k];
      for (int i = 0; i < 27; ++i) {
        Vec<3> excess = st.g[i];
        for (const Stencil<3>& other : at) excess -= 0.125 * other.g[i];
        const Mat<3, 3> own = eta_system_ * (st.g[i].squaredNorm() * Mat<3, 3>::Identity() +
                                             st.g[i] * st.g[i].transpose() / 3.0) +
                              problem.zeta * excess * excess.transpose();
        viscous[kind[c]][k][i] << own.diagonal(), own(1, 0), own(2, 1), own(2, 0), 0.0, 0.0;
      }
    }
  }
  std::vector<Mat<3, 3>> G(grid.n_nodes());
#pragma omp parallel for schedule(static)
  for (int i = 0; i < grid.n_nodes(); ++i) {
    Symmetric sum = Symmetric::Zero();
    sum.head<3>() = diagonal.segment<3>(3 * i);
    for (const int* e = batches.entries_begin(i); e != batches.entries_end(i); ++e) {
      const int c = CellBatches::cell_of(*e), local = CellBatches::local_of(*e);
      for (int k = 0; k < 8; ++k) sum += problem.quadrature.V[c][k] * viscous[kind[c]][k][local];
    }
    G[i] << sum[0], sum[3], sum[5], sum[3], sum[1], sum[4], sum[5], sum[4], sum[2];
  }
  for (const ContactPoint<3>& c : problem.contact) {
    if (!c.active) continue;
    const auto N = c.shape();
    for (int k = 0; k < 27; ++k)
      G[grid.cell_nodes[c.cell][k]] += c.stiffness * N[k] * N[k] * c.normal * c.normal.transpose();
  }
  for (const auto& terms : problem.points()) add_penalty_blocks(terms, grid.cell_nodes, G);
  fold_mirrors(grid, G);
  invert_blocks(problem.fixed, G);
  return G;
}

void MatrixFreeSystem::multiply(const YieldProblem<ThreeD>& problem, const Eigen::VectorXf& x,
                                Eigen::VectorXf& out) {
  const auto zeta = static_cast<float>(problem.zeta),
             bulk = static_cast<float>(problem.K * problem.dt) - zeta,
             eta_system = static_cast<float>(eta_system_);
  ++products;
  out.resize(x.size());
  const auto give_batch = [&](int b, float* to) {
    QuadratureTensors<float> G;
    batches.gradients(b, x.data(), G);
    const BatchVolumes<float>& v = weights_[b];
    Lanes<float> mean = Lanes<float>::Zero();
    for (int k = 0; k < 8; ++k) mean += v.V[k] * (G.g[0][0][k] + G.g[1][1][k] + G.g[2][2][k]);
    mean *= bulk * v.inverse_cell;
    for (int k = 0; k < 8; ++k) {
      Lanes<float> q[5], div;
      strain_at(G, k, q, div);
      const Lanes<float> w = eta_system * v.V[k];
      for (Lanes<float>& s : q) s *= w;
      stress_at<float>(q, v.V[k] * (mean + zeta * div), k, G);
    }
    batches.scatter(b, G, to);
  };
  const auto give = [&](int chunk, float* to) {
    for (int b = batches.first_batch(chunk); b < batches.last_batch(chunk); ++b) give_batch(b, to);
    for_each_contact(problem.contact, batches.reduction(), chunk, [&](const ContactPoint<3>& c) {
      const auto& nodes = problem.grid.cell_nodes[c.cell];
      add_at_contact(c, nodes, c.stiffness * normal_velocity(c, nodes, x.data()), to);
    });
  };
#pragma omp parallel
  batches.reduction().sweep_in_region<float>(forces, give, [&](int i) {
    out.segment<4>(4 * i) =
        free_diagonal_.segment<4>(4 * i).cwiseProduct(x.segment<4>(4 * i)) +
        free_.segment<4>(4 * i).cwiseProduct(batches.reduction().sum_at<float, 4>(i, forces));
  });
  if (!problem.bound.empty() || !problem.surface.empty() || !problem.bars.empty()) {
    for (const auto& terms : problem.points()) add_penalty_products(terms, problem.grid.cell_nodes, x, out);
    for_each_block(out.size(), [&](Eigen::Index i, Eigen::Index size) {
      out.segment(i, size) = out.segment(i, size).cwiseProduct(free_.segment(i, size));
    });
  }
  fold_mirrors<3, 4>(problem.grid, out);
}

double MatrixFreeSystem::solve(const YieldProblem<ThreeD>& problem, const Eigen::VectorXd& R,
                               const PcgTolerances& goal, std::vector<Vec<3>>& v) {
  const int n = problem.grid.n_nodes();
  Eigen::VectorXf r(4 * n), x;
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) r.segment<4>(4 * i) << R.segment<3>(3 * i).cast<float>(), 0.0f;
  const double left =
      conjugate_gradients([&](const Eigen::VectorXf& p, Eigen::VectorXf& Ap) { multiply(problem, p, Ap); },
                          [&](const Eigen::VectorXf& rest, Eigen::VectorXf& z) {
                            preconditioner.apply(batches, problem.grid, rest, forces, z);
                          },
                          goal, r, x);
#pragma omp parallel for schedule(static)
  for (int i = 0; i < n; ++i) v[i] += x.segment<3>(4 * i).cast<double>();
  fill_mirrors<3>(problem.grid, v);
  return left;
}

void MatrixFreeSystem::shear_rates(const YieldProblem<ThreeD>& problem, const std::vector<Vec<3>>& v,
                                   std::vector<double>& of_cell, double& mean) const {
  of_cell.resize(batches.n_cells());
  std::vector<double> sum(batches.n_batches()), volume(batches.n_batches());
#pragma omp parallel for schedule(static)
  for (int b = 0; b < batches.n_batches(); ++b) {
    QuadratureTensors<double> G;
    batches.gradients(b, v.data()->data(), G);
    const BatchVolumes<double> volumes = batch_volumes(problem.quadrature, b);
    Lanes<double> total = Lanes<double>::Zero(), weighted = total, V = total;
    for (int k = 0; k < 8; ++k) {
      Lanes<double> q[5], div;
      strain_at(G, k, q, div);
      const Lanes<double> rate = detail::norm(q);
      total += rate;
      weighted += volumes.V[k] * rate;
      V += volumes.V[k];
    }
    for (int c = b * batch_size; c < std::min((b + 1) * batch_size, batches.n_cells()); ++c)
      of_cell[c] = total[c % batch_size] / 8.0;
    sum[b] = weighted.sum();
    volume[b] = V.sum();
  }
  double all = 0.0, V = 0.0;
  for (int b = 0; b < batches.n_batches(); ++b) all += sum[b], V += volume[b];
  mean = V > 0.0 ? all / V : 0.0;
}

}  // namespace tremie
