#pragma once

// A plane in polar coordinates (r, theta) about an axis, for what turns in a round container: the container
// and a shaft are then ends of an axis of the grid, exactly, and a sector that repeats itself is a periodic
// axis.
//
// Velocities are (v_r, v_theta) [m/s] as a standing observer sees them, in the basis at their own place.
// Volumes are per metre of height. q = (rr - tt, (rr + tt)/sqrt 3, 2 rt), as in the Cartesian plane.

#include "libmpm/geometry/geometries.hpp"

namespace tremie {

struct Polar {
  static constexpr int dim = 2, n_strain = 3;
  static constexpr bool advects = true;
  static double measure(const Vec<2>& x) { return x[0]; }
  static Mat<3, 2> strain_rows(double N, const Vec<2>& g, const Vec<2>& x) {
    const double hoop = N / x[0], around = g[1] / x[0];
    Mat<3, 2> B;
    B << g[0] - hoop, -around,                          //
        (g[0] + hoop) * inv_sqrt3, around * inv_sqrt3,  //
        around, g[0] - hoop;
    return B;
  }
  static Vec<2> divergence_row(double N, const Vec<2>& g, const Vec<2>& x) {
    return {g[0] + N / x[0], g[1] / x[0]};
  }
};

}  // namespace tremie
