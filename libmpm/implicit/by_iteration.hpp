#pragma once

// A step whose linear systems are solved by iteration, without a matrix: large bodies in 3D, by ADMM alone. What each
// function is for: by_factors.hpp.

#include <optional>

#include "libmpm/implicit/step_size.hpp"

namespace tremie::detail {

/// True if the linear systems of a step are solved by iteration: a body in 3D that is not tiny.
template <class Geometry>
bool by_iteration(const ImplicitBody<Geometry>& body, const StepSettings& settings) {
  return Geometry::dim == 3 && settings.method != YieldMethod::newton &&
         body.grid.n_nodes() * Geometry::dim >= settings.admm.direct_below;
}

struct ByIteration {
  static void carry_over(const IndexMap<3>& old_cells, const YieldLaw&, ImplicitBody<ThreeD>& body) {
    AdmmState<ThreeD>& admm_state = body.admm_state;
    if (!admm_state.stress.empty()) {
      const PackedAdmmState now = pack(admm_state, body.quadrature);
      admm_state = {};
      admm_state.packed = now;
    }
    admm_state.packed = carried(old_cells, body.grid, admm_state.packed);
  }

  /// No memory is spent on a first guess: another try starts from what the last one found, or from none if that ran
  /// away.
  static std::nullopt_t first_guess(const ImplicitBody<ThreeD>&) { return std::nullopt; }
  static void guess_again(const std::optional<AdmmState<ThreeD>>&, const StepSettings& settings, double dt,
                          ImplicitBody<ThreeD>& body) {
    if (runs_away(body, settings.detached, dt)) body.admm_state.packed = zero_admm_state(body.grid.n_cells());
  }

  static Vec<5> stress(const YieldLaw& law, const AdmmState<ThreeD>& admm_state, int c, int k) {
    return stress_of(law, admm_state.packed, c, k);
  }

  static SolveReport solve(YieldProblem<ThreeD>& problem, const YieldLaw& law, const StepSettings& settings,
                           ImplicitBody<ThreeD>& body) {
    MatrixFreeAdmm form{problem, law, settings.admm, body.matrix_free, body.admm_state.packed};
    return solve_admm(problem, settings.admm, form, body.v);
  }

  static double shear_rates(const YieldProblem<ThreeD>& problem, const ImplicitBody<ThreeD>& body,
                            std::vector<double>& of_cell) {
    double mean = 0.0;
    body.matrix_free.shear_rates(problem, body.v, of_cell, mean);
    return mean;
  }

  static std::vector<Vec<3>> shifting(const YieldProblem<ThreeD>& problem, const CellFill& cells,
                                      ImplicitBody<ThreeD>& body) {
    return shifting_displacement_3d(problem, cells, body.matrix_free);
  }

  static void release(ImplicitBody<ThreeD>& body) {
    if (!body.matrix_free.release()) return;
    body.quadrature = {};
    release_free_heap();
  }
};

}  // namespace tremie::detail
