// The vane's plane section over cell sizes: torque against closed forms and against the finest cells, the
// three torques against each other, the torque's decay, what moves it apart from the cells, and what the
// instrument would report. Writes vane_study.md, vane_study.csv and vane_study.svg into the folder given.
//
// Closed form, Newtonian, n blades of no thickness in an unbounded plane: T = 4 pi mu Omega R^2 (1 - 1/n) h
// (Atkinson and Sherwood 1992; n = 2 is a plate, half of the cylinder's torque, n -> infinity the cylinder).
// A container at R_o turns what the vane sees by A/R_o^2 where the vane's far field is A/r: R is replaced by
// R sqrt(1 - 1/n) in the cylinder's formula, to (R/R_o)^(2n-2).

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <ctime>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/verification/references/study_output.hpp"
#include "apparatus/verification/references/vane_finite_elements.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace {

using namespace tremie;
using icar_vane::Sample;
using icar_vane::Scene;

constexpr double tau_0 = 54.0, mu = 35.8;  // Mix A
constexpr std::array<double, 3> sizes = {10.0, 5.0, 2.5};
constexpr std::array<double, 6> times = {0.5, 1, 2, 5, 10, 20};

struct Run {
  Scene scene;
  icar_vane::Outcome outcome;
  double cpu = 0.0;
};

Scene plane(double cell_mm, double duration) {
  Scene scene;
  scene.model.space = SpaceKind::plane;
  scene.model.cell = {1e-3 * cell_mm, 1e-3 * cell_mm};
  scene.model.points_per_cell = {3, 3};
  scene.mix.tau_0 = tau_0;
  scene.mix.mu = mu;
  scene.duration = duration;
  return scene;
}

Scene decay(double cell_mm) {
  Scene scene = plane(cell_mm, 20.0);
  scene.rest = 240.0;
  scene.mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.0358}};
  return scene;
}

Run timed(const Scene& scene) {
  const std::clock_t start = std::clock();
  Run r{scene, icar_vane::run(scene), 0.0};
  r.cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return r;
}

double omega(const Scene& s) { return 2.0 * std::numbers::pi * s.speed; }

/// Torque of a cylinder of a Newtonian fluid's vane: of radius R.
double newtonian(const Scene& s, double R) {
  const double Ro = s.vane.container_radius;
  return 4.0 * std::numbers::pi * s.vane.height * omega(s) * s.mix.mu / (1.0 / (R * R) - 1.0 / (Ro * Ro));
}
double thin_blades(const Scene& s) {
  return newtonian(s, s.vane.radius * std::sqrt(1.0 - 1.0 / s.vane.blades));
}

double cylinder(const Scene& s) {
  return reiner_riwlin({s.mix.tau_0, s.mix.mu}, omega(s), Instrument{}).torque;
}

/// Torque at a time, linear between the steps.
double torque_at(const std::vector<Sample>& s, double time) {
  for (std::size_t i = 1; i < s.size(); ++i)
    if (s[i].time >= time * (1.0 - 1e-9)) {
      const double part = (time - s[i - 1].time) / (s[i].time - s[i - 1].time);
      return s[i - 1].torque + part * (s[i].torque - s[i - 1].torque);
    }
  return s.back().torque;
}

/// Largest disagreement of the three torques from `from` on, relative to the blades'; wall with the rate of
/// angular momentum. Means over half a second.
std::array<double, 2> disagreement(const std::vector<Sample>& s, double from) {
  std::array<double, 2> worst{};
  double t = 0.0, blades = 0.0, wall = 0.0, power = 0.0;
  for (const Sample& x : s) {
    if (x.time <= from) continue;
    t += x.time_step, blades += x.torque * x.time_step, power += x.torque_power * x.time_step;
    wall += (x.torque_wall + x.momentum_rate) * x.time_step;
    if (t < 0.5 * (1.0 - 1e-9)) continue;
    worst[0] = std::max(worst[0], std::abs(wall / blades - 1.0));
    worst[1] = std::max(worst[1], std::abs(power / blades - 1.0));
    t = blades = wall = power = 0.0;
  }
  return worst;
}

