#pragma once

// particle_shifting.hpp's displacements in 3D. The mass is diagonal there, so that the preconditioner M + B' C B of
// preconditioner.hpp is the matrix itself, but for walls inside the grid and its single precision:
// one or two iterations.

#include "libmpm/implicit/shifting/particle_shifting.hpp"
#include "libmpm/implicit/solvers/linear_system_3d.hpp"

namespace tremie {

/// The displacement of every node [m] that brings the cells nearer to full; uses the step's preconditioner for itself.
std::vector<Vec<3>> shifting_displacement_3d(const YieldProblem<ThreeD>& problem, const CellFill& cells,
                                             MatrixFreeSystem& system);

}  // namespace tremie
