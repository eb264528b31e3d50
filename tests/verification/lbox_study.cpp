// The L-box over cells, yield stresses and modes: the profile against the closed form at rest, the films on
// the column's walls against their drainage, CPU seconds. Prints its tables; writes lbox_study.csv, lbox_profiles.csv and
// lbox_study.svg into the folder given.

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <string>

#include "apparatus/verification/references/lbox_case.hpp"
#include "apparatus/verification/references/study_output.hpp"

namespace {

using namespace tremie;
using namespace tremie::lbox_reference;

constexpr double above = 0.12;  // what is higher hangs on the walls [m]

struct Run {
  l_box::Outcome outcome;
  Compared compared;
  double cpu = 0.0;
  std::vector<std::array<double, 2>> films;  // time [s], share of the concrete
};

struct Case {
  double tau_0 = 50.0, cell_mm = 10.0, duration = 180.0;
  bool side_walls = false;
  double alternating_viscosity = l_box::Scene{}.alternating_viscosity;
  std::array<int, 2> points = {16, 4};
};

/// Volume a metre of width of a Bingham film that drains down a wall from its top to `length` below [m^2],
/// long after it was left there: the kinematic wave z / t = (rho g / mu) s (s + tau_0 / rho g), s the depth
/// of its sheared part, on which the plug of tau_0 / rho g rides.
double film_volume(double tau_0, double mu, double length, double time) {
  constexpr int n = 1000;
  const double plug = tau_0 / rho_g;
  double volume = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = (i + 0.5) / n * length;
    const double s = 0.5 * (std::sqrt(plug * plug + 4.0 * mu * z / (rho_g * time)) - plug);
    volume += (s + plug) * length / n;
  }
  return volume;
}

double hanging_share(const Frame& frame) {
  double all = 0.0, hanging = 0.0;
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    all += frame.volume[p];
    if (frame.position[p][1] > above) hanging += frame.volume[p];
  }
  return hanging / all;
}

Run run(const Case& c) {
  l_box::Scene scene = scene_of(c.tau_0, 1e-3 * c.cell_mm, c.side_walls);
  scene.duration = c.duration;
  scene.alternating_viscosity = c.alternating_viscosity;
  scene.model.points_per_cell = c.points;
  scene.frame_interval = 20.0;
  Run r;
  scene::Observer observer;
  observer.on_frame = [&](const Frame& frame) { r.films.push_back({frame.time, hanging_share(frame)}); };
  const std::clock_t start = std::clock();
  r.outcome = l_box::run(scene, observer);
  r.cpu = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  r.compared = compare(scene, r.outcome);
  return r;
}

std::string or_none(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "none";
}

/// Profiles of 10 mm cells beside the closed form, and the error over the CPU time of 50 Pa; a colour a mode and stress.
struct Charts {
  report::LineChart profiles{.title = "Profiles at rest, 10 mm cells",
                             .x_label = "distance from the gate (mm)",
                             .y_label = "depth (mm)",
                             .curves = {}};
  report::LineChart errors{.title = "50 Pa; 20, 10, 5 mm cells",
                           .x_label = "CPU time (s)",
                           .y_label = "error of the profile, rms (%)",
                           .curves = {study::curve("plane", report::Mark::line_and_points),
                                      study::curve("side walls", report::Mark::line_and_points)},
                           .log_x = true,
                           .log_y = true};
};

void add(const Case& c, const Run& r, Charts& charts) {
  if (c.points != Case{}.points || c.alternating_viscosity != Case{}.alternating_viscosity) return;
  if (c.tau_0 == 50.0)
    study::add_point(charts.errors.curves[c.side_walls], r.cpu, 100 * r.compared.error.rms);
  if (c.cell_mm != 10.0 || !(c.tau_0 == 50.0 || (c.tau_0 == 15.0 && !c.side_walls))) return;
  const int colour = static_cast<int>(charts.profiles.curves.size() / 2);
  report::Curve computed = study::curve(
      fmt::format("{:g} Pa, {}", c.tau_0, c.side_walls ? "side walls" : "plane"), report::Mark::points);
  report::Curve form = study::curve(colour == 0 ? "closed form at the same volume" : "");
  computed.colour = form.colour = colour;
  for (const auto& [x, h] : r.outcome.results.profile) {
    study::add_point(computed, 1e3 * x, 1e3 * h);
    study::add_point(form, 1e3 * x, 1e3 * r.compared.form.depth(x));
  }
  charts.profiles.curves.insert(charts.profiles.curves.end(), {computed, form});
}