void newtonian_blades(std::ofstream& md, std::ofstream& csv) {
  md << "## Newtonian, thin blades, against the closed form\n\n| blades | cells mm | torque N m | closed "
        "form "
        "| error | CPU s |\n|---|---|---|---|---|---|\n";
  for (int n : {4, 6})
    for (double size : sizes) {
      Scene s = plane(size, 0.8);
      s.mix.tau_0 = 0.0;
      s.vane.blades = n;
      s.vane.blade_thickness = 1e-6;
      const Run r = timed(s);
      const double T = r.outcome.results.torque_end, error = T / thin_blades(s) - 1.0;
      md << fmt::format("| {} | {} | {:.5f} | {:.5f} | {:+.2f} % | {:.1f} |\n", n, size, T, thin_blades(s),
                        100 * error, r.cpu);
      csv << fmt::format("thin blades {},{},{:.6f},{:.6f},{:.3f}\n", n, size, T, error, r.cpu);
    }
  md << "\nThe closed form neglects (R/R_o)^(2n-2): 0.8 % with 4 blades, 0.03 % with 6.\n";
}

/// The finite elements' own convergence, and what they say at the speeds of a flow curve.
void finite_elements(std::ofstream& md, std::ofstream& csv) {
  md << "\n## The same blades by finite elements\n\nQuadratic velocities, a mesh refined towards the blade's "
        "tip, regularised yield stress in its limit, no inertia (vane_finite_elements.hpp); n elements from "
        "shaft "
        "to tip.\n\n"
        "| fluid | rev/s | n = 8 | 16 | 32 | points, cells of 5 mm | points against n = 16 | CPU s, n = 16 "
        "|\n"
        "|---|---|---|---|---|---|---|---|\n";
  for (const auto& [yield, turns] : {std::pair{0.0, 0.25}, {tau_0, 0.25}, {tau_0, 0.05}, {tau_0, 0.5}}) {
    Scene s = plane(5.0, 1.5);
    s.mix.tau_0 = yield;
    s.speed = turns;
    std::array<double, 3> T{};
    double cpu = 0.0;
    for (std::size_t k = 0; k < T.size(); ++k) {
      if (k == 2 && turns != 0.25) continue;
      const std::clock_t start = std::clock();
      T[k] = verification::finite_element_torque(verification::blade_flow_of(s, 8 << k));
      if (k == 1) cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    }
    const double points = timed(s).outcome.results.torque_end;
    const std::string finest = T[2] > 0.0 ? fmt::format("{:.5f}", T[2]) : "";
    const std::string_view fluid = yield > 0.0 ? "Mix A" : "Newtonian";
    md << fmt::format("| {} | {} | {:.5f} | {:.5f} | {} | {:.5f} | {:+.2f} % | {:.1f} |\n", fluid, turns,
                      T[0], T[1], finest, points, 100 * (points / T[1] - 1.0), cpu);
    csv << fmt::format("finite elements {} {},16,{:.6f},,{:.3f}\n", fluid, turns, T[1], cpu);
  }
}

