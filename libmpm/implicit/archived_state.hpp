#pragma once

// What goes on from one implicit step to the next: a body that is read back steps to the same bits.

#include "libmpm/body/archive.hpp"
#include "libmpm/implicit/state.hpp"

namespace tremie {

/// Stresses, rates and the wall terms stand by the cells and nodes that were active in the last step. A
/// grid's axes and its blocks are the scene's; matrices and factors follow from the grid.
template <class Geometry>
void visit(Archive& archive, ImplicitBody<Geometry>& body);

template <int D>
void visit(Archive& archive, Points<D>& points);

}  // namespace tremie
