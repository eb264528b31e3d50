#pragma once

// What a run counts while it goes on, and whether its result is to be trusted at its end.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "apparatus/common/model.hpp"
#include "apparatus/run/body_readings.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::experiment {

/// Adds one step to the counts of a run.
template <class Geometry>
void count_step(const Body<Geometry>& body, const StepReport& step, Checks& checks, Cost& cost) {
  checks.unconverged_steps += step.converged ? 0 : 1;
  cost.steps += 1;
  cost.cells_active = std::max<std::int64_t>(cost.cells_active, body.grid.n_cells());
}

/// A step that the scene fixes is not bound to the cells: how many the fastest point crossed in it.
template <class Geometry>
void watch_fixed_step(const Body<Geometry>& body, const Model& model, const StepReport& step, Checks& checks);

/// Fills checks and cost at the end of a run, with the reasons why a result is not to be trusted.
template <class Geometry>
void judge(const Body<Geometry>& body, double start_mass, Checks& checks, Cost& cost);

/// Concrete that has slowed down bears less pressure than where it stood: a change of volume beyond three
/// times that at the start [1], and half a per cent, is the method's. What falls and hits may be compressed
/// more.
void judge_volume(double at_start, Checks& checks);

/// Largest relative change of a body's volume in a run [1]; a body that its own weight compresses further is not concrete.
struct Squeeze {
  double most = 0.0;
  double at = 0.0;  ///< [s]

  void see(double change, double time) {
    if (std::abs(change) > std::abs(most)) most = change, at = time;
  }
  /// Nothing of it can be told any more.
  bool collapsed() const { return most < -0.7 || most > 1.0; }
};

/// `height` of the body [m]. A slump flow's spread is 3 % too large at 12 %, the paper's explicit preset, 5 % at 20 %, 21 %
/// at 60 %.
void judge_squeeze(const Squeeze& squeeze, const Mix& mix, double height, Checks& checks);

/// Why a flow whose fastest speed [m/s] was this is not to be trusted on cells of height h [m]: where inertia outweighs the
/// viscous stress on a cell, rho speed h/mu above 10, the damping of grid and steps decides how far it goes. (Slump flows of
/// 25 and 100 Pa, 0.07 to 10 Pa.s, against half the cells: spreads within 1.1 % below 9, 1.7 % at 15, 4 % at 54, 6 % at 240.)
/// Empty where there is nothing to say.
std::string inertia_on_a_cell(const Mix& mix, const YieldLaw& law, double speed, double h);

/// A reason where cells have one point across, which leaves gaps as soon as the concrete is stretched; else empty.
std::string one_point_a_cell(const Model& model);

}  // namespace tremie::experiment
