// The step in space without a matrix: the same solution as the factorised system, and what must hold of it.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/by_iteration.hpp"
#include "libmpm/implicit/pose.hpp"

namespace tremie {
namespace {

using namespace bodies;

StepSettings by_iteration(double tolerance) {
  StepSettings settings;
  settings.admm.direct_below = 0;
  settings.admm.tolerance = tolerance;
  return settings;
}

/// A block of concrete on the floor between two planes of symmetry, free to slump.
ImplicitBody<ThreeD> block(double K, const Vec<3>& size = Vec<3>(0.06, 0.08, 0.09)) {
  ImplicitBody<ThreeD> body;
  body.mix = concrete(54.0, 35.8, K);
  body.gravity[2] = -9.81;
  for (int d = 0; d < 2; ++d) body.grid.axes[d] = {.h = 0.02, .low = FaceKind::free_slip};
  body.grid.axes[2] = {.h = 0.015, .low = FaceKind::no_slip};
  fill_box(body, Vec<3>(Vec<3>::Zero()), size, 2);
  return body;
}

double difference(const Points<3>& a, const Points<3>& b) {
  double worst = 0.0;
  for (std::size_t p = 0; p < a.size(); ++p) worst = std::max(worst, (a.v[p] - b.v[p]).norm());
  return worst;
}

// Both solve the same convex problem, for a soft and a stiff bulk modulus, and one that the systems by
// iteration have a twentieth of (lower_modulus()). The body slumps at about 0.3 m/s; 2e-5 is ten times what a
// tolerance of 1e-5 leaves, and so is half a pascal.
TEST(Solver3D, AgreesWithTheFactorisedSystem) {
  omp_set_num_threads(1);
  for (double K : {33e3, 1e6, 2e9}) {
    ImplicitBody<ThreeD> direct = block(K), iterated = block(K);
    StepSettings exact = by_iteration(1e-5), tight = exact;
    exact.admm.max_iterations = tight.admm.max_iterations = 4000;
    exact.admm.direct_below = 1'000'000;
    exact.fixed_dt = tight.fixed_dt = 0.01;
    for (int i = 0; i < 3; ++i) {
      EXPECT_TRUE(implicit_step(direct, ExactBingham{}, exact).converged);
      EXPECT_TRUE(implicit_step(iterated, ExactBingham{}, tight).converged);
    }
    const double worst = difference(direct.points, iterated.points);
    std::printf("K = %.0f kPa: velocities differ by at most %.1e m/s\n", 1e-3 * K, worst);
    EXPECT_LE(worst, 2e-5);
    double pressure = 0.0;
    for (std::size_t p = 0; p < direct.points.size(); ++p)
      pressure = std::max(pressure, K * std::abs(direct.points.ln_J[p] - iterated.points.ln_J[p]));
    EXPECT_LE(pressure, 0.5) << K;
  }
}

// A body of some hundred nodes is solved without a matrix by default, where a factor costs ten times as much;
// a few cells are factorised, which keeps their momentum to round-off.
TEST(Solver3D, TakesSmallBodiesToo) {
  ImplicitBody<ThreeD> few = block(1e6), small = block(1e6);
  fill_box(small, Vec<3>(0.06, 0.0, 0.0), Vec<3>(0.24, 0.08, 0.09), 2);
  activate(few.grid, few.points.x), activate(small.grid, small.points.x);
  EXPECT_LE(small.grid.n_nodes(), 800);
  EXPECT_TRUE(detail::by_iteration(small, StepSettings{}));
  EXPECT_FALSE(detail::by_iteration(few, StepSettings{}));
}

/// Large enough for four chunks of cells.
const Vec<3> some_chunks(0.24, 0.32, 0.12);

// The same bits with one thread and with two, beside a rigid wall, the pressures with a factor and by
// iteration.
TEST(Solver3D, BitsDoNotDependOnTheThreads) {
  const RigidWall<3> wall = [](const Vec<3>& x, double) -> std::optional<WallView<3>> {
    if (x[1] < 0.28) return {};
    return WallView<3>{0.32 - x[1], Vec<3>(0.0, -1.0, 0.0), Vec<3>::Zero()};
  };
  for (const auto& [K, most_band_operations] : {std::pair{1e6, 1e9}, {1e6, 0.0}, {2e9, 1e9}}) {
    ImplicitBody<ThreeD> one = block(K, some_chunks), two = block(K, some_chunks);
    StepSettings settings = by_iteration(1e-3);
    settings.admm.most_band_operations = most_band_operations;
    settings.particle_shifting.on = true;
    settings.wall_gap = 0.005;
    for (int i = 0; i < 2; ++i) {
      omp_set_num_threads(1);
      implicit_step(one, ExactBingham{}, settings, wall);
      omp_set_num_threads(2);
      implicit_step(two, ExactBingham{}, settings, wall);
    }
    omp_set_num_threads(1);
    NodeReduction reduction;
    reduction.lay_out(one.grid, batch_size);
    EXPECT_GE(reduction.size(), 4);
    for (std::size_t p = 0; p < one.points.size(); ++p) {
      EXPECT_EQ(one.points.x[p], two.points.x[p]);
      EXPECT_EQ(one.points.v[p], two.points.v[p]);
      EXPECT_EQ(one.points.ln_J[p], two.points.ln_J[p]);
    }
  }
}

// The preconditioner keeps B' C B whole: thirty times the bulk modulus must not take twice the products.
TEST(Solver3D, StiffBulkCostsNoMore) {
  omp_set_num_threads(1);
  long long products[2];
  for (int i = 0; i < 2; ++i) {
    ImplicitBody<ThreeD> body = block(i == 0 ? 33e3 : 1e6);
    StepSettings settings = by_iteration(1e-3);
    settings.particle_shifting.on = true;
    for (int step = 0; step < 5; ++step) EXPECT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
    products[i] = body.matrix_free.products;
  }
  std::printf("matrix products in five steps: K = 33 kPa %lld, 1 MPa %lld\n", products[0], products[1]);
  EXPECT_LE(products[1], 2 * products[0]);
}

// The products of one spline a direction against the strain rows: gradients and their adjoint at walls and
// away.
TEST(Solver3D, GradientsAndTheirAdjoint) {
  omp_set_num_threads(1);
  ImplicitBody<ThreeD> body = block(1e6, some_chunks);
  activate(body.grid, body.points.x);
  CellBatches batches;
  batches.lay_out(body.grid);
  const NodeReduction& reduction = batches.reduction();
  ASSERT_GE(reduction.size(), 4);
  ReductionBuffer forces;
  reduction.resize_for_overwrite(forces);
  const int n = body.grid.n_nodes();
  Eigen::VectorXd v(3 * n), sum = Eigen::VectorXd::Zero(3 * n);
  for (int i = 0; i < 3 * n; ++i) v[i] = std::sin(1.7 * i);
  double worst = 0.0, work_on_gradients = 0.0;
  const auto give_batch = [&](int b, double* to) {
    QuadratureTensors<double> G;
    batches.gradients(b, v.data(), G);
    batches.scatter(b, G, to);
    for (int c = b * batch_size; c < std::min((b + 1) * batch_size, body.grid.n_cells()); ++c)
      for (int k = 0; k < 8; ++k) {
        const Stencil<3> st = stencil<3>(body.grid.axes, body.grid.cell_index[c], quadrature_point<3>(k));
        Mat<3, 3> L = Mat<3, 3>::Zero();
        for (int i = 0; i < 27; ++i) L += v.segment<3>(3 * body.grid.cell_nodes[c][i]) * st.g[i].transpose();
        for (int d = 0; d < 3; ++d)
          for (int e = 0; e < 3; ++e)
            worst = std::max(worst, std::abs(G.g[d][e][k][c % batch_size] - L(d, e)));
        work_on_gradients += L.squaredNorm();
      }
  };
  const auto give = [&](int chunk, double* to) {
    for (int b = batches.first_batch(chunk); b < batches.last_batch(chunk); ++b) give_batch(b, to);
  };
  reduction.sweep_in_region<double>(
      forces, give, [&](int i) { sum.segment<3>(3 * i) = reduction.sum_at<double, 3>(i, forces); });
  EXPECT_LE(worst, 1e-11 * 100.0);  // gradients are of the order 1/h = 100 1/s
  EXPECT_NEAR(sum.dot(v) / work_on_gradients, 1.0, 1e-12);
}

// A ball of Newtonian fluid that collapses on a slippery floor: its four quadrants stay mirror images to 1e-9
// of its radius, and its mass is kept to the bit.
TEST(Solver3D, BallCollapsesSymmetrically) {
  omp_set_num_threads(1);
  const double R = 0.06;
  ImplicitBody<ThreeD> body;
  body.mix = concrete(0.0, 20.0);
  body.gravity[2] = -9.81;
  for (int d = 0; d < 2; ++d) body.grid.axes[d].h = 0.02;
  body.grid.axes[2] = {.h = 0.02, .low = FaceKind::free_slip};
  seed_box<ThreeD>(
      Vec<3>(-R, -R, 0.0), Vec<3>(R, R, 2 * R), {12, 12, 12}, body.mix.density, body.mix.K,
      [R](const Vec<3>& x) { return (x - Vec<3>(0, 0, R)).norm() < R; }, [](const auto&) { return 0.0; },
      body.points);
  const Points<3> start = body.points;
  StepSettings settings = by_iteration(1e-8);
  settings.particle_shifting.on = true;
  while (body.time < 0.1) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const auto& x = body.points.x;
  double worst = 0.0, top = 0.0, top_before = 0.0;
  for (std::size_t p = 0; p < x.size(); ++p) {
    top = std::max(top, x[p][2]), top_before = std::max(top_before, start.x[p][2]);
    for (std::size_t q = 0; q < x.size(); ++q)
      for (int mirror = 1; mirror < 4; ++mirror) {
        const Vec<3> m(mirror & 1 ? -1.0 : 1.0, mirror & 2 ? -1.0 : 1.0, 1.0);
        if ((start.x[p] - m.cwiseProduct(start.x[q])).norm() < 1e-9)
          worst = std::max(worst, (x[p] - m.cwiseProduct(x[q])).norm() / R);
      }
  }
  std::printf("ball: top from %.1f to %.1f mm, quadrants differ by %.1e of the radius\n", 1e3 * top_before,
              1e3 * top, worst);
  EXPECT_LE(top, 0.9 * top_before);
  EXPECT_LE(worst, 1e-9);
  EXPECT_EQ(total_mass(body.points), total_mass(start));
}

}  // namespace
}  // namespace tremie
