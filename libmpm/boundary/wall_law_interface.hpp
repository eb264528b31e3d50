#pragma once

// What a wall law states: how the concrete may move along a wall that it touches. A law is a struct of its parameters in a
// file of this folder and a line in wall_law.hpp (WallLaw). Each law states
//
//   face               what it makes of a face of the grid: FaceKind::no_slip or free_slip prescribe velocities;
//                      FaceKind::wall_law leaves those along the wall to a term at each node (wall_term.hpp), with
//   yield_force(pressing)   its yield force where the concrete presses on the wall with `pressing`: [N] in an implicit
//                      step; in an explicit one both are velocities, momenta over the node's mass [m/s]
//   follows_pressure   whether that depends on `pressing`; an implicit step then renews it from the reaction
//   stress()           in place of yield_force(): the stress that the wall takes from what slides along it, on the area that
//                      is wetted; implicit steps alone
//
// so a law is yield + viscous u on the wetted area, or a yield force by the normal force alone: cohesion with friction, or a
// viscous part that is not linear in u, has no place here. For checks of a run, not for its steps:
//
//   bears(pressure)    the largest shear stress that the wall takes from slow concrete under a pressure [Pa]
//
//   word               the word of a scene's `contact`
//   use                what `tremie check` says of a floor that has it
//   keys()             the keys beside `contact` that give its parameters, as yield laws have them: "floor.…", which [walls]
//                      read under their own name

#include "libmpm/constitutive/laws/law_interface.hpp"
#include "libmpm/grid/axis.hpp"

namespace tremie {

/// What a wall takes from the concrete that slides along it: yield + viscous u.
struct WallStress {
  double yield = 0.0;    ///< [Pa]
  double viscous = 0.0;  ///< [Pa s/m]
};

}  // namespace tremie
