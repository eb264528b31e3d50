// The torque of a fluid of any law between cylinders, by the radial integral: Reiner-Riwlin for Bingham, the closed form
// of a power law.

#include <gtest/gtest.h>

#include <cmath>

#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie {
namespace {

// With a plug (0.01 rad/s) and fully sheared (5 rad/s). The integral's own error is below 1e-8.
TEST(CouetteTorque, IsReinerRiwlinsForBingham) {
  const Instrument icar;
  for (const double omega : {0.01, 0.5, 5.0})
    EXPECT_NEAR(couette_torque(ExactBingham{}, 54.0, 35.8, omega, icar) /
                    reiner_riwlin({54.0, 35.8}, omega, icar).torque,
                1.0, 1e-6);
}

// tau = k gamma_dot^n: omega = n/2 (T/(2 pi h k))^(1/n) (R_i^(-2/n) - R_o^(-2/n)).
TEST(CouetteTorque, OfAPowerLaw) {
  const Instrument icar;
  const double k = 12.0, omega = 1.5;
  for (const double n : {0.2, 0.5, 1.5, 2.0}) {
    const double radii = std::pow(icar.vane_radius, -2.0 / n) - std::pow(icar.container_radius, -2.0 / n);
    const double T = 2.0 * M_PI * icar.vane_height * k * std::pow(2.0 * omega / (n * radii), n);
    EXPECT_NEAR(couette_torque(HerschelBulkley{k, n}, 0.0, 0.0, omega, icar) / T, 1.0, 1e-6) << n;
  }
}

// A container that slides and a Newtonian fluid: omega = T/(4 pi h mu)(R_i^-2 - R_o^-2) + (T/(2 pi h R_o^2) - tau_i)/(k R_o).
// The same for the cylinder with R_i. tau_i beyond the stress holds; k = 0 lets no more through than tau_i.
TEST(CouetteTorque, OfAWallThatSlides) {
  const Instrument in;
  const double mu = 35.8, omega = 1.5, Ri = in.vane_radius, Ro = in.container_radius, h = in.vane_height;
  const double holds = couette_torque(ExactBingham{}, 0.0, mu, omega, in);
  for (const double R : {Ri, Ro}) {
    const SlidingWall wall{R, 10.0, 300.0};
    const double own = (1.0 / (Ri * Ri) - 1.0 / (Ro * Ro)) / (4.0 * M_PI * h * mu),
                 area = 2.0 * M_PI * h * R * R;
    const double T = (omega + wall.tau_i / (wall.k_i * R)) / (own + 1.0 / (area * wall.k_i * R));
    EXPECT_NEAR(couette_torque(ExactBingham{}, 0.0, mu, omega, in, wall) / T, 1.0, 1e-6);
    EXPECT_EQ(couette_torque(ExactBingham{}, 0.0, mu, omega, in, {R, 1e6, 0.0}), holds);
    EXPECT_NEAR(couette_torque(ExactBingham{}, 0.0, mu, omega, in, {R, 5.0, 0.0}) / (area * 5.0), 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace tremie
