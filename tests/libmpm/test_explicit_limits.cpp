// The eigenvalues behind the limits of an explicit step, computed: patches of full cells with their lumped
// masses, free or between walls on which they stick or slide.

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "libmpm/explicit/stability_limits.hpp"

namespace tremie {
namespace {

constexpr int cells = 4;

struct Pencil {
  Eigen::MatrixXd K;
  Eigen::VectorXd M;
};

/// Largest eigenvalue of K x = kappa M x among the components that are free.
double largest(const Pencil& p, const std::vector<char>& fixed) {
  std::vector<int> free;
  for (int i = 0; i < p.M.size(); ++i)
    if (p.M[i] > 1e-12 && !fixed[i]) free.push_back(i);
  const auto n = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      A(i, j) = p.K(free[i], free[j]) / std::sqrt(p.M[free[i]] * p.M[free[j]]);
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

enum class Row { strain, cell_divergence, point_divergence };

/// A patch of 4 cells a direction of size 1, two points a cell in each.
template <int D>
Pencil patch(const std::array<Axis, D>& axes, const Shape<D>& shape, Row row) {
  using Geometry = std::conditional_t<D == 2, PlaneStrain, ThreeD>;
  const int nodes = power(tile_span, D);
  Pencil p{Eigen::MatrixXd::Zero(nodes * D, nodes * D), Eigen::VectorXd::Zero(nodes * D)};
  const double V = 1.0 / power(2, D);
  for (int i = 0; i < power(2 * cells, D); ++i) {
    std::array<f64x8, D> x, centre;
    for (int d = 0, rest = i; d < D; ++d, rest /= 2 * cells) {
      x[d] = all_lanes(0.5 * (rest % (2 * cells) + 0.5));
      centre[d] = floor(x[d]) + 0.5;
    }
    Weights<double, D> mass, place;
    weigh<double, D>({axes, shape, {}}, x, mass);
    Shape<D> hats = shape;  // without extent, at the cell's centre: its corners' hats
    if (shape.kind == ShapeFunctions::gimp) hats.half.fill(1e-9);
    const bool at_cell = row == Row::cell_divergence;
    weigh<double, D>({axes, at_cell ? hats : shape, {}}, at_cell ? centre : x, place);
    constexpr int n = power(3, D), rows = Geometry::n_strain;
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(row == Row::strain ? rows : 1, n * D);
    std::array<int, n> at;
    for (int k = 0; k < n; ++k) {
      const Index<D> o = local_offset<D>(k);
      double N = 1.0;
      Vec<D> g;
      int in_mass = mass.base[0];
      at[k] = place.base[0];
      for (int d = 0; d < D; ++d) {
        N *= mass.w[d][o[d]][0], g[d] = place.dw[d][o[d]][0];
        for (int e = 0; e < D; ++e)
          if (e != d) g[d] *= place.w[e][o[e]][0];
        in_mass += o[d] * stride<D>(tile_span, d), at[k] += o[d] * stride<D>(tile_span, d);
      }
      for (int d = 0; d < D; ++d) p.M[in_mass * D + d] += V * N;
      const Vec<D> somewhere = Vec<D>::Ones();
      if (row == Row::strain)
        B.middleCols(k * D, D) = Geometry::strain_rows(0.0, g, somewhere);
      else
        B.middleCols(k * D, D) = Geometry::divergence_row(0.0, g, somewhere).transpose();
    }
    const Eigen::MatrixXd K = V * B.transpose() * B;
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j) p.K.block(at[k] * D, at[j] * D, D, D) += K.block(k * D, j * D, D, D);
  }
  return p;
}

template <int D>
std::vector<char> fixed_by_walls(const std::array<Axis, D>& axes, const Shape<D>& shape) {
  std::vector<char> fixed(power(tile_span, D) * D, 0);
  for (int node = 0; node < power(tile_span, D); ++node)
    for (int d = 0; d < D; ++d) {
      const int at = node / stride<D>(tile_span, d) % tile_span - 1;
      const bool wall = (axes[d].wall_low() && at == shape.low_wall()) ||
                        (axes[d].wall_high() && at == axes[d].n_cells + 1);
      for (int e = 0; e < D && wall; ++e)
        if (e == d || axes[d].low == FaceKind::no_slip) fixed[node * D + e] = 1;
    }
  return fixed;
}

template <int D>
void expect_bounds(ShapeFunctions kind) {
  Shape<D> shape{kind, {}};
  shape.half.fill(0.25);
  const Eigenvalues bound = largest_eigenvalues(kind);
  for (const FaceKind face : {FaceKind::open, FaceKind::no_slip, FaceKind::free_slip}) {
    std::array<Axis, D> axes;
    for (Axis& a : axes) a = {.h = 1.0, .low = face, .high = face, .n_cells = cells};
    const auto fixed = fixed_by_walls<D>(axes, shape);
    const double kappa = largest(patch<D>(axes, shape, Row::strain), fixed);
    const double chi_cell = largest(patch<D>(axes, shape, Row::cell_divergence), fixed);
    const double chi_point = largest(patch<D>(axes, shape, Row::point_divergence), fixed);
    std::printf("D = %d %s, %s: kappa %.3f, chi %.3f by the cell, %.3f by the point\n", D,
                kind == ShapeFunctions::gimp ? "GIMP" : "splines",
                face == FaceKind::open      ? "free"
                : face == FaceKind::no_slip ? "sticking"
                                            : "sliding",
                kappa, chi_cell, chi_point);
    EXPECT_LE(kappa, bound.viscous);
    EXPECT_LE(4.0 / 3.0 * chi_cell, bound.acoustic);
    EXPECT_LE(chi_point, bound.acoustic);
  }
}

TEST(Eigenvalues, SplinesInThePlane) { expect_bounds<2>(ShapeFunctions::b_spline); }
TEST(Eigenvalues, SplinesInSpace) { expect_bounds<3>(ShapeFunctions::b_spline); }
TEST(Eigenvalues, GimpInThePlane) { expect_bounds<2>(ShapeFunctions::gimp); }
TEST(Eigenvalues, GimpInSpace) { expect_bounds<3>(ShapeFunctions::gimp); }

}  // namespace
}  // namespace tremie