void steady(std::ofstream& md, std::ofstream& csv) {
  md << "\n## ICAR vane, blades of 3 mm, steady at 0.25 rev/s\n\nRatio to the solid cylinder by "
        "Reiner-Riwlin. From 0.5 s on: disagreement of the wall's torque and of power/speed with the "
        "blades'.\n\n| fluid | cells mm | torque N m | ratio | wall | power | CPU s "
        "|\n|---|---|---|---|---|---|---|\n";
  for (double yield : {0.0, tau_0})
    for (const std::array<double, 2>& cell :
         {std::array{10.0, 10.0}, {7.0, 7.0}, {5.0, 5.0}, {2.5, 2.5}, {5.0, 1.5}}) {
      Scene s = plane(cell[0], 1.5);
      s.model.cell[1] = 1e-3 * cell[1];
      s.mix.tau_0 = yield;
      const Run r = timed(s);
      const auto off = disagreement(r.outcome.series, 0.5);
      const std::string name =
          cell[0] == cell[1] ? fmt::format("{}", cell[0]) : fmt::format("{}×{}", cell[0], cell[1]);
      md << fmt::format("| {} | {} | {:.4f} | {:.4f} | {:.2f} % | {:.2f} % | {:.1f} |\n",
                        yield > 0.0 ? "Mix A" : "Newtonian", name, r.outcome.results.torque_end,
                        r.outcome.results.torque_end / cylinder(s), 100 * off[0], 100 * off[1], r.cpu);
      csv << fmt::format("steady {},{},{:.6f},,{:.3f}\n", yield > 0.0 ? "Mix A" : "Newtonian", name,
                         r.outcome.results.torque_end, r.cpu);
    }
  md << "\nBlades are at least one cell thick, so cells are at most 3 mm there; 5×1.5 has two.\n";
}

void what_else(std::ofstream& md) {
  md << "\n## Mix A at 5 mm: what should not matter\n\n| what | torque N m | against 0 deg, 10 mm shaft "
        "|\n|---|---|---|\n";
  const double base = timed(plane(5.0, 1.5)).outcome.results.torque_end;
  const auto row = [&](const std::string& what, const Scene& s, double sign) {
    const double T = timed(s).outcome.results.torque_end;
    md << fmt::format("| {} | {:.5f} | {:+.3g} % |\n", what, T, 100 * (sign * T / base - 1.0));
  };
  for (double degrees : {0.0, 1.0, 7.0, 22.5}) {
    Scene s = plane(5.0, 1.5);
    s.orientation = degrees * std::numbers::pi / 180.0;
    row(fmt::format("blades turned by {} deg against the points", degrees), s, 1.0);
  }
  for (double shaft : {5.0, 15.0, 25.0}) {
    Scene s = plane(5.0, 1.5);
    s.vane.shaft_radius = 1e-3 * shaft;
    row(fmt::format("shaft of {} mm", shaft), s, 1.0);
  }
  Scene back = plane(5.0, 1.5);
  back.speed = -back.speed;
  row("turned the other way", back, -1.0);
}

/// Returns the chart.
std::string decays(std::ofstream& md, std::ofstream& csv, std::ofstream& curves) {
  md << "\n## Mix A after 240 s of rest, alpha = 0.0358, 0.25 rev/s: decay of the torque\n\nTorque in N m. "
        "From 0.5 s on: worst difference from 2.5 mm cells, disagreement of the torques.\n\n"
        "| cells mm |";
  for (double t : times) md << fmt::format(" {} s |", t);
  md << " worst | wall | power | steps | CPU s |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::vector<Run> runs;
  for (double size : sizes) runs.push_back(timed(decay(size)));
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto &series = runs[k].outcome.series, &finest = runs.back().outcome.series;
    double worst = 0.0;
    md << fmt::format("| {} |", sizes[k]);
    for (double t : times) md << fmt::format(" {:.4f} |", torque_at(series, t));
    for (double t = 0.5; t <= 20.0; t += 0.5)
      worst = std::max(worst, std::abs(torque_at(series, t) / torque_at(finest, t) - 1.0));
    const auto off = disagreement(series, 0.5);
    md << fmt::format(" {:.2f} % | {:.2f} % | {:.2f} % | {} | {:.1f} |\n", 100 * worst, 100 * off[0],
                      100 * off[1], runs[k].outcome.cost.steps, runs[k].cpu);
    csv << fmt::format("decay,{},{:.6f},{:.6f},{:.3f}\n", sizes[k], series.back().torque, worst, runs[k].cpu);
  }
  curves << "time_s";
  for (double size : sizes) curves << fmt::format(",torque_{}mm_N_m", size);
  curves << ",wall_5mm_N_m,power_5mm_N_m,momentum_rate_5mm_N_m\n";
  using report::Mark;
  report::LineChart decay{.title = "Decay of the torque",
                          .x_label = "time (s)",
                          .y_label = "torque (N·m)",
                          .curves = {study::curve("10 mm"), study::curve("5 mm"), study::curve("2.5 mm")},
                          .y_from_zero = true};
  report::LineChart start{.title = "The start, 5 mm",
                          .x_label = "time (s)",
                          .y_label = "torque (N·m)",
                          .curves = {study::curve("blades"), study::curve("container"),
                                     study::curve("container + rate of angular momentum", Mark::points),
                                     study::curve("power / speed", Mark::dashed)}};
  for (const Sample& s : runs[1].outcome.series) {
    curves << fmt::format("{:.5g}", s.time);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const double torque = torque_at(runs[k].outcome.series, s.time);
      curves << fmt::format(",{:.5f}", torque);
      study::add_point(decay.curves[k], s.time, torque);
    }
    curves << fmt::format(",{:.5f},{:.5f},{:.5f}\n", s.torque_wall, s.torque_power, s.momentum_rate);
    const std::array parts{s.torque, s.torque_wall, s.torque_wall + s.momentum_rate, s.torque_power};
    for (std::size_t k = 0; s.time <= 0.3 && k < parts.size(); ++k)
      study::add_point(start.curves[k], s.time, parts[k]);
  }
  return report::svg_file({decay, start});
}

