#include "rheometer/cell/elastic_ode.hpp"

#include <cvode/cvode.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>

#include "rheometer/reference/kinetics_equations.hpp"
#include "rheometer/reference/sundials_support.hpp"

namespace tremie {

namespace {

constexpr double relative_tolerance = 1e-11, absolute_tolerance = 1e-11;

/// What the callbacks see. Unknowns: the stress, then the parts of lambda over their shares.
struct Problem {
  const ElasticMaterial& material;
  const ShearPiece* piece = nullptr;
  std::vector<BreakdownMode> modes = {};
  std::vector<Kinetics> of_parts = {};
  double build_rate = 0.0, gamma_c = 0.0;
  bool gated = false, flowing = false;

  double lambda(std::span<const double> y) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < modes.size(); ++i) sum += modes[i].share * y[i + 1];
    return sum;
  }
  double excess(std::span<const double> y) const { return y[0] - (1.0 + lambda(y)) * material.fluid.tau_0; }
  double plastic_rate(std::span<const double> y) const {
    const double e = excess(y) / material.fluid.k;
    return e > 0.0 ? std::pow(e, 1.0 / material.fluid.n) : 0.0;
  }
};

int right_hand_side(sunrealtype t, N_Vector y_vector, N_Vector rates_vector, void* user) {
  const Problem& p = *static_cast<const Problem*>(user);
  const std::span<double> y = values(y_vector), rates = values(rates_vector);
  const double plastic = p.plastic_rate(y);
  rates[0] = p.material.G * (p.piece->rate(std::clamp(t, 0.0, p.piece->duration)) - plastic);
  for (std::size_t i = 0; i < p.of_parts.size(); ++i)
    rates[i + 1] =
        kinetics_equations::rate_of_lambda(p.of_parts[i], p.build_rate, y[i + 1], plastic, p.flowing);
  return 0;
}

int distances(sunrealtype, N_Vector y_vector, sunrealtype* g, void* user) {
  const Problem& p = *static_cast<const Problem*>(user);
  const std::span<double> y = values(y_vector);
  g[0] = p.excess(y);
  if (p.gated) g[1] = p.plastic_rate(y) - p.gamma_c;
  return 0;
}

struct FreeCvode {
  void operator()(void* memory) const { CVodeFree(&memory); }
};

class Integrator {
 public:
  explicit Integrator(Problem& problem, std::span<const double> start)
      : y_(start.size(), context_),
        J_(SUNDenseMatrix(static_cast<sunindextype>(start.size()), static_cast<sunindextype>(start.size()),
                          context_.get)),
        solver_(SUNLinSol_Dense(y_.get, J_.get, context_.get)),
        memory_(CVodeCreate(CV_BDF, context_.get)),
        problem_(problem) {
    std::copy(start.begin(), start.end(), values(y_.get).begin());
    void* m = memory_.get();
    if (!m) throw std::bad_alloc();
    sundials_ok(CVodeInit(m, right_hand_side, 0.0, y_.get), "CVodeInit");
    sundials_ok(CVodeSStolerances(m, relative_tolerance, absolute_tolerance), "CVodeSStolerances");
    sundials_ok(CVodeSetUserData(m, &problem_), "CVodeSetUserData");
    sundials_ok(CVodeSetLinearSolver(m, solver_.get, J_.get), "CVodeSetLinearSolver");
    sundials_ok(CVodeSetMaxNumSteps(m, 5'000'000), "CVodeSetMaxNumSteps");
    sundials_ok(CVodeSetErrHandlerFn(
                    m, [](int, const char*, const char*, char*, void*) {}, nullptr),
                "CVodeSetErrHandlerFn");
    sundials_ok(CVodeRootInit(m, problem_.gated ? 2 : 1, distances), "CVodeRootInit");
    sundials_ok(CVodeSetNoInactiveRootWarn(m), "CVodeSetNoInactiveRootWarn");
  }

  std::span<const double> advance(double t) {
    while (now_ < t) {
      sundials_ok(CVodeSetStopTime(memory_.get(), t), "CVodeSetStopTime");
      double reached = now_;
      const int flag = CVode(memory_.get(), t, y_.get, &reached, CV_NORMAL);
      sundials_ok(flag, "CVode");
      now_ = reached;
      if (flag != CV_ROOT_RETURN) break;
      int direction[2] = {0, 0};
      sundials_ok(CVodeGetRootInfo(memory_.get(), direction), "CVodeGetRootInfo");
      if (direction[1] != 0) problem_.flowing = direction[1] > 0;
      sundials_ok(CVodeReInit(memory_.get(), now_, y_.get), "CVodeReInit");
    }
    now_ = t;
    return values(y_.get);
  }

 private:
  SundialsContext context_;
  SundialsVector y_;
  SundialsMatrix J_;
  SundialsLinearSolver solver_;
  std::unique_ptr<void, FreeCvode> memory_;
  Problem& problem_;
  double now_ = 0.0;
};

void check(const ElasticMaterial& m, double lambda_0) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  if (!positive(m.fluid.tau_0) || !positive(m.fluid.k) || !positive(m.fluid.n) || !positive(m.G))
    throw std::invalid_argument(
        "yield stress, consistency, flow index and shear modulus must be greater than 0");
  if (m.thixotropy) kinetics_equations::check(*m.thixotropy, lambda_0);
}

}  // namespace

ElasticOdeResult elastic_ode(std::span<const ShearPiece> history, const ElasticMaterial& material,
                             double lambda_0, std::span<const double> times) {
  check(material, lambda_0);
  if (!std::is_sorted(times.begin(), times.end()) ||
      (!times.empty() && (times.front() < 0.0 || times.back() > duration(history) * (1.0 + 1e-12))))
    throw std::invalid_argument("the times must ascend and lie within the history");
  Problem problem{material};
  std::vector<double> y{0.0};
  if (const auto& t = material.thixotropy) {
    problem.modes = kinetics_equations::modes_of(t->kinetics);
    problem.build_rate = t->A_thix / material.fluid.tau_0;
    problem.gated = gate(t->kinetics).has_value();
    problem.gamma_c = gate(t->kinetics).value_or(0.0);
    for (const BreakdownMode& mode : problem.modes) {
      problem.of_parts.push_back(kinetics_equations::of_part(t->kinetics, mode));
      y.push_back(lambda_0);
    }
  }
  ElasticOdeResult result;
  double start = 0.0;
  std::size_t next = 0;
  for (const ShearPiece& piece : history) {
    problem.piece = &piece;
    Integrator integrator(problem, y);
    const bool last = &piece == &history.back();
    while (next < times.size() && (last || times[next] < start + piece.duration)) {
      const auto at = integrator.advance(std::clamp(times[next++] - start, 0.0, piece.duration));
      result.stress.push_back(at[0]);
      result.lambda.push_back(problem.lambda(at));
    }
    const std::span<const double> end = integrator.advance(piece.duration);
    y.assign(end.begin(), end.end());
    start += piece.duration;
  }
  return result;
}

}  // namespace tremie
