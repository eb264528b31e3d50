#include <arkode/arkode_arkstep.h>
#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include "apparatus/verification/references/flocculation_methods.hpp"
#include "rheometer/reference/sundials_support.hpp"

namespace tremie::study {

namespace {

struct User {
  const Thixotropy* thixotropy;
  const ShearPiece* piece;
  bool flowing;
};

double gamma_c_of(const Thixotropy& t) { return gate(t.kinetics).value_or(0.0); }

int right_hand_side(sunrealtype t, N_Vector y, N_Vector ydot, void* data) {
  const User& user = *static_cast<const User*>(data);
  values(ydot)[0] =
      kinetics_equations::rate_of_lambda(user.thixotropy->kinetics, user.thixotropy->A_thix / tau_0,
                                         values(y)[0], user.piece->rate(t), user.flowing);
  return 0;
}

int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* data, N_Vector, N_Vector, N_Vector) {
  const User& user = *static_cast<const User*>(data);
  const auto d =
      kinetics_equations::derivatives_of(user.thixotropy->kinetics, user.thixotropy->A_thix / tau_0,
                                         values(y)[0], user.piece->rate(t), user.flowing);
  SUNDenseMatrix_Data(J)[0] = d.build_by_lambda - d.k * d.broken_by_lambda;
  return 0;
}

int distance_to_gate(sunrealtype t, N_Vector, sunrealtype* g, void* data) {
  const User& user = *static_cast<const User*>(data);
  g[0] = user.piece->rate(t) - gamma_c_of(*user.thixotropy);
  return 0;
}

/// Advances to `stop`, starting anew behind every gate crossing.
void advance(void* memory, User& user, double stop, N_Vector y) {
  sundials_ok(ARKStepSetStopTime(memory, stop), "ARKStepSetStopTime");
  for (double reached = 0.0; reached < stop;) {
    const int flag = ARKStepEvolve(memory, stop, y, &reached, ARK_NORMAL);
    sundials_ok(flag, "ARKStepEvolve");
    if (flag != ARK_ROOT_RETURN) return;
    int direction = 0;
    ARKStepGetRootInfo(memory, &direction);
    user.flowing = direction > 0;
    sundials_ok(ARKStepReset(memory, reached, y), "ARKStepReset");
    sundials_ok(ARKStepSetStopTime(memory, stop), "ARKStepSetStopTime");
  }
}

}  // namespace

std::vector<double> by_arkode(const Case& c, double tolerance, bool stiff) {
  SundialsContext context;
  SundialsVector y(1, context);
  values(y.get)[0] = c.lambda_0;
  std::vector<double> result;
  double piece_start = 0.0;
  std::size_t next = 0;
  for (const ShearPiece& piece : c.history) {
    User user{&c.thixotropy, &piece, piece.rate(1e-6 * piece.duration) >= gamma_c_of(c.thixotropy)};
    void* memory = ARKStepCreate(stiff ? nullptr : right_hand_side, stiff ? right_hand_side : nullptr, 0.0,
                                 y.get, context.get);
    SundialsMatrix J(SUNDenseMatrix(1, 1, context.get));
    SundialsLinearSolver solver(SUNLinSol_Dense(y.get, J.get, context.get));
    sundials_ok(ARKStepSStolerances(memory, tolerance, 0.01 * tolerance), "ARKStepSStolerances");
    sundials_ok(ARKStepSetUserData(memory, &user), "ARKStepSetUserData");
    sundials_ok(ARKStepSetMaxNumSteps(memory, 10'000'000), "ARKStepSetMaxNumSteps");
    if (stiff) {
      sundials_ok(ARKStepSetLinearSolver(memory, solver.get, J.get), "ARKStepSetLinearSolver");
      sundials_ok(ARKStepSetJacFn(memory, jacobian), "ARKStepSetJacFn");
      sundials_ok(ARKStepSetLinear(memory, 1), "ARKStepSetLinear");
      sundials_ok(ARKStepSetNonlinConvCoef(memory, 1e-3), "ARKStepSetNonlinConvCoef");
    }
    if (gate(c.thixotropy.kinetics)) {
      sundials_ok(ARKStepRootInit(memory, 1, distance_to_gate), "ARKStepRootInit");
      ARKStepSetNoInactiveRootWarn(memory);
    }
    while (next < c.times.size() && c.times[next] <= (piece_start + piece.duration) * (1.0 + 1e-12)) {
      advance(memory, user, std::min(piece.duration, c.times[next++] - piece_start), y.get);
      result.push_back(values(y.get)[0]);
    }
    ARKStepFree(&memory);
    piece_start += piece.duration;
  }
  return result;
}

double by_cvode_step_by_step(const Case& c, double tolerance, double dt, std::span<const double> rates) {
  SundialsContext context;
  SundialsVector y(1, context);
  values(y.get)[0] = c.lambda_0;
  SundialsMatrix J(SUNDenseMatrix(1, 1, context.get));
  SundialsLinearSolver solver(SUNLinSol_Dense(y.get, J.get, context.get));
  ShearPiece step;
  User user{&c.thixotropy, &step, true};
  void* memory = CVodeCreate(c.name == "stiff" ? CV_BDF : CV_ADAMS, context.get);
  sundials_ok(CVodeInit(memory, right_hand_side, 0.0, y.get), "CVodeInit");
  sundials_ok(CVodeSStolerances(memory, tolerance, 0.01 * tolerance), "CVodeSStolerances");
  sundials_ok(CVodeSetUserData(memory, &user), "CVodeSetUserData");
  sundials_ok(CVodeSetLinearSolver(memory, solver.get, J.get), "CVodeSetLinearSolver");
  sundials_ok(CVodeSetJacFn(memory, jacobian), "CVodeSetJacFn");
  for (std::size_t i = 1; i < rates.size(); ++i) {
    step = linear_piece({dt, rates[i - 1], rates[i]});
    user.flowing = step.rate(0.5 * dt) >= gamma_c_of(c.thixotropy);
    double reached = 0.0;
    sundials_ok(CVodeReInit(memory, 0.0, y.get), "CVodeReInit");
    sundials_ok(CVodeSetStopTime(memory, dt), "CVodeSetStopTime");
    sundials_ok(CVode(memory, dt, y.get, &reached, CV_NORMAL), "CVode");
  }
  CVodeFree(&memory);
  return values(y.get)[0];
}

}  // namespace tremie::study
