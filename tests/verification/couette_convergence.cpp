// The thixotropic Couette reference refined in r and in t.
//
//   Mix A after 240 s of rest, 0.25 rev/s, alpha = 0.0358; gated and roussel kinetics. Differences are taken
//   to the finest solution, 3200 intervals at a tolerance of 1e-9. Published: T = 2.36, 1.63, 1.38, 1.24 N m
//   at 0, 5, 10, 20 s.
//
//   couette_convergence DIR     prints its table, writes couette_decay.csv and .svg into DIR

#include <array>
#include <cmath>
#include <iomanip>

#include "apparatus/verification/references/study_output.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::study {
namespace {

const std::vector<double> times{0.0, 5.0, 10.0, 20.0};

const Kinetics gated_kinetics = GatedKinetics{0.0358}, roussel_kinetics = RousselKinetics{0.0358};

CouetteFlow mix_a(const Kinetics& kinetics) {
  return {{54.0, 35.8}, {1.3, kinetics, 1.3 * 240.0 / 54.0}, angular_speed(0.25), {}};
}

CouetteDecay solve(const Kinetics& kinetics, int intervals, double tolerance) {
  CouetteOptions options;
  options.intervals = intervals;
  options.relative_tolerance = tolerance;
  options.absolute_tolerance = 0.1 * tolerance;
  options.keep_profiles = true;
  return thixotropic_couette(mix_a(kinetics), times, {}, options);
}

void write_rows(std::ostream& out, const Kinetics& kinetics, const char* name, const CouetteDecay& finest) {
  const auto row = [&](int intervals, double tolerance) {
    const CouetteDecay d = solve(kinetics, intervals, tolerance);
    out << "| " << name << " | " << intervals << " | " << std::setprecision(1) << std::scientific << tolerance
        << " |";
    for (std::size_t i = 0; i < times.size(); ++i) out << ' ' << d.torque[i] / finest.torque[i] - 1.0 << " |";
    const CouetteFlow flow = mix_a(kinetics);
    double power = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i)
      power = std::max(power, std::abs(dissipated_power(d.profile[i], d.radius, flow.bingham) /
                                           (d.torque[i] * flow.omega) -
                                       1.0));
    out << ' ' << power << " | " << d.steps << " |\n" << std::defaultfloat;
  };
  for (const int intervals : {50, 100, 200, 400, 800, 1600}) row(intervals, 1e-8);
  for (const double tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8}) row(800, tolerance);
}

void write_decay(const std::string& directory) {
  std::ofstream out(directory + "/couette_decay.csv");
  out << "time_s,torque_gated_N_m,torque_roussel_N_m,sheared_radius_gated_mm,sheared_radius_roussel_mm\n";
  std::vector<double> t;
  for (int i = 0; i <= 200; ++i) t.push_back(0.1 * i);
  const CouetteDecay gated = thixotropic_couette(mix_a(gated_kinetics), t);
  const CouetteDecay roussel = thixotropic_couette(mix_a(roussel_kinetics), t);
  report::LineChart torque{.title = "Torque", .x_label = "time (s)", .y_label = "torque (N·m)", .curves = {}},
      sheared{.title = "Sheared as far as", .x_label = "time (s)", .y_label = "radius (mm)", .curves = {}};
  torque.curves = {curve("gated"),
                   curve("roussel", report::Mark::dashed),
                   {"published, gated", times, {2.36, 1.63, 1.38, 1.24}, report::Mark::points}};
  torque.levels = {{"dynamic Reiner-Riwlin torque", 0.801, 0.0}};
  torque.y_from_zero = true;
  sheared.curves = {curve("gated"), curve("roussel", report::Mark::dashed)};
  const std::array decays{&gated, &roussel};
  for (std::size_t i = 0; i < t.size(); ++i) {
    out << t[i] << ',' << gated.torque[i] << ',' << roussel.torque[i] << ',' << 1e3 * gated.sheared_radius[i]
        << ',' << 1e3 * roussel.sheared_radius[i] << '\n';
    for (std::size_t k = 0; k < decays.size(); ++k) {
      add_point(torque.curves[k], t[i], decays[k]->torque[i]);
      add_point(sheared.curves[k], t[i], 1e3 * decays[k]->sheared_radius[i]);
    }
  }
  std::ofstream(directory + "/couette_decay.svg") << report::svg_file({torque, sheared});
}

void run(const std::string& directory) {
  std::ostream& out = std::cout;
  out << "# Thixotropic Couette flow: convergence in r and t\n\n"
      << made_by("study_couette") << "\n\n"
      << "Mix A after 240 s of rest, 0.25 rev/s, alpha = 0.0358. Error of the torque at four times against "
         "3200 "
         "intervals at a\ntolerance of 1e-9; largest relative difference between T Omega and the dissipated "
         "power; IDA's steps. Chart: couette_decay.svg.\n\n"
      << "| kinetics | intervals | tolerance | T(0) | T(5 s) | T(10 s) | T(20 s) | power | steps |\n"
         "|---|---|---|---|---|---|---|---|---|\n";
  for (const auto& [kinetics, name] : {std::pair{gated_kinetics, "gated"}, {roussel_kinetics, "roussel"}}) {
    const CouetteDecay finest = solve(kinetics, 3200, 1e-9);
    write_rows(out, kinetics, name, finest);
    out << "| " << name << " | 3200 | 1e-9 |" << std::setprecision(7);
    for (const double torque : finest.torque) out << ' ' << torque << " N m |";
    out << " | " << finest.steps << " |\n";
  }
  write_decay(directory);
}

}  // namespace
}  // namespace tremie::study

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: couette_convergence DIR\n";
    return 2;
  }
  tremie::study::run(argv[1]);
}
