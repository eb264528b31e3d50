#include "apparatus/run/frames.hpp"

#include "libmpm/boundary/flat_walls.hpp"
#include "libmpm/constitutive/equation_of_state.hpp"

namespace tremie::experiment {

template <class Geometry>
std::vector<double> shear_rates_now(const Body<Geometry>& body) {
  constexpr int D = Geometry::dim;
  ActiveGrid<D> grid;
  grid.axes = body.grid.axes;
  grid.blocks = body.grid.blocks;
  activate(grid, body.points.x);
  NodalState<D> nodes;
  point_to_grid(grid, body.points, nodes);
  std::vector<char> fixed;
  std::vector<NodeTerm<D>> terms;
  detail::apply_flat_walls<D>(grid, body.walls, fixed, terms, nodes.v);
  detail::apply_blocks<D>(grid, fixed, nodes.v);
  std::vector<double> gamma_dot;
  shear_rate_at_points<Geometry>(grid, nodes.v, body.points, gamma_dot);
  return gamma_dot;
}

template <class Geometry>
Frame frame_of(const Body<Geometry>& body) {
  const auto& points = body.points;
  Frame frame;
  frame.time = body.time;
  frame.shear_rate = shear_rates_now(body);  // first: its grid is gone before the rest is there
  frame.position.reserve(points.size()), frame.velocity.reserve(points.size());
  frame.volume.reserve(points.size()), frame.pressure.reserve(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    frame.position.push_back(in_space<Geometry>(points.x[p]));
    frame.velocity.push_back(in_space<Geometry>(points.v[p]));
    if constexpr (Geometry::dim == 1) frame.velocity.back() = {0.0, points.v[p][0], 0.0};
    if constexpr (std::is_same_v<Geometry, Polar>) {
      const double c = std::cos(points.x[p][1]), s = std::sin(points.x[p][1]);
      const Vec<2>& v = points.v[p];
      frame.velocity.back() = {c * v[0] - s * v[1], s * v[0] + c * v[1], 0.0};
    }
    frame.volume.push_back(points.volume(p));
    frame.pressure.push_back(pressure(points.ln_J[p], body.mix.K));
  }
  frame.flocculation = points.lambda;
  return frame;
}

#define TREMIE_FRAMES_IN(Geometry)                                     \
  template std::vector<double> shear_rates_now(const Body<Geometry>&); \
  template Frame frame_of(const Body<Geometry>&);
TREMIE_FRAMES_IN(Axisymmetric)
TREMIE_FRAMES_IN(PlaneStrain)
#ifndef TREMIE_SECTIONS_ONLY  // the page for the browser has no vane and nothing in space
TREMIE_FRAMES_IN(Couette)
TREMIE_FRAMES_IN(Polar)
TREMIE_FRAMES_IN(ThreeD)
#endif

}  // namespace tremie::experiment
