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

}  // namespace
}  // namespace tremie
