// Verification case 6: a patch of fluid that spreads on a no-slip floor, against Huppert's similarity solution and against
// the lubrication equation of a Bingham fluid (lubrication.hpp).

#include <gtest/gtest.h>

#include "apparatus/verification/references/huppert.hpp"
#include "apparatus/verification/references/slender.hpp"

namespace tremie {
namespace {

using namespace verification;

// The solver used as a reference below must itself follow the similarity solution...
TEST(Lubrication, FollowsHuppert) {
  const Fluid fluid{2400.0, 9.81, 0.0, 200.0};
  const double V = 5e-3, nu = fluid.mu / fluid.rho, start = 10.0;
  Layer layer{1e-3, std::vector<double>(600)};
  const double R = huppert_radius(V, nu, fluid.g, start);
  for (std::size_t i = 0; i < layer.h.size(); ++i)
    layer.h[i] = huppert_depth(V, R, layer.radius(i) + 0.5 * layer.dr);
  const double volume = layer.volume();
  spread_layer(fluid, 90.0, layer);
  EXPECT_NEAR(layer.volume() / volume, 1.0, 1e-12);
  EXPECT_NEAR(layer.front() / huppert_radius(V, nu, fluid.g, 100.0), 1.0, 0.01);
}

// ...and the published curve for tau_0 = 10 Pa from a cone that is gone at once. 3 %: in which layers the published run cuts the cone
// is not stated.
TEST(Lubrication, PublishedCurve) {
  const Fluid fluid{2400.0, 9.81, 10.0, 35.8};
  Layer layer{2e-3, std::vector<double>(220, 0.0)};
  for (std::size_t i = 0; i < 50; ++i) {
    const double r = layer.radius(i) + 0.5 * layer.dr;
    layer.h[i] = r < 0.05 ? 0.3 : 0.3 * (0.1 - r) / 0.05;
  }
  for (double& h : layer.h) h *= cone_volume() / layer.volume();
  double time = 0.0;
  for (const auto& [t, mm] : published_slender) {
    spread_layer(fluid, t - time, layer);
    time = t;
    std::printf("lubrication from the cone: %3d s: %.0f mm (published %d)\n", t, 2e3 * layer.front(), mm);
    EXPECT_NEAR(2e3 * layer.front() / mm, 1.0, 0.03);
  }
}

// Rest radii: published 557.5 and 445.5 mm with the plug's normal stress, 596 and 500 without it (0.2 %:
// rounding).
TEST(Lubrication, RestRadii) {
  for (const auto& [tau_0, with, without] : {std::tuple{54.0, 557.5, 596.0}, {130.0, 445.5, 500.0}}) {
    const Fluid fluid{2400.0, 9.81, tau_0, 35.8};
    EXPECT_NEAR(2e3 * rest_radius(fluid, cone_volume(), plug_normal_stress), with, 0.002 * with);
    EXPECT_NEAR(2e3 * rest_radius(fluid, cone_volume(), 0.0), without, 0.002 * without);
  }
}

// Exponent and prefactor of Huppert's solution within 3 % each, over a decade of time.
TEST(Spreading, HuppertOverADecade) {
  const HuppertFit fit = huppert_decade(0.005, 0.0025);
  std::printf("Huppert: exponent %.4f, prefactor %.4f (0.894), worst radius %.2f %%, %d steps\n",
              fit.exponent, fit.prefactor, 100 * fit.worst, fit.steps);
  EXPECT_EQ(fit.unconverged, 0);
  EXPECT_NEAR(fit.volume_error, 0.0, 0.01);
  EXPECT_NEAR(fit.exponent * 8.0, 1.0, 0.03);
  EXPECT_NEAR(fit.prefactor / huppert_prefactor, 1.0, 0.03);
  EXPECT_LE(fit.worst, 0.03);
}

}  // namespace
}  // namespace tremie
