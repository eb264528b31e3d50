// Case 2: lambda by the per-point update, by forward Euler, CVODE and ARKODE, against closed forms and CVODE
// at its finest tolerance.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/verification/references/flocculation_methods.hpp"
#include "apparatus/verification/suite.hpp"
#include "rheometer/reference/flocculation_ode.hpp"

namespace tremie::verification {
namespace {

/// Largest difference to the reference over the largest lambda; CPU time of the quicker of some repetitions.
template <class Solve>
Run measure(const std::string& label, double h, const std::vector<double>& reference, double lambda_0,
            Solve solve) {
  Run run{label, h, 0.0, 0.0};
  const std::vector<double> lambda = solve();
  double largest = lambda_0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    run.error = std::max(run.error, std::abs(lambda[i] - reference[i]));
    largest = std::max(largest, reference[i]);
  }
  run.error = std::isfinite(run.error) ? run.error / largest : HUGE_VAL;
  run.cpu = HUGE_VAL;
  for (int i = 0; i < 5; ++i) {
    const double start = cpu_seconds();
    solve();
    run.cpu = std::min(run.cpu, cpu_seconds() - start);
  }
  return run;
}

Problem history_problem(const std::string& name, const std::string& title, const study::Case& c,
                        Depth depth) {
  Problem one{.name = name,
              .title = title,
              .equation = "dλ/dt = A_thix/τ0 − αλγ̇(t), equations (3) and (4)",
              .reference = "CVODE at a tolerance of 1e-13, gate crossings found as roots",
              .norm = "largest |λ − λ_reference| over the largest λ, every second",
              .series = {{"update of the points", {}},
                         {"forward Euler (for comparison)", {}},
                         {"CVODE", {}},
                         {"update along the history", {}},
                         {"ARKODE", {}}}};
  const auto reference = flocculation_ode(c.history, c.thixotropy, study::tau_0, c.lambda_0, c.times).lambda;
  for (double dt : {0.2, 0.1, 0.05, 0.02, 0.01, 1e-3, 1e-4}) {
    if (dt > c.largest_dt || (dt < 1e-3 && depth == Depth::quick)) continue;
    const std::string label = fmt::format("{:g} s", dt);
    one.series[0].runs.push_back(
        measure(label, dt, reference, c.lambda_0, [&] { return study::march(c, dt, study::one_step); }));
    one.series[3].runs.push_back(measure(label, dt, reference, c.lambda_0,
                                         [&] { return study::march(c, dt, study::one_step_along); }));
    one.series[1].runs.push_back(measure(label, dt, reference, c.lambda_0,
                                         [&] { return study::march(c, dt, study::one_step_of_euler); }));
  }
  for (int k = 4; k <= 12; k += 2) {
    const double tolerance = std::pow(10.0, -k);
    one.series[2].runs.push_back(
        measure(fmt::format("tolerance {:g}", tolerance), 0.0, reference, c.lambda_0, [&] {
          return flocculation_ode(c.history, c.thixotropy, study::tau_0, c.lambda_0, c.times,
                                  {tolerance, 0.01 * tolerance})
              .lambda;
        }));
    one.series[4].runs.push_back(measure(fmt::format("tolerance {:g}", tolerance), 0.0, reference, c.lambda_0,
                                         [&] { return study::by_arkode(c, tolerance, false); }));
  }
  return one;
}

std::vector<double> every_second(double until) {
  std::vector<double> times;
  for (double t = 1.0; t <= until * (1.0 + 1e-12); t += 1.0) times.push_back(t);
  return times;
}

/// Worst relative error of one step at a constant rate, over rates and step sizes, against the closed form.
Problem constant_rate() {
  const double start = cpu_seconds();
  constexpr double alpha = 0.0358;
  const Thixotropy t{1.3, RousselKinetics{alpha}};
  double worst = 0.0;
  for (double rate = 1e-3; rate < 1e7; rate *= 10.0)
    for (double dt = 1e-6; dt < 1e3; dt *= 10.0) {
      const long double k = static_cast<long double>(alpha) * rate * dt, build = 1.3L * dt / 54.0L;
      const double exact = static_cast<double>(5.0L * std::exp(-k) - build * std::expm1(-k) / k);
      worst = std::max(worst, std::abs(flocculation_step(5.0, t, 54.0, rate, rate, dt) / exact - 1.0));
    }
  Problem one{.name = "constant_rate",
              .title = "Constant rate",
              .equation = "dλ/dt = A_thix/τ0 − αλγ̇, equation (3)",
              .reference = "λ e^(−k) + (A_thix/τ0) Δt (1 − e^(−k))/k, k = αγ̇Δt, in extended precision",
              .norm = "largest relative error of one step, αγ̇Δt from 4e-11 to 4e7",
              .series = {{"update of the points", {{"1e-6 to 100 s", 0.0, worst, cpu_seconds() - start}}}},
              .bounds = {{.what = "worst error", .value = worst, .limit = 1e-13}}};
  return one;
}

}  // namespace

Case flocculation_case(Depth depth) {
  Case result{2, "The flocculation state", {constant_rate()}};
  const Thixotropy roussel{1.3, RousselKinetics{0.0358}}, gated{1.3, GatedKinetics{0.0358}};
  const ShearPiece cosine = {.duration = 20.0,
                             .rate = [](double t) { return 5.0 * (1.0 - std::cos(0.5 * t)); }};
  const study::Case smooth{
      .name = "cosine", .title = "", .history = {cosine}, .thixotropy = roussel, .times = every_second(20.0)};
  result.problems.push_back(
      history_problem("smooth_rate", "Smooth rate, 5 (1 − cos t/2) 1/s for 20 s", smooth, depth));
  const double order = observed_order(result.problems.back().series[0]);
  result.problems.back().bounds = {{.what = "update: order", .value = order, .limit = 1.9, .at_least = true}};
  const ShearPiece above_rest = {.duration = 20.0,
                                 .rate = [](double t) { return 5.0 * (1.1 - std::cos(0.5 * t)); }};
  const study::Case by_time{.name = "rate_power",
                            .title = "",
                            .history = {above_rest},
                            .thixotropy = {1.3, RatePowerKinetics{0.26, 0.2}},
                            .times = every_second(20.0)};
  result.problems.push_back(history_problem(
      "rate_power", "Breakdown by a power of the rate, 5 (1.1 − cos t/2) 1/s for 20 s", by_time, depth));
  result.problems.back().equation = "dλ/dt = A_thix/τ0 − k γ̇(t)^a λ, k = 0.26 1/s, a = 0.2";
  result.problems.back().bounds = {{.what = "update: order",
                                    .value = observed_order(result.problems.back().series[0]),
                                    .limit = 1.9,
                                    .at_least = true}};
  const ShearPiece up = {.duration = 10.0, .rate = [](double t) { return 0.5 * t; }};
  const ShearPiece down = {.duration = 10.0, .rate = [](double t) { return 5.0 - 0.5 * t; }};
  const study::Case gate{.name = "gate",
                         .title = "",
                         .history = {up, down},
                         .thixotropy = gated,
                         .times = every_second(20.0),
                         .largest_dt = 0.1};
  result.problems.push_back(
      history_problem("gated", "Up and down through the gate, 0 to 5 to 0 1/s in 20 s", gate, depth));
  result.problems.back().bounds = {{.what = "update: error at 0.01 s",
                                    .value = result.problems.back().series[0].runs[3].error,
                                    .limit = 1e-10}};
  return result;
}

}  // namespace tremie::verification
