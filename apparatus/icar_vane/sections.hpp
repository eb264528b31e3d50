#pragma once

// The two sections that a vane is run in. Each states: its body at rest, how the vane turns at a speed, and
// the torques. All torques here are per metre of height and positive against a positive speed.

#include <numbers>

#include "apparatus/engine.hpp"
#include "apparatus/icar_vane/icar_vane.hpp"
#include "libmpm/points/seed.hpp"

namespace tremie::icar_vane {

struct Torques {
  double blades = 0.0, wall = 0.0;  ///< [N m/m]
  double angular_momentum = 0.0;    ///< of the concrete [kg m^2/s per m]
};

/// Concrete circling between a cylinder and the container: a radial line of cells.
struct CouetteSection {
  using Space = Couette;
  const Vane& vane;

  Body<Space> body_at_rest(const Scene& scene) const {
    Body<Space> body;
    body.mix = scene.mix;
    const double gap = vane.container_radius - vane.radius;
    const int n_cells = std::max(4, static_cast<int>(std::lround(gap / scene.model.cell[0])));
    body.grid.axes[0] = {.h = gap / n_cells,
                         .origin = vane.radius,
                         .low = FaceKind::no_slip,
                         .high = FaceKind::no_slip,
                         .n_cells = n_cells};
    seed_box<Space>(
        Vec<1>(vane.radius), Vec<1>(vane.container_radius), {n_cells * scene.model.points_per_cell[0]},
        scene.mix.density, scene.mix.K, [](const Vec<1>&) { return true; }, [](const Vec<1>&) { return 0.0; },
        body.points);
    return body;
  }
  void turn(Body<Space>& body, double omega, double) const {
    body.walls.v[0][0] = Vec<1>(omega * vane.radius);
  }

  Torques torques(const Body<Space>& body) const {
    Torques t;
    for (int i = 0; i < body.grid.n_nodes(); ++i) {
      const double r = body.grid.node_position(i)[0];
      if (body.grid.axes[0].on_low_wall(body.grid.node_index[i][0])) t.blades += r * body.wall_force[i][0];
      if (body.grid.axes[0].on_high_wall(body.grid.node_index[i][0])) t.wall -= r * body.wall_force[i][0];
    }
    for (std::size_t p = 0; p < body.points.size(); ++p)
      t.angular_momentum += body.points.mass[p] * body.points.x[p][0] * body.points.v[p][0];
    return t;
  }
  double radius(const Vec<1>& x) const { return x[0]; }
  double speed(const Vec<1>&, const Vec<1>& v) const { return v[0]; }
};

/// A horizontal section through the blades, the vane turning in a container at rest; blades and container are
/// boundary points half a cell apart.
struct PlaneSection {
  using Space = PlaneStrain;
  const Vane& vane;
  double spacing, orientation;  ///< of the boundary points [m]; of the first blade at time 0 [rad]
  std::vector<BoundaryPoint<2>> container{};

  PlaneSection(const Scene& scene)
      : vane(scene.vane), spacing(0.5 * scene.model.cell[0]), orientation(scene.orientation) {
    const int n = static_cast<int>(std::ceil(2.0 * std::numbers::pi * vane.container_radius / spacing));
    for (int k = 0; k < n; ++k) {
      const double a = 2.0 * std::numbers::pi * k / n;
      container.push_back({vane.container_radius * Vec<2>(std::cos(a), std::sin(a))});
    }
  }
  /// Whether a place lies inside a blade, in the frame of the vane at the angle `turned`.
  bool in_blade(const Vec<2>& x, double turned) const {
    for (int b = 0; b < vane.blades; ++b) {
      const double a = turned + 2.0 * std::numbers::pi * b / vane.blades;
      const double along = x[0] * std::cos(a) + x[1] * std::sin(a),
                   across = -x[0] * std::sin(a) + x[1] * std::cos(a);
      if (along >= 0.0 && along <= vane.radius && std::abs(across) <= 0.5 * vane.blade_thickness) return true;
    }
    return false;
  }
  Body<Space> body_at_rest(const Scene& scene) const {
    Body<Space> body;
    body.mix = scene.mix;
    for (int d = 0; d < 2; ++d) body.grid.axes[d] = {.h = scene.model.cell[0]};
    const double R = vane.container_radius;
    const int n =
        static_cast<int>(std::lround(2.0 * R / scene.model.cell[0] * scene.model.points_per_cell[0]));
    seed_box<Space>(
        {-R, -R}, {R, R}, {n, n}, scene.mix.density, scene.mix.K,
        [&](const Vec<2>& x) { return x.norm() < R && !in_blade(x, orientation); },
        [](const Vec<2>&) { return 0.0; }, body.points);
    return body;
  }
  /// The vane at the angle `turned`, turning at omega: the outlines of its blades.
  void turn(Body<Space>& body, double omega, double turned) const {
    body.boundary = container;
    const double half = 0.5 * vane.blade_thickness;
    const int n = static_cast<int>(std::ceil(vane.radius / spacing));
    for (int b = 0; b < vane.blades; ++b) {
      const double a = orientation + turned + 2.0 * std::numbers::pi * b / vane.blades;
      const Vec<2> along(std::cos(a), std::sin(a)), across(-std::sin(a), std::cos(a));
      for (int k = 0; k <= n; ++k)
        for (double side : {-half, half}) {
          const Vec<2> x = vane.radius * k / n * along + side * across;
          body.boundary.push_back({x, omega * Vec<2>(-x[1], x[0])});
        }
    }
  }
  Torques torques(const Body<Space>& body) const {
    Torques t;
    for (const BoundPoint<2>& b : body.bound) {
      const Vec<2> F = wall_force<2>(b, body.grid.cell_nodes, body.v), x = body.boundary[b.source].x;
      const double moment = x[0] * F[1] - x[1] * F[0];
      if (b.source < static_cast<int>(container.size()))
        t.wall -= moment;
      else
        t.blades += moment;
    }
    const auto& p = body.points;
    for (std::size_t i = 0; i < p.size(); ++i)
      t.angular_momentum += p.mass[i] * (p.x[i][0] * p.v[i][1] - p.x[i][1] * p.v[i][0]);
    return t;
  }
  double radius(const Vec<2>& x) const { return x.norm(); }
  double speed(const Vec<2>& x, const Vec<2>& v) const { return (x[0] * v[1] - x[1] * v[0]) / x.norm(); }
};

}  // namespace tremie::icar_vane
