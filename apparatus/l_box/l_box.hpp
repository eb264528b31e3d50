#pragma once

// The L-box test of EN 12350-10: a box with a gate (parts/boxes) whose channel the concrete runs along, without bars or, in
// space, with two or three in front of the gate.

#include <string>

#include "apparatus/parts/boxes/boxes.hpp"

namespace tremie::l_box {

using boxes::Box;
using boxes::estimate;
using boxes::in_space;
using boxes::Outcome;
using boxes::Results;
using boxes::Sample;
using boxes::Scene;

/// Runs the test; as cone::run.
Outcome run(const Scene& scene, const scene::Observer& observer = {});

/// The keys of `apparatus = "l_box"`, and the checked values as a scene; throws InputError where they do not fit each other.
scene::ApparatusKeys keys();
Scene read_scene(const scene::Values& values);

/// The apparatus for the registry.
scene::Apparatus apparatus();

/// What H1 exceeds H2 by in a bed of depth h at rest, `length` between the two, where it flowed as far as its yield
/// stress lets it: floor and side walls hold tau_0 (1 + 2 h/W) of rho g h dh/dx, and the bars their own [m].
double drop_at_rest(const Scene& scene, double h, double length);

/// EN 12350-10 class of a passing ratio: "PL1" (two bars) or "PL2" (three) from 0.80 on; "" below it or
/// without bars.
std::string passing_class(double ratio, int bars);

}  // namespace tremie::l_box
