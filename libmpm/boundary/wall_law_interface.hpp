#pragma once

// What a wall law states: how the concrete may move along a wall that it touches. A law is a struct of its parameters in a
// file of this folder and a line in wall_law.hpp (WallLaw). Each law states
//
//   face               what it makes of a face of the grid: FaceKind::no_slip or free_slip prescribe velocities;
//                      FaceKind::wall_law leaves those along the wall to a term at each node (wall_term.hpp), with
//   yield_force(pressing)   its yield force where the concrete presses on the wall with `pressing`: [N] in an implicit
//                      step; in an explicit one both are velocities, momenta over the node's mass [m/s]
//   follows_pressure   whether that depends on `pressing`; an implicit step then renews it from the reaction. The limit
//                      and the viscous drag of a law that does not are set where terms are made (flat_walls.hpp)
//   bears(pressure)    the largest shear stress that the wall takes under a pressure [Pa]
//
//   word               the word of a scene's `contact`
//   use                what `tremie check` says of a floor that has it
//   keys()             the keys beside `contact` that give its parameters, as yield laws have them

#include "libmpm/constitutive/laws/law_interface.hpp"
#include "libmpm/grid/axis.hpp"
