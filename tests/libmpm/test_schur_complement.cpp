// The pressures' matrix by its entries, and what comes near its inverse, against dense matrices.

#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>
#include <vector>

#include "libmpm/implicit/schur/fsai.hpp"

namespace tremie {
namespace {

/// A grid of cells with holes, of the given extent; only what the pressures' matrix asks for.
ActiveGrid<3> holey_grid(const Index<3>& extent, const std::array<bool, 3>& periodic) {
  ActiveGrid<3> grid;
  for (int d = 0; d < 3; ++d) {
    grid.axes[d].periodic = periodic[d];
    if (periodic[d]) grid.axes[d].n_cells = extent[d];
  }
  grid.cell_map.reset({0, 0, 0}, {extent[0] - 1, extent[1] - 1, extent[2] - 1});
  for (int i = 0; i < extent[0]; ++i)
    for (int j = 0; j < extent[1]; ++j)
      for (int k = 0; k < extent[2]; ++k) {
        const bool corner = i == 0 || i == extent[0] - 1 || k == extent[2] - 1;
        if (!corner && std::sin(12.9 * i + 78.2 * j + 37.7 * k) > 0.3) continue;
        grid.cell_map.value[grid.cell_map.offset({i, j, k})] = grid.n_cells();
        grid.cell_index.push_back({i, j, k});
      }
  return grid;
}

const std::pair<Index<3>, std::array<bool, 3>> cases[] = {{{5, 9, 37}, {}},
                                                          {{6, 20, 4}, {}},
                                                          {{17, 3, 7}, {}},
                                                          {{21, 3, 22}, {}},
                                                          {{8, 7, 5}, {true, false, false}},
                                                          {{4, 7, 6}, {true, true, false}},
                                                          {{5, 18, 6}, {true, true, false}},
                                                          {{3, 5, 18}, {false, true, false}}};

// S by its entries against a dense matrix: columns along each axis, longer and shorter than a batch, up to
// four chunks of them, holes, one and two periodic axes, one so short that a cell sees another from both
// sides. A product adds up 125 numbers of the order 1 in single precision.
TEST(SchurComplement, MatrixMultipliesLikeADenseMatrix) {
  omp_set_num_threads(1);
  for (const auto& [extent, periodic] : cases) {
    const ActiveGrid<3> grid = holey_grid(extent, periodic);
    const int n = grid.n_cells();
    SchurMatrix entries;
    entries.reset(grid);
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(n, n);
    for (int c = 0; c < n; ++c)
      for (int other = 0; other <= c; ++other) {
        bool near = true;
        for (int d = 0; d < 3; ++d) {
          const int step = std::abs(grid.cell_index[c][d] - grid.cell_index[other][d]);
          near = near && (step <= 2 || (periodic[d] && extent[d] - step <= 2));
        }
        if (!near) continue;
        const auto value = static_cast<float>(std::sin(1.3 * c + 2.7 * other));
        S(c, other) = S(other, c) = value;
        entries.add(grid, c, other, value);
      }
    Eigen::VectorXf p(n), Sp(n);
    for (int c = 0; c < n; ++c) p[c] = static_cast<float>(std::cos(0.7 * c));
    entries.multiply_in_region(p, Sp);
    Eigen::VectorXf by_threads(n);
#pragma omp parallel num_threads(3)
    entries.multiply_in_region(p, by_threads);
    EXPECT_EQ(by_threads, Sp);
    EXPECT_LE((Sp.cast<double>() - S * p.cast<double>()).cwiseAbs().maxCoeff(), 1e-4);
    Eigen::MatrixXd seen = Eigen::MatrixXd::Zero(n, n);
    entries.for_each([&](int c, int other, float value) {
      seen(c, other) += value;
      if (c != other) seen(other, c) += value;
    });
    EXPECT_EQ((seen - S).cwiseAbs().maxCoeff(), 0.0);
  }
}

/// B' B + 1, B(i, c) of the 27 nodes i around a cell c.
Eigen::MatrixXd of_controls(const ActiveGrid<3>& grid) {
  std::map<Index<3>, Eigen::Index> numbers;
  std::vector<std::array<Eigen::Index, 27>> around(grid.cell_index.size());
  for (std::size_t c = 0; c < around.size(); ++c)
    for (int k = 0; k < 27; ++k) {
      const Index<3>& cell = grid.cell_index[c];
      Index<3> i{cell[0] + k / 9, cell[1] + k / 3 % 3, cell[2] + k % 3};
      for (int d = 0; d < 3; ++d)
        if (grid.axes[d].periodic) i[d] %= grid.axes[d].n_cells;
      around[c][static_cast<std::size_t>(k)] =
          numbers.emplace(i, static_cast<Eigen::Index>(numbers.size())).first->second;
    }
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(numbers.size()), grid.n_cells());
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < 27; ++k)
      B(around[static_cast<std::size_t>(c)][static_cast<std::size_t>(k)], c) += std::sin(0.9 * c + 2.1 * k);
  return Eigen::MatrixXd::Identity(grid.n_cells(), grid.n_cells()) + B.transpose() * B;
}

