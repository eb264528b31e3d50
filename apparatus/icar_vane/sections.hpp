#pragma once

// The two sections that a vane is run in. Each states: its body at rest, how the vane turns at a speed, and
// the torques. All torques here are per metre of height and positive against a positive speed.

#include <numbers>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/run/step_settings.hpp"
#include "libmpm/boundary/wall_term.hpp"
#include "libmpm/implicit/particle_splitting.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::icar_vane {

struct Torques {
  double blades = 0.0, wall = 0.0;  ///< [N m/m]
  double angular_momentum = 0.0;    ///< of the concrete [kg m^2/s per m]
  double power = 0.0;               ///< dissipated by the stresses [W/m]
  double slip = 0.0;                ///< mean speed along the wall that slides [m/s]
};

inline constexpr double thinnest = 0.125;  ///< of a cell: a thinner blade is a sheet

/// Mean speed at which the concrete slides along the wall with a wall law in the last step [m/s]; 0 without one.
template <class Geometry>
double mean_slip(const ImplicitBody<Geometry>& body) {
  double sum = 0.0;
  for (const auto& term : body.wall_nodes) sum += slip_velocity(term, body.v).norm();
  return body.wall_nodes.empty() ? 0.0 : sum / static_cast<double>(body.wall_nodes.size());
}

/// Concrete circling between a cylinder and the container: a radial line of cells.
struct CouetteSection {
  using Geometry = Couette;
  const Vane& vane;

  Body<Geometry> body_at_rest(const Scene& scene) const {
    Body<Geometry> body;
    body.mix = scene.mix;
    const double gap = vane.container_radius - vane.radius;
    const int n_cells = std::max(4, static_cast<int>(std::lround(gap / scene.model.cell[0])));
    body.grid.axes[0] = {.h = gap / n_cells,
                         .origin = vane.radius,
                         .low = cylinder_face(scene),
                         .high = container_face(scene),
                         .n_cells = n_cells};
    seed_box<Geometry>(
        Vec<1>(vane.radius), Vec<1>(vane.container_radius), {n_cells * scene.model.points_per_cell[0]},
        scene.mix.density, scene.mix.K, [](const Vec<1>&) { return true; }, [](const Vec<1>&) { return 0.0; },
        body.points);
    return body;
  }
  void turn(Body<Geometry>& body, double omega) const { body.walls.v[0][0] = Vec<1>(omega * vane.radius); }

  Torques torques(const ImplicitBody<Geometry>& body) const {
    Torques t;
    for (int i = 0; i < body.grid.n_nodes(); ++i) {
      const double r = body.grid.node_position(i)[0];
      if (body.grid.axes[0].on_low_wall(body.grid.node_index[i][0])) t.blades += r * body.wall_force[i][0];
      if (body.grid.axes[0].on_high_wall(body.grid.node_index[i][0])) t.wall -= r * body.wall_force[i][0];
    }
    t.slip = mean_slip(body);
    for (std::size_t p = 0; p < body.points.size(); ++p)
      t.angular_momentum += body.points.mass[p] * body.points.x[p][0] * body.points.v[p][0];
    t.power = body.dissipation;
    return t;
  }
  double radius(const Vec<1>& x) const { return x[0]; }
  double speed(const Vec<1>&, const Vec<1>& v) const { return v[0]; }
  Frame whole(const Frame& line, double) const { return line; }
};

/// A horizontal section through the blades, in polar coordinates that turn with the vane. One blade and its
/// share of the container repeat all around. Container, shaft and blade lie on faces of the grid: the
/// container and the shaft are the ends of the radial axis, the blade is a block of cells from the shaft to
/// its tip, as thick as the real one at its tip and thinner inwards, where the concrete turns with it.
struct PlaneSection {
  using Geometry = Polar;
  const Vane& vane;
  double sector;               ///< one blade's share [rad]
  double shaft;                ///< a whole number of cells inside the tips [m]
  std::array<double, 2> cell;  ///< [m], [rad]
  int n_blade, n_radial;       ///< cells from the shaft to the tips and to the container
  int n_thick, n_around;       ///< cells across the blade and around

