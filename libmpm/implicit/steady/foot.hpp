#pragma once

// The foot of a deep body: layers of cells that stand, and that steps leave out.
//
// The lowest layers of a section that are below their yield stress stand on the floor while what is above them flows. What the
// yield solver leaves there of rates only carries points about. The floor rises to their top, and their points stand aside:
// their structure builds up, and their pressure follows the weight above.

#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "libmpm/implicit/archived_state.hpp"
#include "libmpm/implicit/steady/standstill.hpp"

namespace tremie {

/// What stands aside below the floor of a body.
template <int D>
struct Foot {
  Points<D> points;
  int layers = 0;  ///< of cells, below the floor
};

template <int D>
void visit(Archive& archive, Foot<D>& foot) {
  archive(foot.points, foot.layers);
}

/// Lowest layers of cells that the last step, by ADMM, left at rest: by the root mean square of the strain rates in each, over
/// its volume, below what the solver takes for rest. None by a law that flows at all stresses.
template <class Geometry>
int resting_layers(const ImplicitBody<Geometry>& body, const YieldLaw& law) {
  static_assert(Geometry::dim < 3, "in space the rates are packed");
  if (!is_exact(law)) return 0;
  std::vector<double> volume, squares;
  for (std::size_t c = 0; c < body.admm_state.rate.size(); ++c) {
    const auto layer = static_cast<std::size_t>(body.grid.cell_index[c].back());
    if (layer >= volume.size()) volume.resize(layer + 1, 0.0), squares.resize(layer + 1, 0.0);
    for (std::size_t k = 0; k < body.quadrature.V[c].size(); ++k) {
      volume[layer] += body.quadrature.V[c][k];
      squares[layer] += body.quadrature.V[c][k] * body.admm_state.rate[c][k].squaredNorm();
    }
  }
  std::size_t layers = 0;
  while (layers < volume.size() && squares[layers] <= std::pow(detail::rate_at_rest, 2) * volume[layers])
    ++layers;
  return static_cast<int>(layers);
}

namespace detail {

/// Appends the entries of which chosen[p] is `which` to another array; of one without entries nothing.
template <class T>
void append_chosen(const std::vector<char>& chosen, char which, const std::vector<T>& from,
                   std::vector<T>& to) {
  for (std::size_t p = 0; p < from.size(); ++p)
    if (chosen[p] == which) to.push_back(from[p]);
}

}  // namespace detail

/// Moves the chosen entries of an array with one for each point to the end of another.
template <class T>
void move_chosen(const std::vector<char>& chosen, std::vector<T>& from, std::vector<T>& to) {
  std::vector<T> kept;
  kept.reserve(from.size());
  detail::append_chosen(chosen, 0, from, kept);
  detail::append_chosen(chosen, 1, from, to);
  from = std::move(kept);
}

/// Moves the chosen points to the end of others.
template <int D>
void move_chosen(const std::vector<char>& chosen, Points<D>& from, Points<D>& to) {
  move_chosen(chosen, from.x, to.x), move_chosen(chosen, from.v, to.v), move_chosen(chosen, from.C, to.C);
  move_chosen(chosen, from.mass, to.mass), move_chosen(chosen, from.V0, to.V0);
  move_chosen(chosen, from.ln_J, to.ln_J), move_chosen(chosen, from.lambda, to.lambda);
  move_chosen(chosen, from.gamma_dot, to.gamma_dot), move_chosen(chosen, from.mix, to.mix);
  to.lambda_parts.resize(from.lambda_parts.size());
  for (std::size_t i = 0; i < from.lambda_parts.size(); ++i)
    move_chosen(chosen, from.lambda_parts[i], to.lambda_parts[i]);
}

/// Puts the floor of a grid whose cells are counted from the base, or from where the floor was, onto the foot. Bars below it are
/// out of the run.
template <class Geometry>
void stand_on(const Foot<Geometry::dim>& foot, ImplicitBody<Geometry>& body) {
  constexpr int up = Geometry::dim - 1;
  Axis& axis = body.grid.axes[up];
  axis.origin = foot.layers * axis.h;
  std::erase_if(body.bars, [&](const auto& bar) { return bar.x[up] < axis.origin; });
}

/// Counts cells and nodes anew from a floor that has risen by so many layers: what the body keeps by cells stays with them, what it
/// keeps along walls is forgotten.
template <class Geometry>
void count_from(int layers, ImplicitBody<Geometry>& body) {
  constexpr int up = Geometry::dim - 1;
  body.grid.cell_map.low[up] -= layers, body.grid.node_map.low[up] -= layers;
  body.wall_nodes.clear(), body.bar_drag.clear();
}

/// Sets the lowest layers of cells aside. Returns which points these were, for what else is kept by points: move_chosen().
template <class Geometry>
std::vector<char> set_aside(int layers, ImplicitBody<Geometry>& body, Foot<Geometry::dim>& foot) {
  constexpr int up = Geometry::dim - 1;
  foot.layers += layers;
  stand_on(foot, body);
  count_from(layers, body);
  std::vector<char> below(body.points.size());
  for (std::size_t p = 0; p < below.size(); ++p)
    below[p] = body.points.x[p][up] < body.grid.axes[up].origin ? 1 : 0;
  move_chosen(below, body.points, foot.points);
  for (auto& v : foot.points.v) v.setZero();
  for (auto& C : foot.points.C) C.setZero();
  return below;
}

/// Takes the foot back into the body, behind its other points.
template <class Geometry>
void take_back(ImplicitBody<Geometry>& body, Foot<Geometry::dim>& foot) {
  const std::vector<char> all(foot.points.size(), 1);
  move_chosen(all, foot.points, body.points);
  count_from(-foot.layers, body);
  foot.layers = 0;
  stand_on(foot, body);
}

/// Lets dt pass over a foot on which the weight above has grown by `load` [Pa].
template <class Geometry>
void wait(double dt, double load, const ImplicitBody<Geometry>& body, Foot<Geometry::dim>& foot) {
  const auto mix_of = [&](std::size_t p) -> const Mix& {
    return body.mixes.empty() ? body.mix : body.mixes[static_cast<std::size_t>(foot.points.mix[p])];
  };
  build_up_at_rest(dt, mix_of, foot.points);
  for (double& ln_J : foot.points.ln_J) ln_J -= load / body.mix.K;
}

}  // namespace tremie
