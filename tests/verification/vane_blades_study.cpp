// The torque of a vane's section with four blades over that of its cylinder: writes table.csv, which `tremie fit --blades
// computed` reads, into the folder given. By finite elements, which share nothing with the material points.

#include <fmt/format.h>

#include <fstream>
#include <numbers>
#include <stdexcept>

#include "apparatus/verification/references/vane_finite_elements.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

int main(int argc, char** argv) {
  using namespace tremie;
  if (argc != 2) return 2;
  constexpr double mu = 35.8, omega = 0.5 * std::numbers::pi, radius = 0.0635;
  std::ofstream table(std::string(argv[1]) + "/table.csv");
  table << "# Torque of a vane's section with four blades, 3/63.5 radii thick on a shaft of 10/63.5 radii, "
           "over that of "
           "its cylinder\n# (Reiner and Riwlin), by finite elements with 16 elements from shaft to tip. Made "
           "by `ninja "
           "-C build/release\n# study_vane_blades`.\ncontainer_over_radius,bingham_number,blade_factor\n";
  for (const double container : {1.25, 1.5, 2.0, 3.0, 5.0})
    for (const double bingham : {0.0, 0.1, 0.3, 1.0, 3.0, 6.0, 10.0, 20.0, 40.0}) {
      const double tau_0 = bingham * mu * omega;
      try {
        const double blades =
            verification::finite_element_torque({.tau_0 = tau_0,
                                                 .mu = mu,
                                                 .omega = omega,
                                                 .radius = radius,
                                                 .container_radius = container * radius,
                                                 .shaft_radius = 0.010,
                                                 .thickness = 0.003,
                                                 .height = 2.0 * radius,
                                                 .regularisation = bingham > 3.0 ? 4e-2 : 1e-2});
        const double cylinder =
            reiner_riwlin({.tau_0 = tau_0, .mu = mu}, omega, {radius, 2.0 * radius, container * radius})
                .torque;
        table << fmt::format("{:g},{:g},{:.4f}\n", container, bingham, blades / cylinder) << std::flush;
      } catch (const std::runtime_error& error) {
        fmt::print("{:g} radii, Bi = {:g}: {}\n", container, bingham, error.what());
      }
    }
}
