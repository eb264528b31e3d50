// What the linear system of a step in space is made of, against loops over cells and nodes.

#include <gtest/gtest.h>
#include <omp.h>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/pose.hpp"

namespace tremie {
namespace {

using namespace bodies;

/// Points in the middles of the cells of a box with holes; cells of 1 m.
struct Holes {
  ActiveGrid<3> grid;
  Points<3> points;
  Quadrature<ThreeD> quadrature;

  Holes(const Index<3>& extent, const std::array<bool, 3>& periodic = {},
        std::vector<int> repeated_knots = {}) {
    for (int d = 0; d < 3; ++d) {
      grid.axes[d].periodic = periodic[d];
      if (periodic[d]) grid.axes[d].n_cells = extent[d];
    }
    grid.axes[2].repeated_knots = std::move(repeated_knots);
    for (int i = 0; i < extent[0]; ++i)
      for (int j = 0; j < extent[1]; ++j)
        for (int k = 0; k < extent[2]; ++k)
          if (std::sin(12.9 * i + 78.2 * j + 37.7 * k) < 0.6)
            add_point<3>(points, Vec<3>(i + 0.4, j + 0.5, k + 0.7), 1.0, 1.0, 0.0);
    activate(grid, points.x);
    lay_out_quadrature<ThreeD>(grid, points, 1.0, 1.0, quadrature);
  }
};

/// Boxes that make one chunk and several; periodic axes, where a chunk sees both ends of a column or of the
/// grid; a repeated knot, which adds a node within a column.
std::vector<Holes> boxes() {
  std::vector<Holes> all;
  all.emplace_back(Index<3>{4, 3, 5});
  all.emplace_back(Index<3>{40, 17, 6});
  all.emplace_back(Index<3>{5, 4, 90});
  all.emplace_back(Index<3>{30, 9, 7}, std::array<bool, 3>{true, false, false});
  all.emplace_back(Index<3>{30, 9, 7}, std::array<bool, 3>{false, true, true});
  all.emplace_back(Index<3>{12, 11, 8}, std::array<bool, 3>{}, std::vector<int>{3, 4});
  return all;
}

// Cells of 1 m with one to three points of 0.5 m^3, that is between half and one and a half full. A node all of whose cells lie
// inside weighs density times the integral of its spline, 2 kg/m^3 times 1 m^3; by its points it would not.
TEST(NodeWeights, ACellInsideWeighsWhatAFullOneDoes) {
  ActiveGrid<3> grid;
  Points<3> points;
  Quadrature<ThreeD> quadrature;
  constexpr int n = 6;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k)
        for (int p = 0; p <= (i + 2 * j + 5 * k) % 3; ++p)
          add_point<3>(points, Vec<3>(i + 0.2 + 0.3 * p, j + 0.5, k + 0.4), 1.0, 0.5, 0.0);
  activate(grid, points.x);
  lay_out_quadrature<ThreeD>(grid, points, 1.0, 1.0, quadrature);
  NodalState<3> nodes;
  point_to_grid(grid, points, nodes);
  const std::vector<double> weight = node_weights(grid, points, quadrature);
  int inside = 0;
  double farthest = 0.0;
  for (int i = 0; i < grid.n_nodes(); ++i) {
    const Vec<3> x = grid.node_position(i);
    if (x.minCoeff() < 2.4 || x.maxCoeff() > n - 2.4) continue;
    ++inside;
    EXPECT_NEAR(weight[i], 2.0, 1e-12);
    farthest = std::max(farthest, std::abs(nodes.mass[i] - 2.0));
  }
  EXPECT_GT(inside, 0);
  EXPECT_GT(farthest, 0.1);
}

// Sums of at most 27 numbers of the order 1, in whatever order: to rounding. Bits do not depend on the
// threads.
TEST(NodeReduction, AddsUpLikeOneLoop) {
  int most = 0;
  for (const Holes& box : boxes())
    for (int unit : {1, 16}) {
      const int n = box.grid.n_nodes();
      const auto value = [](int c, int k, int a) { return std::sin(1.3 * c + 0.7 * k + a); };
      std::vector<Vec<4>> expected(static_cast<std::size_t>(n), Vec<4>::Zero());
      for (int c = 0; c < box.grid.n_cells(); ++c)
        for (int k = 0; k < 27; ++k)
          for (int a = 0; a < 4; ++a)
            expected[static_cast<std::size_t>(box.grid.cell_nodes[static_cast<std::size_t>(c)][k])][a] +=
                value(c, k, a);
      NodeReduction reduction;
      reduction.lay_out(box.grid, unit);
      most = std::max(most, reduction.size());
      for (int s = 0; s < reduction.size(); ++s) EXPECT_EQ(reduction.first_cell(s) % unit, 0);
      ReductionBuffer room;
      reduction.resize_for_overwrite(room);
      std::vector<Vec<4>> sums[2];
      for (int threads : {1, 3}) {
        auto& sum = sums[threads / 3];
        sum.resize(expected.size());
        const auto give = [&](int s, double* to) {
          for (int c = reduction.first_cell(s); c < reduction.last_cell(s); ++c)
            for (int k = 0; k < 27; ++k)
              for (int a = 0; a < 4; ++a)
                to[4 * box.grid.cell_nodes[static_cast<std::size_t>(c)][k] + a] += value(c, k, a);
        };
        const auto take = [&](int i) {
          sum[static_cast<std::size_t>(i)] = reduction.sum_at<double, 4>(i, room);
        };
#pragma omp parallel num_threads(threads)
        reduction.sweep_in_region<double>(room, give, take);
        for (std::size_t i = 0; i < sum.size(); ++i)
          EXPECT_LE((sum[i] - expected[i]).cwiseAbs().maxCoeff(), 1e-13);
      }
      for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(sums[0][i], sums[1][i]);
    }
  EXPECT_GE(most, 8);
}

/// Inverse blocks and stiffnesses of some sense; a third of the cells has none if `some` are left out, all of
/// them if `all` are.
struct Parts {
  std::vector<Mat<3, 3>> G, G_inverse;
  std::vector<double> C;

