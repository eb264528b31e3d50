#pragma once

// Cylindrical coordinates (r, theta, z) about an axis, for what turns in a round container and has ends.
//
// Velocities are (v_r, v_theta, v_z) [m/s] as a standing observer sees them, in the basis at their own place. q = (rr -
// tt, (rr + tt - 2 zz)/sqrt 3, 2 rt, 2 tz, 2 rz), as in the Cartesian space.

#include "libmpm/geometry/geometries.hpp"

namespace tremie {

struct Cylindrical {
  static constexpr int dim = 3, n_strain = 5;
  static constexpr bool advects = false;  ///< steady flow: nothing that the concrete carries changes it
  static double measure(const Vec<3>& x) { return x[0]; }
  static Mat<5, 3> strain_rows(double N, const Vec<3>& g, const Vec<3>& x) {
    const double hoop = N / x[0], around = g[1] / x[0];
    Mat<5, 3> B;
    B << g[0] - hoop, -around, 0.0,                                              //
        (g[0] + hoop) * inv_sqrt3, around * inv_sqrt3, -2.0 * g[2] * inv_sqrt3,  //
        around, g[0] - hoop, 0.0,                                                //
        0.0, g[2], around,                                                       //
        g[2], 0.0, g[0];
    return B;
  }
  static Vec<3> divergence_row(double N, const Vec<3>& g, const Vec<3>& x) {
    return {g[0] + N / x[0], g[1] / x[0], g[2]};
  }
};

}  // namespace tremie
