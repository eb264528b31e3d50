#include "rheometer/reference/flocculation_ode.hpp"

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <memory>

#include "rheometer/reference/kinetics_equations.hpp"
#include "rheometer/reference/sundials_support.hpp"

namespace tremie {

namespace {

/// What the callbacks see: one piece of the history and the side of the gate that the integration is on.
struct Problem {
  const ShearPiece* piece = nullptr;
  Kinetics kinetics;
  double build_rate = 0.0;
  bool flowing = true;  ///< gated alone
  std::vector<BreakdownMode> modes = kinetics_equations::modes_of(kinetics);
  std::vector<Kinetics> of_parts = {};  ///< which y, lambda_i over its share, follow

  double gamma_dot(double t) const { return piece->rate(std::clamp(t, 0.0, piece->duration)); }
  bool gated() const { return gate(kinetics).has_value(); }
  double gamma_c() const { return gate(kinetics).value_or(0.0); }
};

int right_hand_side(sunrealtype t, N_Vector y, N_Vector ydot, void* user) {
  const Problem& p = *static_cast<const Problem*>(user);
  for (std::size_t i = 0; i < p.of_parts.size(); ++i)
    values(ydot)[i] = kinetics_equations::rate_of_lambda(p.of_parts[i], p.build_rate, values(y)[i],
                                                         p.gamma_dot(t), p.flowing);
  return 0;
}

int jacobian(sunrealtype t, N_Vector y, N_Vector, SUNMatrix J, void* user, N_Vector, N_Vector, N_Vector) {
  const Problem& p = *static_cast<const Problem*>(user);
  SUNMatZero(J);
  for (std::size_t i = 0; i < p.of_parts.size(); ++i) {
    const auto d = kinetics_equations::derivatives_of(p.of_parts[i], p.build_rate, values(y)[i],
                                                      p.gamma_dot(t), p.flowing);
    SUNDenseMatrix_Column(J, static_cast<sunindextype>(i))[i] = d.build_by_lambda - d.k * d.broken_by_lambda;
  }
  return 0;
}

int distance_to_gate(sunrealtype t, N_Vector, sunrealtype* g, void* user) {
  const Problem& p = *static_cast<const Problem*>(user);
  g[0] = p.gamma_dot(t) - p.gamma_c();
  return 0;
}

/// A history that starts on gamma_c itself belongs to the side that it moves to.
bool flows_at_start(const Problem& p) {
  const double start = p.gamma_dot(0.0);
  const double gamma_c = p.gamma_c();
  return start == gamma_c ? p.gamma_dot(1e-6 * p.piece->duration) >= gamma_c : start > gamma_c;
}

/// lambda relaxes on the time 1/(alpha gamma_dot), times lambda^(1-n)/n with a power, and to its saturation as it builds up; a
/// piece that is much longer than either, on either side of the gate, is stiff.
int method_for(const Problem& p, std::span<const double> y, OdeMethod wanted) {
  if (wanted != OdeMethod::automatic) return wanted == OdeMethod::bdf ? CV_BDF : CV_ADAMS;
  double fastest = 0.0;
  for (int i = 0; i <= 64; ++i) fastest = std::max(fastest, p.gamma_dot(p.piece->duration * i / 64.0));
  for (std::size_t i = 0; i < p.of_parts.size(); ++i) {
    for (const bool flowing : {false, true}) {
      const auto d = kinetics_equations::derivatives_of(p.of_parts[i], p.build_rate, y[i], fastest, flowing);
      if ((d.k * d.broken_by_lambda - d.build_by_lambda) * p.piece->duration > 100.0) return CV_BDF;
    }
  }
  return CV_ADAMS;
}

class Integrator {
 public:
  Integrator(Problem& problem, std::span<const double> start, const OdeOptions& options)
      : y_(start.size(), context_),
        J_(SUNDenseMatrix(static_cast<sunindextype>(start.size()), static_cast<sunindextype>(start.size()),
                          context_.get)),
        solver_(SUNLinSol_Dense(y_.get, J_.get, context_.get)),
        problem_(problem) {
    std::copy(start.begin(), start.end(), values(y_.get).begin());
    method_ = method_for(problem, start, options.method);
    memory_.reset(CVodeCreate(method_, context_.get));
    void* m = memory_.get();
    if (!m) throw std::bad_alloc();
    sundials_ok(CVodeInit(m, right_hand_side, 0.0, y_.get), "CVodeInit");
    sundials_ok(CVodeSStolerances(m, options.relative_tolerance, options.absolute_tolerance),
                "CVodeSStolerances");
    sundials_ok(CVodeSetUserData(m, &problem_), "CVodeSetUserData");
    sundials_ok(CVodeSetLinearSolver(m, solver_.get, J_.get), "CVodeSetLinearSolver");
    sundials_ok(CVodeSetJacFn(m, jacobian), "CVodeSetJacFn");
    sundials_ok(CVodeSetMaxNumSteps(m, 5'000'000), "CVodeSetMaxNumSteps");
    sundials_ok(CVodeSetNonlinConvCoef(m, 1e-3), "CVodeSetNonlinConvCoef");
    sundials_ok(CVodeSetErrHandlerFn(m, quiet, nullptr), "CVodeSetErrHandlerFn");
    if (problem.gated()) {
      sundials_ok(CVodeRootInit(m, 1, distance_to_gate), "CVodeRootInit");
      sundials_ok(CVodeSetNoInactiveRootWarn(m), "CVodeSetNoInactiveRootWarn");
    }
  }

