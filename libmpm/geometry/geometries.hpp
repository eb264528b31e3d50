#pragma once

// What differs between axisymmetric, plane-strain, three-dimensional and circling concrete, and nothing else.
//
// A space states how the velocity gradient turns into the strain-rate vector q and the divergence. q lists
// the deviatoric rate of deformation in an orthonormal basis, scaled so that |q| = gamma_dot = sqrt(2 D':D')
// exactly (equation (28)); the deviatoric stress in the same basis is s = eta q and the dissipated power is
// s.q. A node with shape value N and gradient g contributes q += B u and div += b.u with its velocity u.

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace tremie {

template <int D>
using Vec = Eigen::Matrix<double, D, 1>;
template <int R, int C>
using Mat = Eigen::Matrix<double, R, C>;

inline constexpr double inv_sqrt3 = 0.57735026918962576451;

/// Coordinates (r, z) with z up; volumes are those of the whole ring, 2 pi r dr dz. q = (rr - zz, (rr + zz -
/// 2 tt)/sqrt 3, 2 rz).
struct Axisymmetric {
  static constexpr int dim = 2, n_strain = 3, up = 1;
  static constexpr bool advects = true;  ///< points move with the flow through the grid
  static double measure(const Vec<2>& x) { return 2.0 * std::numbers::pi * x[0]; }
  static double hoop(double N, const Vec<2>& x) { return N / x[0]; }
  static Mat<3, 2> strain_rows(double N, const Vec<2>& g, const Vec<2>& x) {
    Mat<3, 2> B;
    B << g[0], -g[1],                                             //
        (g[0] - 2.0 * hoop(N, x)) * inv_sqrt3, g[1] * inv_sqrt3,  //
        g[1], g[0];
    return B;
  }
  static Vec<2> divergence_row(double N, const Vec<2>& g, const Vec<2>& x) {
    return {g[0] + hoop(N, x), g[1]};
  }
};

/// Coordinates (x, y) with y up; volumes per metre of width. q = (xx - yy, (xx + yy)/sqrt 3, 2 xy).
struct PlaneStrain {
  static constexpr int dim = 2, n_strain = 3, up = 1;
  static constexpr bool advects = true;
  static double measure(const Vec<2>&) { return 1.0; }
  static Mat<3, 2> strain_rows(double, const Vec<2>& g, const Vec<2>&) {
    Mat<3, 2> B;
    B << g[0], -g[1], g[0] * inv_sqrt3, g[1] * inv_sqrt3, g[1], g[0];
    return B;
  }
  static Vec<2> divergence_row(double, const Vec<2>& g, const Vec<2>&) { return g; }
  /// The divergence is in q too: divergence_part().q.
  static Vec<3> divergence_part() { return {0.0, std::numbers::sqrt3, 0.0}; }
  static double divergence_of(const Vec<3>& q) { return std::numbers::sqrt3 * q[1]; }
};

/// Rotation in circles about an axis: the coordinate r and the one velocity v_theta(r); volumes per metre of
/// height. q = r d(v/r)/dr = v' - v/r. No volume change, and a point keeps its radius.
struct Couette {
  static constexpr int dim = 1, n_strain = 1;
  static constexpr bool advects = false;
  static double measure(const Vec<1>& x) { return 2.0 * std::numbers::pi * x[0]; }
  static Mat<1, 1> strain_rows(double N, const Vec<1>& g, const Vec<1>& x) {
    return Mat<1, 1>(g[0] - N / x[0]);
  }
  static Vec<1> divergence_row(double, const Vec<1>&, const Vec<1>&) { return Vec<1>::Zero(); }
};

/// Coordinates (x, y, z) with z up. q = (xx - yy, (xx + yy - 2 zz)/sqrt 3, 2 xy, 2 yz, 2 xz).
struct ThreeD {
  static constexpr int dim = 3, n_strain = 5, up = 2;
  static constexpr bool advects = true;
  static double measure(const Vec<3>&) { return 1.0; }
  static Mat<5, 3> strain_rows(double, const Vec<3>& g, const Vec<3>&) {
    Mat<5, 3> B;
    B << g[0], -g[1], 0.0,                                            //
        g[0] * inv_sqrt3, g[1] * inv_sqrt3, -2.0 * g[2] * inv_sqrt3,  //
        g[1], g[0], 0.0,                                              //
        0.0, g[2], g[1],                                              //
        g[2], 0.0, g[0];
    return B;
  }
  static Vec<3> divergence_row(double, const Vec<3>& g, const Vec<3>&) { return g; }
};

}  // namespace tremie
