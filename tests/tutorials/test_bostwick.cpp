// The test of the tutorial docs/tutorials/first_apparatus.md.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "apparatus/bostwick/apparatus.hpp"
#include "apparatus/common/outcome_parts.hpp"
#include "apparatus/registry/registry.hpp"

namespace tremie::bostwick {
namespace {

/// How far from the gate a layer comes to rest (docs/tutorials/first_apparatus.md) [m].
double distance_at_rest(double tau_0, double density) {
  const double l = tau_0 / (density * 9.81), b = 0.5 * std::numbers::pi * l;
  const auto area = [&](double h) { return (h * h * h / 3.0 - b * h * h / 2.0) / l; };
  double low = 2.0 * b, high = 1.0;
  while (high - low > 1e-9) {
    const double h = 0.5 * (low + high);
    (area(h) - area(2.0 * b) < box_length * fill_height ? low : high) = h;
  }
  return (0.5 * low * low - b * low) / l - box_length;
}

// A cell (4 mm) to both sides: a flow counts as at rest below 0.1 mm/s, 1 to 3 mm short of the closed form. Grout of
// 2 Pa.s gets there slowly; thinner grout has momentum, and one of 0.5 Pa.s runs 14 mm beyond it.
TEST(Bostwick, GroutStopsWhereItsYieldStressHoldsIt) {
  for (const double tau_0 : {20.0, 40.0}) {
    const scene::Scene grout = scene::read_text(
        "apparatus = \"bostwick\"\n"
        "mix = {yield_stress = \"20 Pa\", plastic_viscosity = \"2 Pa.s\", density = \"1900 kg/m3\"}\n"
        "model.space = \"plane\"\n",
        "grout.toml", {fmt::format("mix.yield_stress={} Pa", tau_0)});
    const scene::Outcome outcome = scene::run(grout);
    EXPECT_TRUE(outcome.checks.reasons.empty());
    const double distance = std::get<double>(*scene::find_result(outcome, "distance_mm"));
    EXPECT_NEAR(distance, scene::mm * distance_at_rest(tau_0, 1900.0), 4.0);
  }
}

}  // namespace
}  // namespace tremie::bostwick