  /// Advances to the time t of the piece, a gate crossing at a time; the parts of lambda over their shares.
  std::span<const double> advance(double t, OdeResult& result) {
    double reached = 0.0;
    while (now_ < t) {
      sundials_ok(CVodeSetStopTime(memory_.get(), t), "CVodeSetStopTime");
      const int flag = CVode(memory_.get(), t, y_.get, &reached, CV_NORMAL);
      sundials_ok(flag, "CVode");
      now_ = reached;
      if (flag != CV_ROOT_RETURN) break;
      pass_gate(result);
    }
    now_ = t;
    return values(y_.get);
  }

  void add_statistics(OdeResult& result) {
    long steps = 0, evaluations = 0;
    CVodeGetNumSteps(memory_.get(), &steps);
    CVodeGetNumRhsEvals(memory_.get(), &evaluations);
    result.steps += steps + steps_before_;
    result.evaluations += evaluations + evaluations_before_;
    result.used_bdf = result.used_bdf || method_ == CV_BDF;
  }

 private:
  struct Free {
    void operator()(void* memory) const { CVodeFree(&memory); }
  };
  // CVODE's own message would go to stderr; its code goes into the exception.
  static void quiet(int, const char*, const char*, char*, void*) {}

  void pass_gate(OdeResult& result) {
    int direction = 0;
    sundials_ok(CVodeGetRootInfo(memory_.get(), &direction), "CVodeGetRootInfo");
    const bool flowing = direction > 0;
    result.gate_crossings += flowing != problem_.flowing;
    problem_.flowing = flowing;
    long steps = 0, evaluations = 0;  // a new start sets the counters to 0
    CVodeGetNumSteps(memory_.get(), &steps);
    CVodeGetNumRhsEvals(memory_.get(), &evaluations);
    steps_before_ += steps;
    evaluations_before_ += evaluations;
    sundials_ok(CVodeReInit(memory_.get(), now_, y_.get), "CVodeReInit");
  }

  SundialsContext context_;
  SundialsVector y_;
  SundialsMatrix J_;
  SundialsLinearSolver solver_;
  std::unique_ptr<void, Free> memory_;
  Problem& problem_;
  int method_ = CV_ADAMS;
  double now_ = 0.0;
  long steps_before_ = 0, evaluations_before_ = 0;
};

}  // namespace

OdeResult flocculation_ode(std::span<const ShearPiece> history, const Thixotropy& thixotropy, double tau_0,
                           double lambda_0, std::span<const double> times, const OdeOptions& options) {
  if (!(std::isfinite(tau_0) && tau_0 > 0.0))
    throw std::invalid_argument(
        "flocculation needs a yield stress greater than 0: lambda grows by A_thix/tau_0");
  kinetics_equations::check(thixotropy, lambda_0);
  const double end = duration(history);
  if (!std::is_sorted(times.begin(), times.end()) ||
      (!times.empty() && (times.front() < 0.0 || times.back() > end * (1.0 + 1e-12))))
    throw std::invalid_argument("the times must ascend and lie within the history");

  OdeResult result;
  result.lambda.reserve(times.size());
  Problem problem{nullptr, thixotropy.kinetics, thixotropy.A_thix / tau_0};
  for (const BreakdownMode& mode : problem.modes)
    problem.of_parts.push_back(kinetics_equations::of_part(thixotropy.kinetics, mode));
  const auto lambda_of = [&](std::span<const double> y) {
    double sum = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i) sum += problem.modes[i].share * y[i];
    return sum;
  };
  std::vector<double> lambda(problem.modes.size(), lambda_0);
  double start = 0.0;
  std::size_t next = 0;
  for (const ShearPiece& piece : history) {
    problem.piece = &piece;
    problem.flowing = flows_at_start(problem);
    Integrator integrator(problem, lambda, options);
    const bool last = &piece == &history.back();
    while (next < times.size() && (last || times[next] < start + piece.duration)) {
      const double local = std::clamp(times[next++] - start, 0.0, piece.duration);
      result.lambda.push_back(lambda_of(integrator.advance(local, result)));
    }
    const std::span<const double> end_of_piece = integrator.advance(piece.duration, result);
    lambda.assign(end_of_piece.begin(), end_of_piece.end());
    integrator.add_statistics(result);
    start += piece.duration;
  }
  return result;
}

}  // namespace tremie