/// The rows of F by their definition (fsai.hpp), from dense matrices.
Eigen::MatrixXd factor(const ActiveGrid<3>& grid, const Eigen::MatrixXd& S) {
  const int n = grid.n_cells();
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  for (int c = 0; c < n; ++c) {
    std::vector<int> row{c};
    for (int other = 0; other < n; ++other) {
      Index<3> step;
      for (int d = 0; d < 3; ++d) step[d] = grid.cell_index[other][d] - grid.cell_index[c][d];
      const int length = step[0] + step[1] + step[2];
      const bool along_an_axis = step[0] == length || step[1] == length || step[2] == length;
      const bool none_behind = step[0] >= 0 && step[1] >= 0 && step[2] >= 0;
      if (none_behind && along_an_axis && (length == 1 || length == 2)) row.push_back(other);
    }
    const Eigen::MatrixXd near = S(row, row);
    const Eigen::VectorXd g = near.inverse().col(0);
    for (std::size_t k = 0; k < row.size(); ++k)
      F(c, row[k]) = g[static_cast<Eigen::Index>(k)] / std::sqrt(g[0]);
  }
  return F;
}

// F' F r against its definition. Entries of S reach 20, so that single precision leaves 1e-5 of what F' F r
// has.
TEST(Fsai, MeetsItsDefinition) {
  omp_set_num_threads(1);
  for (const auto& [extent, periodic] : cases) {
    const ActiveGrid<3> grid = holey_grid(extent, periodic);
    const int n = grid.n_cells();
    const Eigen::MatrixXd S = of_controls(grid);
    SchurMatrix entries;
    entries.reset(grid);
    for (int c = 0; c < n; ++c)
      for (int other = 0; other <= c; ++other)
        if (S(c, other) != 0.0) entries.add(grid, c, other, static_cast<float>(S(c, other)));
    Fsai near;
    near.build(entries);
    Eigen::VectorXf r(n), Sr(n), z(n), by_threads(n);
    for (int c = 0; c < n; ++c) r[c] = static_cast<float>(std::cos(0.7 * c));
    entries.multiply_in_region(r, Sr);  // its vectors must not be in the way
    near.apply_in_region(entries.layout, r);
    for (int c = 0; c < n; ++c) z[c] = entries.layout.x[entries.layout.place_of[c]];
#pragma omp parallel num_threads(3)
    near.apply_in_region(entries.layout, r);
    for (int c = 0; c < n; ++c) by_threads[c] = entries.layout.x[entries.layout.place_of[c]];
    EXPECT_EQ(by_threads, z);
    Eigen::VectorXf again(n);
    entries.multiply_in_region(r, again);  // nor its own in that of a product
    EXPECT_EQ(again, Sr);
    const Eigen::MatrixXd F = factor(grid, S);
    const Eigen::VectorXd exact = F.transpose() * (F * r.cast<double>());
    EXPECT_LE((z.cast<double>() - exact).cwiseAbs().maxCoeff(), 1e-5 * exact.cwiseAbs().maxCoeff());
  }
}

