#pragma once

// How far a result may be from what finer cells and steps would give: the scene twice more, with cells and
// steps that are larger by two factors; where those scatter, once more with smaller ones.

#include <string>
#include <vector>

#include "apparatus/registry/registry.hpp"

namespace tremie::scene {

/// The cells and steps of the two coarser runs, over the scene's.
struct Coarsening {
  double middle = 1.5, coarse = 2.0;
};

/// What three grids say about a number.
struct Extrapolation {
  double error = 0.0;       ///< half-width of the bar about the finest value, in its unit
  bool richardson = false;  ///< the three are in order and their order of convergence is between 0.5 and 4
  double order = 0.0;       ///< richardson alone
};

/// Richardson's estimate with the order seen, at most 1, times 1.25; where no order is seen, 1.25 times the
/// spread of the three. Never less than a thousandth of the value.
Extrapolation extrapolate(double fine, double middle, double coarse, const Coarsening& by = {});

/// Whether the three scatter by more than a tenth of the value: a coarse grid then misses what finer ones see, and its
/// scatter says nothing about the fine one.
bool is_doubtful(const Extrapolation& three, double fine);

/// The bar about `fine` where a grid with cells `by.middle` times smaller takes the place of the coarsest.
Extrapolation extrapolate_with_finer(double finer, double fine, double middle, const Coarsening& by = {});

/// The same scene with cells and steps, fixed or chosen, `ratio` times as large.
Scene coarsened(const Scene& scene, double ratio);

/// The error bars of the outcome's headline numbers, and what they cost. Runs two coarser scenes, and a finer one where the
/// first number is doubtful. Empty, with the reason in `basis`, where those cannot be run.
ErrorEstimate estimate_error(const Scene& scene, const Outcome& outcome, const Observer& observer = {});

/// The size of cells that the accuracy wants, as a factor on the scene's: from runs at 2, 3 and 4 times its
/// cells. `accuracy` is relative, of the first headline number.
struct Choice {
  double factor = 1.0;
  double cpu = 0.0;        ///< what the run is expected to cost [s], its error bar included
  double pilot_cpu = 0.0;  ///< what choosing cost [s]
};
Choice choose_cells(const Scene& scene, double accuracy, const Observer& observer = {});

/// The --set argument that gives the scene cells `ratio` times as large.
std::string cells_override(const Scene& scene, double ratio);

/// "spread 556 ± 4 mm", a line each.
std::vector<std::string> error_lines(const Scene& scene, const Outcome& outcome);

}  // namespace tremie::scene
