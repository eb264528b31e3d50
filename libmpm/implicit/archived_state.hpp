#pragma once

// What goes on from one implicit step to the next: a body that is read back steps to the same bits.

#include "libmpm/body/archive.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie {

/// Points, time, step length, stresses, rates and wall terms, by the cells and nodes that were active in the last step. Mix,
/// gravity, the grid's axes and its blocks are not in it: set them as for the first step before reading back. Matrices and
/// factors follow from the grid.
template <class Geometry>
void visit(Archive& archive, ImplicitBody<Geometry>& body);

template <int D>
void visit(Archive& archive, Points<D>& points);

}  // namespace tremie