  Parts(const ActiveGrid<3>& grid, bool some, bool all) {
    for (int i = 0; i < grid.n_nodes(); ++i) {
      const Vec<3> a(std::sin(1.1 * i), std::sin(2.3 * i), std::sin(3.7 * i));
      G.push_back((1.5 + std::sin(0.3 * i)) * Mat<3, 3>::Identity() + 0.4 * a * a.transpose());
      G_inverse.push_back(G.back().inverse());
    }
    for (int c = 0; c < grid.n_cells(); ++c)
      C.push_back(all || (some && c % 3 == 1) ? 0.0 : 50.0 + 20.0 * std::sin(0.9 * c));
  }
};

// P = G + B' C B undoes what the preconditioner does, by a factor of S and by iteration, with cells that have
// no stiffness among the others or alone. Single precision leaves 1e-5 of r; an iteration leaves 5e-4 of its
// residual, which C, some 50 times G, makes up to ten times as large.
TEST(SchurComplementPreconditioner, IsTheInverse) {
  omp_set_num_threads(1);
  for (const Holes& box : boxes())
    for (bool by_band : {true, false})
      for (int left_out = 0; left_out < 3; ++left_out) {
        const ActiveGrid<3>& grid = box.grid;
        const int n = grid.n_nodes();
        const Parts parts(grid, left_out == 1, left_out == 2);
        CellBatches batches;
        batches.lay_out(grid);
        SchurComplementPreconditioner P;
        P.lay_out(grid, by_band ? 1e15 : 0.0);
        ASSERT_EQ(P.factorised(), by_band);
        ASSERT_TRUE(P.build(grid, batches, box.quadrature, parts.G_inverse, parts.C, 1000.0));
        Eigen::VectorXf r = Eigen::VectorXf::Zero(4 * n), z;
        for (int i = 0; i < n; ++i)
          for (int d = 0; d < 3; ++d) r[4 * i + d] = std::sin(1.7f * static_cast<float>(3 * i + d));
        ReductionBuffer room;
        batches.reduction().resize_for_overwrite(room);
        P.apply(batches, grid, r, room, z);
        Eigen::VectorXd Pz = Eigen::VectorXd::Zero(4 * n);
        for (int i = 0; i < n; ++i)
          Pz.segment<3>(4 * i) = parts.G[static_cast<std::size_t>(i)] * z.segment<3>(4 * i).cast<double>();
        for (int c = 0; c < grid.n_cells(); ++c) {
          const auto& nodes = grid.cell_nodes[static_cast<std::size_t>(c)];
          const auto b = box.quadrature.divergence_rows(c);
          double div = 0.0;
          for (std::size_t k = 0; k < 27; ++k) div += b[k].dot(z.segment<3>(4 * nodes[k]).cast<double>());
          for (std::size_t k = 0; k < 27; ++k)
            Pz.segment<3>(4 * nodes[k]) += parts.C[static_cast<std::size_t>(c)] * div * b[k];
        }
        EXPECT_LE((Pz - r.cast<double>()).norm() / r.cast<double>().norm(), by_band ? 1e-5 : 1e-2)
            << "extent " << grid.cell_map.extent[0] << ", band " << by_band << ", left out " << left_out;
      }
}

// A product with the system counts each closed contact with a moving wall once: stiffness times N N' n n'.
TEST(MatrixFreeSystem, ProductsKnowClosedContacts) {
  ImplicitBody<ThreeD> body;
  body.mix = concrete(54.0, 35.8);
  for (Axis& a : body.grid.axes) a.h = 0.02;
  fill_box(body, Vec<3>(Vec<3>::Zero()), Vec<3>(0.6, 0.2, 0.16), 2);
  activate(body.grid, body.points.x);
  point_to_grid(body.grid, body.points, body.nodes);
  lay_out_quadrature<ThreeD>(body.grid, body.points, body.mix.tau_0, body.mix.K, body.quadrature);
  const RigidWall<3> wall = [](const Vec<3>& x, double) -> std::optional<WallView<3>> {
    if (x[1] > 0.03) return {};
    return WallView<3>{x[1] - 0.01, Vec<3>(0.6, 0.8, 0.0), Vec<3>(0.0, 0.0, 0.0)};
  };
  StepSettings settings;
  settings.wall_gap = 0.01;
  const auto v = body.nodes.v;
  std::optional<YieldProblem<ThreeD>> problem;
  detail::pose(body, YieldLaw{}, settings, wall, v, {}, 1e-3, problem);
  auto& contact = problem->contact;
  for (std::size_t p = 0; p < contact.size(); ++p) contact[p].active = p % 3 != 0;
  ASSERT_GE(contact.size(), 100u);

  MatrixFreeSystem system;
  system.set_up(*problem, 1e9);
  ASSERT_TRUE(system.prepare(*problem, 100.0));
  ASSERT_GE(system.batches.reduction().size(), 8);
  const int n = body.grid.n_nodes();
  Eigen::VectorXf x = Eigen::VectorXf::Zero(4 * n), with, without;
  for (int i = 0; i < n; ++i)
    for (int d = 0; d < 3; ++d) x[4 * i + d] = std::sin(1.7f * static_cast<float>(3 * i + d));
  system.multiply(*problem, x, with);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(4 * n);
  for (const ContactPoint<3>& c : contact) {
    if (!c.active) continue;
    const auto N = c.shape();
    const auto& nodes = body.grid.cell_nodes[static_cast<std::size_t>(c.cell)];
    double u = 0.0;
    for (std::size_t k = 0; k < 27; ++k) u += N[k] * c.normal.dot(x.segment<3>(4 * nodes[k]).cast<double>());
    for (std::size_t k = 0; k < 27; ++k)
      expected.segment<3>(4 * nodes[k]) += c.stiffness * u * N[k] * c.normal;
  }
  for (ContactPoint<3>& c : contact) c.active = false;
  system.multiply(*problem, x, without);
  const Eigen::VectorXd found = with.cast<double>() - without.cast<double>();
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_LE((found - expected).norm(), 1e-5 * with.cast<double>().norm());  // single precision
}

}  // namespace
}  // namespace tremie
