#pragma once

// The yield stress of a section averaged between two side walls.
//
// Walls at the distance W to which the concrete sticks share its yield stress with the plane of the section: the shear towards
// them grows linearly from the middle, s tau_y zeta with zeta from 0 to 1, and leaves sqrt(tau_y^2 - (s tau_y zeta)^2) to the
// plane, in the mean f(s) tau_y,
//
//   f(s) = 1/2 (sqrt(1 - s^2) + asin(s)/s),     f(0) = 1, f(1) = pi/4,
//
// while the walls hold s tau_y. Of all s the concrete has the one that dissipates most (maximum dissipation, von Mises): of
// f(s) gamma_dot + s 2 u/W at the shear rate gamma_dot in the plane and the speed u along the walls.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie::detail {

/// f(s): what side walls that hold s tau_y leave of the yield stress to the plane.
inline double share_of_plane(double s) {
  return s < 1e-4 ? 1.0 : 0.5 * (std::sqrt(std::max(0.0, 1.0 - s * s)) + std::asin(s) / s);
}

/// s of the most dissipation, from R = (2 u/W)/gamma_dot = -f'(s); 1 from R = pi/4 on.
inline double share_of_walls(double R) {
  constexpr int n = 256;
  constexpr double last = 0.25 * std::numbers::pi;
  static const std::array<double, n + 1> table = [] {
    std::array<double, n + 1> s_of{};
    const auto slope = [](double s) {
      return s < 1e-3 ? s / 3.0 : 0.5 * (std::asin(s) / (s * s) - std::sqrt(1.0 - s * s) / s);
    };
    for (int i = 0; i <= n; ++i) {
      double low = 0.0, high = 1.0;
      for (int k = 0; k < 50; ++k)
        (slope(0.5 * (low + high)) < last * i / n ? low : high) = 0.5 * (low + high);
      s_of[i] = high;
    }
    return s_of;
  }();
  if (!(R < last)) return 1.0;
  const double at = R / last * n;
  const int i = std::min(n - 1, static_cast<int>(at));
  return std::lerp(table[i], table[i + 1], at - i);
}

/// The walls' share at the places of a cell that has not flowed: all.
template <class Geometry>
inline constexpr std::array<double, power(2, Geometry::dim)> walls_hold_all = [] {
  std::array<double, power(2, Geometry::dim)> all{};
  all.fill(1.0);
  return all;
}();

/// Shares out the yield stress at every place by the velocities v of the nodes before the step. A place keeps its share where it
/// neither shears nor moves along the walls faster than `renewed_from` [1/s]. `most`: what the walls' own layer can hold [Pa].
template <class Geometry>
void share_yield_stress(const ActiveGrid<Geometry::dim>& grid, const std::vector<Vec<Geometry::dim>>& v,
                        double W, double most, double renewed_from,
                        std::vector<std::array<double, power(2, Geometry::dim)>>& wall_share,
                        Quadrature<Geometry>& quadrature) {
  constexpr int D = Geometry::dim;
  if (wall_share.empty()) wall_share.assign(grid.cell_index.size(), walls_hold_all<Geometry>);
  quadrature.own_yield = quadrature.wall_yield = quadrature.tau_y;
#pragma omp parallel for schedule(static)
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int k = 0; k < power(2, D); ++k) {
      const Stencil<D> st = stencil<D>(grid.axes, grid.cell_index[c], quadrature.place[c][k]);
      Vec<Geometry::n_strain> q = Vec<Geometry::n_strain>::Zero();
      Vec<D> u = Vec<D>::Zero();
      for (int i = 0; i < power(3, D); ++i) {
        const Vec<D>& v_i = v[grid.cell_nodes[c][i]];
        q += quadrature.B[c][k][i] * v_i, u += st.N[i] * v_i;
      }
      const double gamma_dot = q.norm(), along = 2.0 * u.norm() / W;
      double &tau_y = quadrature.tau_y[c][k], &s = wall_share[c][k];
      if (std::max(gamma_dot, along) > renewed_from) s = share_of_walls(along / std::max(gamma_dot, 1e-12));
      quadrature.wall_yield[c][k] = s * tau_y;
      tau_y *= share_of_plane(std::min(s, most / std::max(tau_y, 1e-12)));
    }
}

}  // namespace tremie::detail
