// Work-precision of the flocculation state: error of lambda against CPU time for the two per-point updates
// (the material points', which knows the rate at the ends of a step, and that along a history, which asks for
// it in the middle too), forward Euler, CVODE and ARKODE.
//
//   d lambda/dt = A_thix/tau_0 - alpha lambda gamma_dot(t), and the gated form of it
//   (libmpm/constitutive/flocculation.hpp)
//
// Reference: CVODE at 1e-13. Error: the largest of |lambda - reference| over the comparison times, over the
// largest lambda. CPU time: the smallest of nine means, each over as many repetitions as fill 4 ms, in three
// rounds over all methods: other work on the machine makes a mean larger, never smaller.
//
//   flocculation_work_precision DIR     writes flocculation_work_precision.csv, .md and .svg into DIR

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "apparatus/verification/references/flocculation_methods.hpp"
#include "apparatus/verification/references/study_output.hpp"

namespace tremie::study {
namespace {

constexpr double pi = 3.14159265358979323846;

/// The whole step on the side of the gate that its mean rate is on.
double one_step_without_split(const Thixotropy& t, double lambda, const Step& s) {
  const double mean = 0.5 * (s.g0 + s.g1);
  const auto& k = std::get<GatedKinetics>(t.kinetics);
  return mean < k.gamma_c ? lambda + t.A_thix / tau_0 * s.dt : lambda * std::exp(-k.alpha * mean * s.dt);
}

std::vector<double> even_times(double end, int n) {
  std::vector<double> t;
  for (int i = 1; i <= n; ++i) t.push_back(end * i / n);
  return t;
}

std::vector<Case> cases() {
  const Thixotropy roussel{1.3, RousselKinetics{0.0358}}, gated{1.3, GatedKinetics{0.0358}},
      stiff{1.3, RousselKinetics{1.0}};
  const auto smooth = [](double duration, std::function<double(double)> rate) {
    return std::vector<ShearPiece>{{duration, std::move(rate)}};
  };
  const std::vector<ShearSegment> trapezium{
      {10.0, 0.0, 0.0}, {2.0, 0.0, 12.0}, {4.0, 12.0, 12.0}, {2.0, 12.0, 0.0}, {10.0, 0.0, 0.0}};
  return {{"constant", "constant rate, 12.43 1/s", smooth(10.0, [](double) { return 12.43; }), roussel, 5.0,
           even_times(10.0, 10), 1.0},
          {"ramp", "ramp 0 to 12 1/s in 10 s", smooth(10.0, [](double t) { return 1.2 * t; }), roussel, 5.0,
           even_times(10.0, 10), 1.0},
          {"pulse", "pulse 12 1/s, 1 s wide",
           smooth(6.0, [](double t) { return 0.2 + 12.0 * std::exp(-2.0 * (t - 3.0) * (t - 3.0)); }), roussel,
           5.0, even_times(6.0, 6), 1.0},
          {"rest_flow_rest",
           "rest, flow, rest; gated, linear ramps",
           linear_pieces(trapezium),
           gated,
           0.0,
           {10.0, 12.0, 16.0, 18.0, 28.0},
           1.0},
          {"waves_gated", "2 - 2 cos(1.3 t) 1/s; gated",
           smooth(9.0, [](double t) { return 2.0 - 2.0 * std::cos(1.3 * t); }), gated, 5.0,
           even_times(9.0, 9), 1.0},
          {"stiff", "stiff: alpha gamma_dot 5e5 to 1.5e6 1/s",
           smooth(1.0, [](double t) { return 1e6 * (1.0 + 0.5 * std::sin(2.0 * pi * t)); }), stiff, 5.0,
           even_times(1.0, 10), 0.1}};
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Point {
  std::string method;
  double setting = 0.0;  ///< step [s] or tolerance
  double error = 0.0, cpu = 0.0;
};

/// CPU time of one call [s]. The clock costs as much as a short history, so it is read once in many calls.
double cpu_of(const std::function<std::vector<double>()>& run) {
  double best = HUGE_VAL;
  long calls = 1;
  for (int filled = 0; filled < 3;) {
    const double start = cpu_seconds();
    for (long i = 0; i < calls; ++i) run();
    const double cpu = cpu_seconds() - start;
    if (cpu < 0.004) {
      calls *= 2;
      continue;
    }
    best = std::min(best, cpu / static_cast<double>(calls));
    ++filled;
  }
  return best;
}

Point measure(const std::string& method, double setting, double lambda_0,
              const std::vector<double>& reference, const std::function<std::vector<double>()>& run) {
  Point p{method, setting, 0.0, 0.0};
  std::vector<double> lambda;
  try {
    lambda = run();
  } catch (const std::runtime_error& error) {  // an integrator that gives up has no error and no time
    std::cerr << method << " at " << setting << ": " << error.what() << '\n';
    p.error = p.cpu = HUGE_VAL;
    return p;
  }
  double largest = lambda_0;
  for (std::size_t i = 0; i < lambda.size(); ++i) {
    if (!std::isfinite(lambda[i])) p.error = HUGE_VAL;  // an unstable method
    p.error = std::max(p.error, std::abs(lambda[i] - reference[i]));
    largest = std::max(largest, reference[i]);
  }
  p.error /= largest;
  p.cpu = cpu_of(run);
  return p;
}

std::vector<Point> run_case(const Case& c, const std::vector<double>& reference) {
  std::vector<Point> points;
  for (const double dt :
       {1.0, 0.5, 0.25, 0.2, 0.1, 0.05, 0.02, 0.01, 7e-3, 5e-3, 2e-3, 1e-3, 3e-4, 1e-4, 1e-5}) {
    if (dt > c.largest_dt) continue;
    points.push_back(measure("update", dt, c.lambda_0, reference, [&] { return march(c, dt, one_step); }));
    points.push_back(
        measure("update along", dt, c.lambda_0, reference, [&] { return march(c, dt, one_step_along); }));
    points.push_back(
        measure("euler", dt, c.lambda_0, reference, [&] { return march(c, dt, one_step_of_euler); }));
    if (gate(c.thixotropy.kinetics))
      points.push_back(measure("update without split", dt, c.lambda_0, reference,
                               [&] { return march(c, dt, one_step_without_split); }));
  }
  for (double k = 3.0; k <= 12.0; k += 0.5) {
    const double tolerance = std::pow(10.0, -k);
    points.push_back(measure("cvode", tolerance, c.lambda_0, reference, [&] {
      return flocculation_ode(c.history, c.thixotropy, tau_0, c.lambda_0, c.times,
                              {tolerance, 0.01 * tolerance})
          .lambda;
    }));
    points.push_back(measure("arkode", tolerance, c.lambda_0, reference,
                             [&] { return by_arkode(c, tolerance, c.name == "stiff"); }));
  }
  return points;
}

/// What one material point costs in a simulation: the rate is known at the ends of the steps alone, 1 ms
/// apart, and each step is advanced before the next is known, so CVODE has to start anew in each.
struct StepCost {
  double update = 0.0, cvode = 0.0;  ///< CPU time a step [s]
};

StepCost step_cost(const Case& c, double tolerance) {
  const double dt = 1e-3;
  std::vector<double> rates;
  for (int i = 0; i <= 1000; ++i) rates.push_back(c.history.front().rate(i * dt));
  const auto per_step = [](int repetitions, const auto& run) {
    volatile double sink = 0.0;
    const double start = cpu_seconds();
    for (int k = 0; k < repetitions; ++k) sink = run();
    static_cast<void>(sink);
    return (cpu_seconds() - start) / (1000.0 * repetitions);
  };
  const auto update = [&] {
    double lambda = c.lambda_0;
    for (std::size_t i = 1; i < rates.size(); ++i)
      lambda = flocculation_step(lambda, c.thixotropy, tau_0, rates[i - 1], rates[i], dt);
    return lambda;
  };
  return {per_step(300, update), per_step(3, [&] { return by_cvode_step_by_step(c, tolerance, dt, rates); })};
}

// --- tables
// ----------------------------------------------------------------------------------------------------------

/// The cheapest CPU time with an error of at most `wanted`; infinite where there is none.
double cheapest(const std::vector<Point>& points, const std::string& method, double wanted) {
  double best = HUGE_VAL;
  for (const Point& p : points)
    if (p.method == method && p.error <= wanted) best = std::min(best, p.cpu);
  return best;
}

/// Order between the largest step with an error below 1e-2 and the smallest with one above 1e-10, where the
/// reference ends; NaN where a method is exact (no two such steps).
double order(const std::vector<Point>& points, const std::string& method) {
  const Point *coarse = nullptr, *fine = nullptr;
  for (const Point& p : points) {
    if (p.method != method || p.error > 1e-2 || p.error < 1e-10) continue;
    if (!coarse) coarse = &p;
    fine = &p;
  }
  const bool unstable = std::none_of(points.begin(), points.end(),
                                     [&](const Point& p) { return p.method == method && p.error < 1e-2; });
  if (unstable) return HUGE_VAL;
  if (!coarse || coarse == fine) return std::nan("");
  return std::log(coarse->error / fine->error) / std::log(coarse->setting / fine->setting);
}

std::string number(double v, int digits = 2) {
  if (std::isnan(v)) return "exact";
  if (std::isinf(v)) return "not reached";
  std::ostringstream s;
  s << std::setprecision(digits) << v;
  return s.str();
}

struct Result {
  Case c;
  std::vector<Point> points;
  StepCost step;
};

void write_csv(const std::vector<Result>& results, const std::string& path) {
  std::ofstream out(path);
  out << "case,method,step_s_or_tolerance,error,cpu_s\n";
  for (const Result& r : results)
    for (const Point& p : r.points)
      out << r.c.name << ',' << p.method << ',' << p.setting << ',' << p.error << ',' << p.cpu << '\n';
}

const char* const head =
    "Error: largest difference to CVODE at 1e-13 over the largest lambda. CPU time: of the whole history "
    "with set-up, smallest\n"
    "of nine. Chart: flocculation_work_precision.svg, data: flocculation_work_precision.csv.\n\n"
    "There are two updates per point. `flocculation_step` serves material points: it knows the shear rate at "
    "both ends of a step.\n"
    "`flocculation_step_along` serves a known history: it evaluates the rate within the step.\n\n"
    "CPU time in microseconds for the whole history at an error of at most 1e-6, and observed orders:\n\n";

const char* const remarks =
    "Both updates are exact at constant rate and, under the gate, for linear rates. On curved histories the "
    "first is of order 2, the\n"
    "update along the history of order 6. Stepping over the gate costs an order; splitting the step at "
    "gamma_c restores it.\n\n"
    "On the two curved histories CVODE takes a few dozen long steps; the first update is less than 100 times "
    "cheaper, the update along\n"
    "the history about a hundred times. CVODE's set-up is about half of its time on smooth histories.\n";

void write_row(std::ofstream& out, const Result& r) {
  const double update = cheapest(r.points, "update", 1e-6), along = cheapest(r.points, "update along", 1e-6),
               cvode = cheapest(r.points, "cvode", 1e-6);
  const auto us = [](double s) { return number(1e6 * s); };
  const double euler = order(r.points, "euler");
  out << "| " << r.c.title << " | " << us(update) << " | " << us(along) << " | "
      << us(cheapest(r.points, "euler", 1e-6)) << " | " << us(cvode) << " | "
      << us(cheapest(r.points, "arkode", 1e-6)) << " | " << number(cvode / update) << " | "
      << number(cvode / along) << " | " << number(order(r.points, "update")) << " | "
      << number(order(r.points, "update along")) << " | " << (std::isinf(euler) ? "unstable" : number(euler))
      << " | "
      << (gate(r.c.thixotropy.kinetics) ? number(order(r.points, "update without split")) : "no gate")
      << " |\n";
}

void write_markdown(const std::vector<Result>& results, const std::string& path) {
  std::ofstream out(path);
  out << "# Flocculation: error against CPU time\n\n"
      << made_by("study_flocculation") << "\n"
      << head
      << "| history | update | along | forward Euler | CVODE | ARKODE | CVODE / update | CVODE / along | "
         "order of the "
         "update | along | of Euler | of the update without the split "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Result& r : results) write_row(out, r);
  out << "\n"
      << remarks
      << "\nCPU time in nanoseconds for one material point and one step of 1 ms, as in a simulation. CVODE "
         "at 1e-6 "
         "starts anew in each step.\n\n| history | update | CVODE | CVODE / update |\n|---|---|---|---|\n";
  for (const Result& r : results)
    out << "| " << r.c.title << " | " << number(1e9 * r.step.update, 3) << " | "
        << number(1e9 * r.step.cvode, 3) << " | " << number(r.step.cvode / r.step.update, 3) << " |\n";
}

void write_chart(const std::vector<Result>& results, const std::string& path) {
  std::vector<report::LineChart> charts;
  for (const Result& r : results) {
    report::LineChart chart{.title = r.c.title,
                            .x_label = "CPU time (s)",
                            .y_label = "relative error of λ",
                            .curves = {},
                            .log_x = true,
                            .log_y = true};
    for (const char* method :
         {"update", "update along", "euler", "cvode", "arkode", "update without split"}) {
      report::Curve drawn = curve(method, report::Mark::line_and_points);
      bool run = false;
      for (const Point& p : r.points) {
        if (p.method != method) continue;
        run = true;
        if (p.error < 10.0) add_point(drawn, p.cpu, std::max(p.error, 1e-16));
      }
      if (run) chart.curves.push_back(std::move(drawn));  // unstable: in the legend alone, its colour kept
    }
    charts.push_back(std::move(chart));
  }
  std::ofstream(path) << report::svg_file(charts, 2);
}

void keep_smaller(Result& r, const std::vector<Point>& again, const StepCost& step) {
  for (std::size_t i = 0; i < again.size(); ++i) r.points[i].cpu = std::min(r.points[i].cpu, again[i].cpu);
  r.step.update = std::min(r.step.update, step.update);
  r.step.cvode = std::min(r.step.cvode, step.cvode);
}

int run(const std::string& directory) {
  std::vector<Result> results;
  for (const Case& c : cases()) {
    const auto reference = flocculation_ode(c.history, c.thixotropy, tau_0, c.lambda_0, c.times).lambda;
    results.push_back({c, run_case(c, reference), step_cost(c, 1e-6)});
    for (int round = 1; round < 3; ++round)
      keep_smaller(results.back(), run_case(c, reference), step_cost(c, 1e-6));
  }
  write_csv(results, directory + "/flocculation_work_precision.csv");
  write_markdown(results, directory + "/flocculation_work_precision.md");
  write_chart(results, directory + "/flocculation_work_precision.svg");
  return 0;
}

}  // namespace
}  // namespace tremie::study

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: flocculation_work_precision DIR\n";
    return 2;
  }
  return tremie::study::run(argv[1]);
}