  explicit PlaneSection(const Scene& scene)
      : vane(scene.vane), sector(2.0 * std::numbers::pi / scene.vane.blades) {
    const double gap = vane.container_radius - vane.radius, arc = sector * vane.radius;
    const auto cells = [](double length, double size, int least) {
      return std::max(least, static_cast<int>(std::lround(length / size)));
    };
    const int n_gap = cells(gap, scene.model.cell[0], 2);
    n_blade = cells(vane.radius - vane.shaft_radius, gap / n_gap, 2);
    n_radial = n_gap + n_blade;
    const bool sheet = vane.blade_thickness < thinnest * scene.model.cell[1];
    n_thick = sheet ? 0 : cells(vane.blade_thickness, scene.model.cell[1], 1);
    n_around =
        n_thick > 0 ? n_thick * cells(arc, vane.blade_thickness, 2) : cells(arc, scene.model.cell[1], 4);
    cell = {gap / n_gap, sector / n_around};
    shaft = vane.radius - n_blade * cell[0];
  }
  Body<Geometry> body_at_rest(const Scene& scene) const {
    Body<Geometry> body;
    body.mix = scene.mix;
    const int first = (n_around - n_thick) / 2;
    body.grid.axes[0] = {.h = cell[0],
                         .origin = shaft,
                         .low = FaceKind::no_slip,
                         .high = container_face(scene),
                         .n_cells = n_radial,
                         .repeated_knots = {n_blade}};
    body.grid.axes[1] = {.h = cell[1], .periodic = true, .n_cells = n_around, .repeated_knots = {first}};
    if (n_thick > 0) body.grid.axes[1].repeated_knots.push_back(first + n_thick);
    body.grid.blocks = {{{0, first}, {n_blade, first + n_thick}, {}}};
    const auto wrapped = [&](const Vec<2>& x) {
      return Vec<2>(x[0], x[1] - sector * std::floor(x[1] / sector));
    };
    const auto in_concrete = [&](const Vec<2>& x) {
      return !block_of_cell<2>(body.grid, detail::cell_of<2>(body.grid.axes, wrapped(x)));
    };
    seed_box<Geometry>(
        {shaft, scene.orientation}, {vane.container_radius, sector + scene.orientation},
        {n_radial * scene.model.points_per_cell[0], n_around * scene.model.points_per_cell[1]},
        scene.mix.density, scene.mix.K, in_concrete, [](const Vec<2>&) { return 0.0; }, body.points);
    for (Vec<2>& x : body.points.x) x = wrapped(x);
    return body;
  }
  /// The vane turns at omega, and the grid with it. The section is full.
  void turn(Body<Geometry>& body, double omega) const {
    body.motion.grid_rate = omega;
    body.walls.v[0][0] = Vec<2>(0.0, omega * shaft);
    split_particles<2>(body.grid.axes, body.grid.blocks, body.points);
    body.grid.blocks[0].velocity = [omega](const Vec<2>& x) { return Vec<2>(0.0, omega * x[0]); };
  }
  /// The nodal velocity v_theta = r of a turn as a whole strains nothing, so that the moments of the nodal
  /// forces are in balance to the last digit.
  Torques torques(const ImplicitBody<Geometry>& body) const {
    Torques t;
    for (int i = 0; i < body.grid.n_nodes(); ++i) {
      const double r = body.grid.node_position(i)[0], moment = r * body.wall_force[i][1];
      if (body.grid.axes[0].on_high_wall(body.grid.node_index[i][0]))
        t.wall -= moment;
      else
        t.blades += moment;  // nothing, where the node is free
      t.angular_momentum += r * body.nodes.mass[i] * body.v[i][1];
    }
    for (double* all : {&t.blades, &t.wall, &t.angular_momentum}) *all *= vane.blades;
    t.power = vane.blades * body.dissipation;
    t.slip = mean_slip(body);
    return t;
  }
  double radius(const Vec<2>& x) const { return x[0]; }
  double speed(const Vec<2>&, const Vec<2>& v) const { return v[1]; }
  /// The whole section, as a standing observer sees it after the vane has turned by `turned`; its blades
  /// stood along the axes at the start.
  Frame whole(const Frame& part, double turned) const {
    Frame all;
    all.time = part.time;
    for (int b = 0; b < vane.blades; ++b) {
      const double a = turned + (b - 0.5) * sector, c = std::cos(a), s = std::sin(a);
      const auto turn_into = [&](const auto& from, auto& to) {
        for (const auto& x : from) to.push_back({c * x[0] - s * x[1], s * x[0] + c * x[1], 0.0});
      };
      turn_into(part.position, all.position);
      turn_into(part.velocity, all.velocity);
      for (const auto field : {&Frame::volume, &Frame::pressure, &Frame::shear_rate, &Frame::flocculation})
        (all.*field).insert((all.*field).end(), (part.*field).begin(), (part.*field).end());
    }
    return all;
  }
};

}  // namespace tremie::icar_vane