// A cell without stiffness has a number of its own on the diagonal and nothing else, one without even that
// counts as none, and of two cells that rounding made one and the same, S = [1 1; 1 1], the diagonal is left.
TEST(Fsai, OfCellsWithoutOthers) {
  omp_set_num_threads(1);
  ActiveGrid<3> grid;
  grid.cell_map.reset({0, 0, 0}, {0, 0, 9});
  for (int k : {0, 1, 4, 5, 9}) grid.cell_index.push_back({0, 0, k});
  SchurMatrix entries;
  entries.reset(grid);
  entries.add(grid, 0, 0, 4.0f);
  for (const auto& [c, other] : {std::pair(2, 2), std::pair(3, 3), std::pair(3, 2)})
    entries.add(grid, c, other, 1.0f);
  entries.add(grid, 4, 4, 1e-20f);
  Fsai near;
  near.build(entries);
  near.apply_in_region(entries.layout, Eigen::VectorXf::Ones(5));
  const float expected[] = {0.25f, 0.0f, 1.0f, 1.0f, 1e20f};
  for (std::size_t c = 0; c < 5; ++c)
    EXPECT_FLOAT_EQ(entries.layout.x[entries.layout.place_of[c]], expected[c]) << c;
}

/// Entry of S between cells so far apart along each axis, in the inside of a body with unit blocks of its
/// nodes: products of the moments of quadratic splines over cells, of which the derivative's are +-1/2 and
/// the value's 1/6, 2/3, 1/6.
double inside(const Index<3>& step) {
  constexpr double slope[3] = {0.5, 0.0, -0.25}, value[3] = {0.5, 2.0 / 9.0, 1.0 / 36.0};
  double sum = 0.0;
  for (std::size_t d = 0; d < 3; ++d) {
    double product = 1.0;
    for (std::size_t e = 0; e < 3; ++e) {
      const auto far = static_cast<std::size_t>(std::abs(step[e]));
      product *= far > 2 ? 0.0 : (e == d ? slope[far] : value[far]);
    }
    sum += product;
  }
  return sum;
}

// What it is for: the condition of S, here with a softness of a hundredth of its diagonal, that of a stiff
// bulk modulus and a long step. The square root of the condition counts iterations; half of what the
// diagonal leaves is what is asked for.
TEST(Fsai, LeavesHalfTheIterationsOfTheDiagonal) {
  omp_set_num_threads(1);
  ActiveGrid<3> grid;
  grid.cell_map.reset({0, 0, 0}, {7, 8, 10});
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 9; ++j)
      for (int k = 0; k < 11; ++k) {
        grid.cell_map.value[grid.cell_map.offset({i, j, k})] = grid.n_cells();
        grid.cell_index.push_back({i, j, k});
      }
  const int n = grid.n_cells();
  Eigen::MatrixXd S(n, n);
  SchurMatrix entries;
  entries.reset(grid);
  for (int c = 0; c < n; ++c)
    for (int other = 0; other <= c; ++other) {
      const auto &a = grid.cell_index[c], &b = grid.cell_index[other];
      S(c, other) = S(other, c) = inside({a[0] - b[0], a[1] - b[1], a[2] - b[2]}) * (c == other ? 1.01 : 1.0);
      if (S(c, other) != 0.0) entries.add(grid, c, other, static_cast<float>(S(c, other)));
    }
  Fsai near;
  near.build(entries);
  Eigen::MatrixXd F_F(n, n);
  for (int c = 0; c < n; ++c) {
    near.apply_in_region(entries.layout, Eigen::VectorXf::Unit(n, c));
    for (int k = 0; k < n; ++k) F_F(k, c) = entries.layout.x[entries.layout.place_of[k]];
  }
  const auto condition = [&](const Eigen::MatrixXd& preconditioner) {
    const Eigen::MatrixXd L = preconditioner.llt().matrixL();
    const Eigen::VectorXd spectrum =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(L.transpose() * S * L, Eigen::EigenvaluesOnly)
            .eigenvalues();
    return spectrum.maxCoeff() / spectrum.minCoeff();
  };
  const double own = condition(F_F), diagonal = condition(Eigen::MatrixXd::Identity(n, n) / S(0, 0));
  std::printf("condition of S: %.1f with its diagonal, %.1f with F' F\n", diagonal, own);
  EXPECT_LE(own, diagonal / 4);
}

}  // namespace
}  // namespace tremie
