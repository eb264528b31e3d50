#pragma once

// What gravity pulls at each node in 3D.
//
// A cell inside the body weighs what a full one does, however many points lie in it just now: its stresses are
// integrated over a full cell too. With its points' own weight a cell that holds a tenth too much sinks and
// its neighbour rises; that is worth 160 Pa over a cell of 15 mm, and stirs a concrete of 20 Pa for good, which
// then never comes to rest and levels too far. In sections the spread moves by at most 0.3 % either way, and they
// keep the points' weight.

#include <vector>

#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

/// Masses of the nodes by weight [kg]: full cells by their volume and their points' density, others by their points.
std::vector<double> node_weights(const ActiveGrid<3>& grid, const Points<3>& points,
                                 const Quadrature<ThreeD>& quadrature);

}  // namespace tremie
