// The torque of vanes with ends over that of their plane sections: writes table.csv, which `tremie fit --ends computed`
// reads, into the folder given, and prints the ICAR's over cell sizes as in vane_ends.md.

#include <fmt/format.h>

#include <ctime>
#include <fstream>
#include <numbers>

#include "apparatus/icar_vane/icar_vane.hpp"

namespace {

using namespace tremie;
using icar_vane::Scene;

constexpr double mu = 35.8, speed = 0.25, omega = 2.0 * std::numbers::pi * speed;

Scene with_ends(double bingham, double cell) {
  Scene scene;
  scene.model.space = SpaceKind::cylindrical;
  scene.model.cell = {cell, cell};
  scene.mix.mu = mu, scene.mix.tau_0 = bingham * mu * omega;
  scene.speed = speed, scene.duration = 2.0;
  return scene;
}

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

void print_icar() {
  fmt::print(
      "| Bingham number | cells mm | torque N m | plane section | end factor | CPU s "
      "|\n|---|---|---|---|---|---|\n");
  for (double bingham : {0.0, 1.0, 10.0, 100.0})
    for (double cell : {0.0133, 0.009, 0.0066}) {
      const double start = seconds();
      const auto r = icar_vane::run(with_ends(bingham, cell)).results;
      fmt::print("| {:g} | {:g} | {:.4f} | {:.4f} | {:.4f} | {:.1f} |\n", bingham, 1e3 * cell, r.torque_end,
                 *r.torque_plane, *r.end_factor, seconds() - start);
    }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  std::ofstream table(std::string(argv[1]) + "/table.csv");
  table << "# Torque of a vane with ends over that of its plane section times the height; four thin blades "
           "on a shaft of\n"
           "# 0.16 radii, gaps below and above as beside it. Made by `ninja -C build/release "
           "study_vane_ends`.\n"
           "height_over_radius,container_over_radius,bingham_number,end_factor\n";
  for (double height : {1.0, 2.0, 4.0})
    for (double container : {1.5, 2.25, 3.0})
      for (double bingham : {0.0, 1.0, 10.0}) {
        Scene scene = with_ends(bingham, 0.0625 / 5.0);
        scene.vane.radius = 0.0625, scene.vane.height = height * 0.0625;
        scene.vane.container_radius = container * 0.0625;
        scene.vane.bottom_gap = scene.vane.cover = scene.vane.container_radius - scene.vane.radius;
        const auto outcome = icar_vane::run(scene);
        if (!outcome.checks.reasons.empty()) fmt::print("{}\n", outcome.checks.reasons.front());
        table << fmt::format("{:g},{:g},{:g},{:.4f}\n", height, container, bingham,
                             *outcome.results.end_factor)
              << std::flush;
      }
  print_icar();
}