/// Runs a case and writes its row; returns the films over time.
std::vector<std::array<double, 2>> row(const Case& c, std::ostream& md, std::ofstream& csv,
                                       std::ofstream& profiles, Charts& charts) {
  const Run r = run(c);
  add(c, r, charts);
  const auto& results = r.outcome.results;
  const auto& [form, error, heap, ratio] = r.compared;
  const char* mode = c.side_walls ? "side walls" : "plane";
  md << fmt::format("| {} | {:g} | {:g} | {:.1f} | {} | {} | {:.3f} | {:.1f} | {:.1f} | {} | {} | {:.1f} |\n",
                    mode, c.tau_0, c.cell_mm, 1e3 * results.h1,
                    or_none(results.h2 ? std::optional(1e3 * *results.h2) : std::nullopt, "{:.1f}"),
                    or_none(results.passing_ratio, "{:.3f}"), ratio, 100 * error.rms, 100 * error.worst,
                    or_none(results.t400, "{:.3f}"), or_none(results.stopped_at, "{:.0f}"), r.cpu);
  md.flush();
  csv << fmt::format("{},{:g},{:g},{:g},{},{:.4f},{:.5f},{:.5f},{:.4f},{},{:.2f},{:.1f},{:.1f},{},{:.3f}\n",
                     mode, c.tau_0, c.cell_mm, c.duration, or_none(results.passing_ratio, "{:.4f}"), ratio,
                     error.rms, error.worst, r.films.back()[1], r.outcome.cost.steps, r.cpu, 1e3 * heap,
                     1e3 * heap_that_is_borne(c.tau_0), or_none(results.t200, "{:.3f}"),
                     100 * r.outcome.checks.volume_change);
  for (const auto& [x, h] : results.profile)
    profiles << fmt::format("{},{:g},{:g},{:.1f},{:.2f},{:.2f}\n", mode, c.tau_0, c.cell_mm, 1e3 * x, 1e3 * h,
                            1e3 * form.depth(x));
  return r.films;
}

constexpr const char* head =
    "| mode | τ0 Pa | cells mm | H1 mm | H2 mm | ratio | closed form | rms % | worst % | t400 s | stopped s "
    "| CPU s |\n"
    "|---|---|---|---|---|---|---|---|---|---|---|---|\n";

/// The films of 50 Pa in the plane, over time, by cell size [mm].
using Films = std::map<double, std::vector<std::array<double, 2>>, std::greater<>>;

void write_films(const Films& all, std::ostream& md) {
  md << "\n## The films on the column's walls (50 Pa, 30 Pa·s, plane)\n\nShare of the concrete above "
        "120 mm; the drainage of a Bingham film as a kinematic wave, from 600 mm down.\n\n| cells mm | 20 s "
        "| 40 s | 60 s |\n|---|---|---|---|\n| kinematic wave |";
  for (double t : {20.0, 40.0, 60.0}) {
    const double share = (film_volume(50.0, 30.0, 0.48, t) + film_volume(50.0, 30.0, 0.45, t)) / 0.06;
    md << fmt::format(" {:.1f} % |", 100 * share);
  }
  for (const auto& [cell, films] : all) {
    md << fmt::format("\n| {:g} |", cell);
    for (double t : {20.0, 40.0, 60.0})
      for (const auto& [time, share] : films)
        if (time >= t * (1.0 - 1e-9)) {
          md << fmt::format(" {:.1f} % |", 100 * share);
          break;
        }
  }
  md << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  const std::string folder = argc > 1 ? argv[1] : ".";
  std::ostream& md = std::cout;
  std::ofstream csv(folder + "/lbox_study.csv"), profiles(folder + "/lbox_profiles.csv");
  md << "# The L-box: all figures\n\n" << study::made_by("study_lbox") << "\n\n";
  md << "μ = 30 Pa·s, K = 5 MPa, gate at 30 cm/s, 16×4 points a cell, 180 s at most; readings as in "
        "lbox_study.md.\n\n";
  csv << "mode,tau_0_Pa,cell_mm,duration_s,ratio,ratio_closed_form,error_rms,error_worst_100_mm,films,steps,"
         "cpu_s,heap_mm,borne_mm,t200_s,volume_percent\n";
  profiles << "mode,tau_0_Pa,cell_mm,distance_mm,depth_mm,closed_form_mm\n";
  Films films;
  Charts charts;
  md << "## Cells\n\n" << head;
  for (bool side_walls : {false, true})
    for (double cell : {20.0, 10.0, 5.0}) {
      const auto hanging = row({.cell_mm = cell, .side_walls = side_walls}, md, csv, profiles, charts);
      if (!side_walls) films[cell] = hanging;
    }
  md << "\n## Yield stresses, 10 mm cells\n\n" << head;
  for (bool side_walls : {false, true})
    for (double tau_0 : {0.0, 15.0, 30.0})
      row({.tau_0 = tau_0, .side_walls = side_walls}, md, csv, profiles, charts);
  md << "\n## Points a cell, 20 mm\n\n32×8 instead of 16×4: the column's concrete is stretched eight times, "
        "and "
        "two of 16 points are left along a cell.\n\n"
     << head;
  for (bool side_walls : {false, true})
    for (double tau_0 : {0.0, 15.0})
      for (std::array<int, 2> points : {std::array{16, 4}, std::array{32, 8}})
        row({.tau_0 = tau_0, .cell_mm = 20.0, .side_walls = side_walls, .points = points}, md, csv, profiles,
            charts);
  md << "\n## Without the viscosity against velocities that alternate from node to node\n\n15 Pa, plane, 20 "
        "mm "
        "(libmpm/implicit/problem/yield_problem.hpp); 100 μ is the default above.\n\n"
     << head;
  for (double zeta : {0.0, 100.0})
    row({.tau_0 = 15.0, .cell_mm = 20.0, .alternating_viscosity = zeta}, md, csv, profiles, charts);
  write_films(films, md);
  std::ofstream(folder + "/lbox_study.svg") << report::svg_file({charts.profiles, charts.errors});
}