void closed_loop(std::ofstream& md) {
  Scene s = plane(5.0, 0.0);
  s.speeds = {0.5, 0.425, 0.35, 0.275, 0.2, 0.125, 0.05};
  s.pre_shear_time = 2.0;
  s.hold_time = 2.0;
  s.average_time = 0.5;
  const Run r = timed(s);
  md << "\n## What an ICAR reports of Mix A\n\nA flow curve without thixotropy, and the "
        "parameters that Reiner and Riwlin's cylinder gives:\n\n| | in | reported | |\n|---|---|---|---|\n";
  if (!r.outcome.results.reiner_riwlin) return;
  const auto& b = *r.outcome.results.reiner_riwlin;
  md << fmt::format("| yield stress Pa | {} | {:.1f} | {:+.1f} % |\n", tau_0, b.yield_stress,
                    100 * (b.yield_stress / tau_0 - 1.0));
  md << fmt::format("| plastic viscosity Pa s | {} | {:.1f} | {:+.1f} % |\n", mu, b.plastic_viscosity,
                    100 * (b.plastic_viscosity / mu - 1.0));
  md << "\n| speed rev/s | torque N m | of the cylinder's |\n|---|---|---|\n";
  for (const auto& p : r.outcome.results.flow_curve) {
    const double solid = reiner_riwlin({tau_0, mu}, 2.0 * std::numbers::pi * p.speed, Instrument{}).torque;
    md << fmt::format("| {} | {:.4f} | {:.3f} |\n", p.speed, p.torque, p.torque / solid);
  }
}

}  // namespace

constexpr const char* question_and_answer =
    R"(**Question.** How large is the error of the torque of the vane's plane section? Do cells, the blades' position or the shaft matter?

**Answer.** The torque is within 0.4 % of independent finite elements. The blades' position and the shaft move it by 0.003 %. The decay on 5 mm cells is within 1.5 % of
that on 2.5 mm cells.

**Limits.** No ends ([vane_ends.md](vane_ends.md)); blades are at least one cell thick.

)";

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  std::ofstream md(folder + "/vane_study.md"), csv(folder + "/vane_study.csv"),
      curves(folder + "/vane_decay.csv");
  md << "# The vane's plane section: error against run time\n\n"
     << study::made_by("study_vane") << " Chart of the decays: vane_study.svg.\n\n"
     << question_and_answer;
  csv << "case,cell_mm,torque_N_m,error,cpu_s\n";
  newtonian_blades(md, csv);
  steady(md, csv);
  finite_elements(md, csv);
  what_else(md);
  closed_loop(md);
  std::ofstream(folder + "/vane_study.svg") << decays(md, csv, curves);
}
