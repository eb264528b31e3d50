#pragma once

// What gravity pulls at each node, in 3D and in a section that stands still for long.
//
// A cell inside the body weighs what a full one does, however many points lie in it just now: its stresses are
// integrated over a full cell too. With its points' own weight a cell that holds a tenth too much sinks and
// its neighbour rises; that is worth 160 Pa over a cell of 15 mm, and stirs a concrete of 20 Pa for good, which
// then never comes to rest and levels too far. In sections the spread moves by at most 0.3 % either way, and they
// keep the points' weight while they flow (StepSettings::weight). Over the metres of a pile it would stir the concrete: there
// cells inside the body weigh what full ones do.

#include <vector>

#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

/// Masses of the nodes by weight [kg]: full cells by their volume and their points' density, others by their points.
std::vector<double> node_weights(const ActiveGrid<3>& grid, const Points<3>& points,
                                 const Quadrature<ThreeD>& quadrature);

/// Forces of gravity on the nodes of a section [N], integrated where the stresses are, with what the pressure of a cell leaves out:
/// it falls with height as a column of the concrete does. With `inside` that holds for the cells inside the body alone; others
/// weigh their points, whose nodes may have little mass.
template <class Geometry>
std::vector<Vec<2>> balanced_weights(const ActiveGrid<2>& grid, const Points<2>& points,
                                     const Quadrature<Geometry>& quadrature, const Vec<2>& gravity,
                                     bool inside);

}  // namespace tremie
