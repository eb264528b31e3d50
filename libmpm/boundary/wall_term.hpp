#pragma once

// The term of a wall where it acts, as plain data. Every wall that the concrete may slide along brings terms of this kind
// into the step's convex problem; the solvers know terms, and no wall.
//
// A term takes from the concrete the power
//
//   g |w| + k/2 |w|^2,     w = S (sum_i N_i v_i - v_wall),
//
// N_i v_i the velocity where it acts, v_wall the wall's own, S the components that count: not the normal one along a
// wall, less along a bar than across it. g is a yield force, k a viscous drag. Only g |w| has a kink. ADMM splits it off
// as it does the yield stress of the concrete: each term has a slip velocity of its own, tied to w by a dual force and a
// penalty s, and update_admm() is its step in closed form, for all of them.
//
//                                               acts at   g                     k
//   wall law of a flat wall or sheet            node      the law's             the law's
//   side walls of a section (pose.hpp)          node      their yield stress    of the parabola between them
//   slender bar (slender_bars.hpp)              point     limit load            of the flow that the grid misses
//   wall inside the grid (boundary_points.hpp)  point     none                  none: a penalty alone
//
// A term at a node is a NodeTerm (node_terms.hpp has what the linear systems see of it), one at a point a PointTerm
// (point_terms.hpp), whose stencil is that of its cell. Walls that hold need no term: they prescribe nodal velocities
// (flat_walls.hpp). Moving rigid walls push one way, with a penalty along their normal and nothing along it; there is one
// such contact for every material point near the wall, so ContactPoint (contact.hpp) keeps only what that takes.

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

#include "libmpm/grid/active_grid.hpp"

namespace tremie {

/// What a wall does where it acts, wherever that is.
template <int D>
struct WallTerm {
  Vec<D> velocity = Vec<D>::Zero();  ///< of the wall [m/s]
  double limit = 0.0;                ///< yield force g [N]
  double viscous = 0.0;              ///< viscous drag k [kg/s]
  double stiffness = 0.0;            ///< ADMM's penalty s [kg/s]; 0 where nothing yields
  Vec<D> force = Vec<D>::Zero();     ///< of the yield part on the wall, its dual [N]
  Vec<D> slip = Vec<D>::Zero();      ///< split slip velocity [m/s]
};

/// At a node, weight 1: on a flat wall, or between side walls.
template <int D>
struct NodeTerm : WallTerm<D> {
  int node = 0;
  int normal_axis = 0;  ///< of the wall; -1: side walls, which hold against any motion in the section
  double reach = 0.0;   ///< distance over which it shears the concrete, for ADMM's penalty [m]
  double scale =
      std::numeric_limits<double>::infinity();  ///< of forces that matter, if less than the limit [N]
};

/// At a point of a cell.
template <int D>
struct PointTerm : WallTerm<D> {
  int cell = 0, source = 0;                 ///< active cell; index of the point in its list
  std::array<double, power(3, D)> N;        ///< shape values in that cell
  Mat<D, D> scale = Mat<D, D>::Identity();  ///< S
  Mat<D, D> penalty = Mat<D, D>::Zero();    ///< of the linear systems, towards `target` [kg/s]
  Vec<D> target = Vec<D>::Zero();           ///< the wall's velocity, or what ADMM makes of it [m/s]
  double reach = 0.0;                       ///< viscous drag over viscosity, for ADMM's penalty [m]
};

/// w of a term at a node.
template <int D>
Vec<D> slip_velocity(const NodeTerm<D>& term, const std::vector<Vec<D>>& v) {
  Vec<D> w = v[term.node] - term.velocity;
  if (term.normal_axis >= 0) w[term.normal_axis] = 0.0;
  return w;
}
template <int D>
Vec<D> slip_velocity(const NodeTerm<D>& term, const CellNodes<D>&, const std::vector<Vec<D>>& v) {
  return slip_velocity(term, v);
}

/// w of a term at a point.
template <int D>
Vec<D> slip_velocity(const PointTerm<D>& term, const CellNodes<D>& cell_nodes, const std::vector<Vec<D>>& v) {
  Vec<D> u = -term.velocity;
  for (int i = 0; i < power(3, D); ++i) u += term.N[i] * v[cell_nodes[term.cell][i]];
  return term.scale * u;
}

/// Force that the residuals of a term are measured against [N]. The drag of side walls is left out of it.
template <int D>
double force_scale(const NodeTerm<D>& term, const Vec<D>&) {
  return std::min(term.limit, term.scale);
}
template <int D>
double force_scale(const PointTerm<D>& term, const Vec<D>& w) {
  return term.limit + term.viscous * w.norm();
}

/// One ADMM update of the terms' forces and slip velocities; true when all slip velocities agree with the grid's within
/// the tolerance.
template <int D, class Term>
bool update_admm(const CellNodes<D>& cell_nodes, const std::vector<Vec<D>>& v, double over_relaxation,
                 double tolerance, std::vector<Term>& terms) {
  double residuals = 0.0, scale = 0.0;
  for (Term& t : terms) {
    if (t.stiffness == 0.0) continue;  // nothing yields
    const Vec<D> w = slip_velocity(t, cell_nodes, v);
    const Vec<D> a = t.force + t.stiffness * (over_relaxation * w + (1.0 - over_relaxation) * t.slip);
    const double size = a.norm(), own_scale = force_scale(t, w);
    const Vec<D> force = size > t.limit ? Vec<D>(t.limit / size * a) : a;
    const Vec<D> slip = (a - force) / t.stiffness;
    residuals +=
        t.stiffness * t.stiffness * std::max((w - slip).squaredNorm(), (slip - t.slip).squaredNorm());
    scale += own_scale * own_scale;
    t.force = force;
    t.slip = slip;
  }
  return residuals <= tolerance * tolerance * scale;
}

/// Brings a term's force inside its yield force.
template <int D>
void project_force(WallTerm<D>& term) {
  const double size = term.force.norm();
  if (size > term.limit) term.force *= term.limit / size;
}

}  // namespace tremie
