#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/icar_vane/ends.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double sheet = 0.5;  // of a cell around: a thinner blade is a sheet
// The plane section is cheap: its cells resolve blades and gap whatever the space's are.
constexpr double cells_in_gap = 32.0;        // at least
constexpr double thinnest_resolved = 0.125;  // of a cell: a thinner blade is a sheet there too

int cells(double length, double size, int least) {
  return std::max(least, static_cast<int>(std::lround(length / size)));
}

/// Cells along the blades, of at most about the size: as many as put faces nearest to the floor and the surface.
int cells_along(const Vane& vane, double size) {
  const int least = cells(vane.height, size, 2);
  int best = least;
  double nearest = 1e9;
  for (int n = least; n <= least + least / 4; ++n) {
    const double h = vane.height / n;
    const auto off = [&](double gap) { return std::abs(std::max(1.0, std::round(gap / h)) * h / gap - 1.0); };
    const double miss = off(vane.bottom_gap) + off(vane.cover) + 0.002 * (n - least);
    if (miss < nearest - 1e-9) nearest = miss, best = n;
  }
  return best;
}

/// The scene on cells that resolve the blades of its plane section.
Scene resolving(Scene scene) {
  const Vane& vane = scene.vane;
  double& across = scene.model.cell[0];
  across = std::min(across, (vane.container_radius - vane.radius) / cells_in_gap);
  const bool thin = vane.blade_thickness < thinnest_resolved * across;
  scene.model.cell[1] = thin ? across : std::min(across, vane.blade_thickness);
  return scene;
}

/// Axes and blocks, without cells.
ActiveGrid<3> vane_grid(const Scene& scene, const EndsGrid& g) {
  const int first = (g.n_around - g.n_thick) / 2, top = g.n_bottom + g.n_height;
  const bool ends = g.n_bottom > 0;
  ActiveGrid<3> grid;
  auto& axes = grid.axes;
  axes[0] = {.h = g.cell[0],
             .origin = g.inner,
             .low = FaceKind::free_slip,
             .high = container_face(scene),
             .n_cells = g.n_radial,
             .repeated_knots = {g.n_blade}};
  if (g.n_shaft > 0 && g.n_shaft < g.n_blade)
    axes[0].repeated_knots.insert(axes[0].repeated_knots.begin(), g.n_shaft);
  axes[1] = {.h = g.cell[1], .periodic = true, .n_cells = g.n_around, .repeated_knots = {first}};
  if (g.n_thick > 0) axes[1].repeated_knots.push_back(first + g.n_thick);
  axes[2] = {.h = g.cell[2],
             .low = ends ? container_face(scene) : FaceKind::free_slip,
             .high = FaceKind::free_slip,
             .n_cells = top + g.n_cover};
  if (ends) axes[2].repeated_knots = {g.n_bottom, top};
  const int surface = axes[2].n_cells + 1;  // beyond the last face: its nodes are the block's too
  grid.blocks = {{{0, first, g.n_bottom}, {g.n_blade, first + g.n_thick, ends ? top : surface}, {}},
                 {{0, 0, g.n_bottom}, {g.n_shaft, g.n_around, surface}, {}}};
  return grid;
}

/// The plane section on this grid, at rest.
SteadySection section_of(const Scene& scene, const EndsGrid& g) {
  const ActiveGrid<3> space = vane_grid(scene, g);
  SteadySection body;
  body.mix = scene.mix;
  for (std::size_t d = 0; d < 2; ++d) body.grid.axes[d] = space.axes[d];
  for (const Block<3>& b : space.blocks)
    body.grid.blocks.push_back({{b.low[0], b.low[1]}, {b.high[0], b.high[1]}, {}});
  lay_out_steady_flow(body);
  return body;
}

/// Solves at a speed, and adds up the torques; of a section they are those of a metre.
template <class Geometry>
SteadyTorques turn(const Scene& scene, bool with_floor, double speed, ImplicitBody<Geometry>& body) {
  constexpr int D = Geometry::dim;
  const double omega = angular_speed(speed);
  for (auto& block : body.grid.blocks)
    block.velocity = [omega](const Vec<D>& x) {
      Vec<D> v = Vec<D>::Zero();
      v[1] = omega * x[0];
      return v;
    };
  SteadyTorques t;
  t.solve = solve_steady_flow(body, scene.model.law, scene.walls, std::abs(omega));
  const auto& axes = body.grid.axes;
  int n_wall = 0;
  for (int i = 0; i < body.grid.n_nodes(); ++i) {
    const auto& at = body.grid.node_index[i];
    const double moment = scene.vane.blades * body.grid.node_position(i)[0] * body.wall_force[i][1];
    const bool wall = axes[0].on_high_wall(at[0]), floor = with_floor && axes[D - 1].on_low_wall(at[D - 1]);
    (wall || floor ? t.wall : t.blades) += wall || floor ? -moment : moment;
    if (wall) t.slip += std::abs(body.v[i][1]), ++n_wall;
  }
  if (n_wall > 0) t.slip /= n_wall;
  t.power = scene.vane.blades * body.dissipation / omega;
  return t;
}

}  // namespace

EndsGrid::EndsGrid(const Scene& scene, bool with_ends) : sector(2.0 * std::numbers::pi / scene.vane.blades) {
  const Vane& vane = scene.vane;
  const double gap = vane.container_radius - vane.radius, arc = sector * vane.radius;
  const int n_gap = cells(gap, scene.model.cell[0], 2);
  cell[0] = gap / n_gap;
  n_blade = std::max(1, static_cast<int>(std::floor(vane.radius / cell[0] * (1.0 + 1e-12))));
  n_radial = n_gap + n_blade;
  inner = std::max(0.0, vane.radius - n_blade * cell[0]);
  n_shaft = std::clamp(static_cast<int>(std::lround((vane.shaft_radius - inner) / cell[0])), 0, n_blade - 1);
  const bool thin = vane.blade_thickness < sheet * scene.model.cell[1];
  n_thick = thin ? 0 : cells(vane.blade_thickness, scene.model.cell[1], 1);
  n_around = thin ? cells(arc, scene.model.cell[1], 4) : n_thick * cells(arc, vane.blade_thickness, 2);
  cell[1] = sector / n_around;
  n_height = cells_along(vane, scene.model.cell[0]);
  cell[2] = vane.height / n_height;
  n_bottom = with_ends ? cells(vane.bottom_gap, cell[2], 1) : 0;
  n_cover = with_ends ? cells(vane.cover, cell[2], 1) : 0;
  if (!with_ends) n_height = 2;
}

SteadyBody steady_body(const Scene& scene, const EndsGrid& grid) {
  SteadyBody body;
  body.mix = scene.mix;
  body.grid = vane_grid(scene, grid);
  lay_out_steady_flow(body);
  return body;
}

PlaneSections plane_sections(const Scene& scene) {
  return {section_of(scene, EndsGrid(scene, false)), section_of(scene, EndsGrid(resolving(scene), false))};
}

SteadyTorques turn_steadily(const Scene& scene, const EndsGrid& grid, double speed, SteadyBody& body) {
  return turn(scene, grid.n_bottom > 0, speed, body);
}

PlaneTorques turn_steadily(const Scene& scene, double speed, PlaneSections& sections) {
  const SteadyTorques on_cells = turn(scene, false, speed, sections.on_cells),
                      resolved = turn(scene, false, speed, sections.resolved);
  return {scene.vane.height * on_cells.blades, scene.vane.height * resolved.blades,
          on_cells.solve.converged && resolved.solve.converged};
}

}  // namespace tremie::icar_vane
