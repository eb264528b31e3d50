#include "apparatus/verification/references/vane_finite_elements.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <Eigen/SparseLU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace tremie::verification {
namespace {

using Position = std::array<double, 2>;  // r [m], theta [rad]

/// A logical rectangle of elements; those that the blade's half tip covers inside its radius are left out.
struct Mesh {
  int n_r = 0, n_theta = 0, n_tip = 0, tip = 0;  // n_tip elements before half the tip, from column `tip` on
  std::vector<Position> corners;                 // (n_r + 1) by (n_theta + 1)
  bool fluid(int i, int j) const { return i >= tip || j >= n_tip; }
  const Position& corner(int i, int j) const {
    return corners[static_cast<std::size_t>(i * (n_theta + 1) + j)];
  }
};

Mesh mesh_of(const BladeFlow& b) {
  Mesh mesh;
  mesh.tip = b.n;
  mesh.n_r = 2 * b.n;
  mesh.n_tip = b.thickness > 0.0 ? std::max(2, b.n / 8) : 0;
  mesh.n_theta = b.n + mesh.n_tip;
  const auto closing_up = [](double from, double to, double s) { return from + (to - from) * s * s * s; };
  for (int i = 0; i <= mesh.n_r; ++i) {
    const double s = std::abs(i - mesh.tip) / static_cast<double>(b.n);
    const double r = closing_up(b.radius, i < mesh.tip ? b.shaft_radius : b.container_radius, s);
    const double face = std::asin(0.5 * b.thickness / std::min(r, b.radius)),
                 middle = std::numbers::pi / b.blades;
    for (int j = 0; j <= mesh.n_theta; ++j)
      mesh.corners.push_back({r, j < mesh.n_tip ? face * j / mesh.n_tip
                                                : closing_up(face, middle, (j - mesh.n_tip) / double(b.n))});
  }
  return mesh;
}

/// Values and derivatives of the three quadratics on [-1, 1].
std::array<double, 3> quadratics(double x) { return {0.5 * x * (x - 1), 1 - x * x, 0.5 * x * (x + 1)}; }
std::array<double, 3> slopes(double x) { return {x - 0.5, -2 * x, x + 0.5}; }

/// One element at one Gauss point: strain rates (rr, theta theta, r theta) of each velocity unknown,
/// divergence by their first two, pressures, and the area that the point stands for.
struct GaussPoint {
  Eigen::Matrix<double, 3, 18> B;
  std::array<double, 4> pressure;
  double area;
};

GaussPoint gauss_point(const Mesh& mesh, int i, int j, double x, double y) {
  GaussPoint g;
  g.pressure = {0.25 * (1 - x) * (1 - y), 0.25 * (1 - x) * (1 + y), 0.25 * (1 + x) * (1 - y),
                0.25 * (1 + x) * (1 + y)};
  const std::array<double, 4> by_x = {-0.25 * (1 - y), -0.25 * (1 + y), 0.25 * (1 - y), 0.25 * (1 + y)},
                              by_y = {-0.25 * (1 - x), 0.25 * (1 - x), -0.25 * (1 + x), 0.25 * (1 + x)};
  double r = 0.0;
  Eigen::Matrix2d J = Eigen::Matrix2d::Zero();  // of (r, theta) by (x, y)
  for (int c = 0; c < 4; ++c) {
    const auto k = static_cast<std::size_t>(c);
    const auto [rc, thetac] = mesh.corner(i + c / 2, j + c % 2);
    r += g.pressure[k] * rc;
    J += Eigen::Vector2d(rc, thetac) * Eigen::RowVector2d(by_x[k], by_y[k]);
  }
  g.area = J.determinant() * r;
  const Eigen::Matrix2d inverse = J.inverse();
  const auto qx = quadratics(x), qy = quadratics(y), sx = slopes(x), sy = slopes(y);
  for (int a = 0; a < 9; ++a) {
    const auto p = static_cast<std::size_t>(a / 3), q = static_cast<std::size_t>(a % 3);
    const double N = qx[p] * qy[q];
    const Eigen::RowVector2d d = Eigen::RowVector2d(sx[p] * qy[q], qx[p] * sy[q]) * inverse;
    g.B.col(2 * a) << d[0], N / r, 0.5 * d[1] / r;
    g.B.col(2 * a + 1) << 0.0, d[1] / r, 0.5 * (d[0] - N / r);
  }
  return g;
}

/// The unknowns: two velocities a node of the quadratic mesh, then a pressure a corner; -1 where given.
struct Unknowns {
  std::vector<int> velocity, pressure;
  std::vector<double> given;
  int n = 0;
};

Unknowns number(const BladeFlow& b, const Mesh& mesh) {
  Unknowns u;
  const int nodes_r = 2 * mesh.n_r + 1, nodes_theta = 2 * mesh.n_theta + 1;
  u.velocity.assign(static_cast<std::size_t>(2 * nodes_r * nodes_theta), -1);
  u.given.assign(u.velocity.size(), 0.0);
  u.pressure.assign(mesh.corners.size(), -1);
  for (int i = 0; i < nodes_r; ++i)
    for (int j = 0; j < nodes_theta; ++j) {
      const auto k = static_cast<std::size_t>(2 * (i * nodes_theta + j));
      const double r = 0.5 * (mesh.corner(i / 2, 0)[0] + mesh.corner((i + 1) / 2, 0)[0]);
      const bool vane = i == 0 || (i <= 2 * mesh.tip && j <= 2 * mesh.n_tip), wall = i == nodes_r - 1;
      u.given[k + 1] = vane ? b.omega * r : 0.0;
      if (vane || wall) continue;
      if (j > 0 && j < nodes_theta - 1) u.velocity[k] = u.n++;
      u.velocity[k + 1] = u.n++;
    }
  for (int i = 0; i <= mesh.n_r; ++i)
    for (int j = 0; j <= mesh.n_theta; ++j)
      if (i >= mesh.tip || j >= mesh.n_tip)
        u.pressure[static_cast<std::size_t>(i * (mesh.n_theta + 1) + j)] = u.n++;
  return u;
}

/// The velocities and pressures of the element (i, j) among the unknowns.
std::array<std::size_t, 22> members(const Mesh& mesh, int i, int j) {
  std::array<std::size_t, 22> m{};
  for (int a = 0; a < 9; ++a) {
    const int node = (2 * i + a / 3) * (2 * mesh.n_theta + 1) + 2 * j + a % 3;
    m[static_cast<std::size_t>(2 * a)] = static_cast<std::size_t>(2 * node);
    m[static_cast<std::size_t>(2 * a + 1)] = static_cast<std::size_t>(2 * node + 1);
  }
  for (int c = 0; c < 4; ++c)
    m[static_cast<std::size_t>(18 + c)] =
        static_cast<std::size_t>((i + c / 2) * (mesh.n_theta + 1) + j + c % 2);
  return m;
}

/// Residual and tangent of the element; returns the power that it dissipates.
double element(const BladeFlow& b, const Mesh& mesh, int i, int j, double eps,
               const Eigen::Matrix<double, 22, 1>& values, Eigen::Matrix<double, 22, 22>& K,
               Eigen::Matrix<double, 22, 1>& R) {
  constexpr std::array<double, 3> at = {-0.7745966692414834, 0.0, 0.7745966692414834},
                                  weight = {5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  K.setZero(), R.setZero();
  double power = 0.0;
  const Eigen::DiagonalMatrix<double, 3> twice_shear(1.0, 1.0, 2.0);  // D:E with r theta counted twice
  for (std::size_t p = 0; p < 3; ++p)
    for (std::size_t q = 0; q < 3; ++q) {
      const GaussPoint g = gauss_point(mesh, i, j, at[p], at[q]);
      const double w = weight[p] * weight[q] * g.area;
      const Eigen::Vector3d D = g.B * values.head<18>();
      const double gamma_dot2 = 2.0 * D.dot(twice_shear * D), root = std::sqrt(gamma_dot2 + eps * eps);
      const double eta = b.mu + b.tau_0 / root;
      const Eigen::Matrix<double, 18, 1> along = g.B.transpose() * (twice_shear * D);
      const Eigen::Matrix<double, 18, 1> divergence = (g.B.row(0) + g.B.row(1)).transpose();
      const Eigen::Map<const Eigen::Vector4d> N(g.pressure.data());
      K.topLeftCorner<18, 18>() += w * (2.0 * eta * (g.B.transpose() * (twice_shear * g.B)) -
                                        4.0 * b.tau_0 / (root * root * root) * along * along.transpose());
      K.topRightCorner<18, 4>() -= w * divergence * N.transpose();
      K.bottomLeftCorner<4, 18>() -= w * N * divergence.transpose();
      R.head<18>() += w * (2.0 * eta * along - divergence * N.dot(values.tail<4>()));
      R.tail<4>() -= w * divergence.dot(values.head<18>()) * N;
      power += w * eta * gamma_dot2;
    }
  return power;
}

}  // namespace

BladeFlow blade_flow_of(const icar_vane::Scene& s, int n) {
  return {.tau_0 = s.mix.tau_0,
          .mu = s.mix.mu,
          .omega = 2.0 * std::numbers::pi * s.speed,
          .radius = s.vane.radius,
          .container_radius = s.vane.container_radius,
          .shaft_radius = s.vane.shaft_radius,
          .thickness = s.vane.blade_thickness,
          .height = s.vane.height,
          .blades = s.vane.blades,
          .n = n};
}

double finite_element_torque(const BladeFlow& b) {
  const Mesh mesh = mesh_of(b);
  const Unknowns unknowns = number(b, mesh);
  std::vector<double> velocity = unknowns.given, pressure(unknowns.pressure.size(), 0.0);
  Eigen::SparseLU<Eigen::SparseMatrix<double>> lu;
  double power = 0.0;
  const auto newton = [&](double eps) {
    std::vector<Eigen::Triplet<double>> triplets;
    Eigen::VectorXd rest = Eigen::VectorXd::Zero(unknowns.n);
    power = 0.0;
    for (int i = 0; i < mesh.n_r; ++i)
      for (int j = 0; j < mesh.n_theta; ++j) {
        if (!mesh.fluid(i, j)) continue;
        const auto m = members(mesh, i, j);
        Eigen::Matrix<double, 22, 1> values, R;
        Eigen::Matrix<double, 22, 22> K;
        std::array<int, 22> row{};
        for (std::size_t a = 0; a < 22; ++a) {
          values[static_cast<Eigen::Index>(a)] = a < 18 ? velocity[m[a]] : pressure[m[a]];
          row[a] = a < 18 ? unknowns.velocity[m[a]] : unknowns.pressure[m[a]];
        }
        power += element(b, mesh, i, j, eps, values, K, R);
        for (std::size_t a = 0; a < 22; ++a) {
          if (row[a] < 0) continue;
          rest[row[a]] += R[static_cast<Eigen::Index>(a)];
          for (std::size_t c = 0; c < 22; ++c)
            if (row[c] >= 0)
              triplets.emplace_back(row[a], row[c],
                                    K(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(c)));
        }
      }
    Eigen::SparseMatrix<double> K(unknowns.n, unknowns.n);
    K.setFromTriplets(triplets.begin(), triplets.end());
    lu.compute(K);
    if (lu.info() != Eigen::Success) throw std::runtime_error("blade flow: no factor");
    const Eigen::VectorXd step = lu.solve(rest);
    for (std::size_t k = 0; k < velocity.size(); ++k)
      if (unknowns.velocity[k] >= 0) velocity[k] -= step[unknowns.velocity[k]];
    for (std::size_t k = 0; k < pressure.size(); ++k)
      if (unknowns.pressure[k] >= 0) pressure[k] -= step[unknowns.pressure[k]];
    return rest.norm();
  };
  double torque = 0.0, torque_before = 0.0;
  for (double eps = 256.0 * b.regularisation; eps > 0.99 * b.regularisation; eps *= 0.5) {
    const double first = newton(eps);
    double rest = first;
    for (int k = 0; k < 30 && rest > 1e-9 * first; ++k) rest = newton(eps);
    if (!(rest <= 1e-6 * first)) throw std::runtime_error("blade flow: Newton's method did not converge");
    torque_before = std::exchange(torque, 2.0 * b.blades * b.height * power / b.omega);
    if (b.tau_0 == 0.0) return torque;
  }
  return 2.0 * torque - torque_before;
}

}  // namespace tremie::verification
