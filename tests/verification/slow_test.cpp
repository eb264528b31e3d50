// Rung 6, the long runs: the slender case on fine cells and Mix A to its rest.

#include "apparatus/slump_flow/slump_flow.hpp"
#include "tests/verification/slender_expectations.hpp"

namespace tremie {
namespace {

TEST(Slow, SlenderOnFineCells) {
  verification::expect_slender_flow_follows_the_lubrication_equation(0.005, 0.0025);
}

// Mix A creeps on to about 200 s: then it stands at the balance with the plug's normal stress, 557.5 mm
// within 1.5 %.
TEST(Slow, MixAComesToRest) {
  slump_flow::Scene scene;
  scene.mix.tau_0 = 54.0;
  scene.mix.mu = 35.8;
  scene.lift_speed.reset();
  scene.duration = 300.0;
  const slump_flow::Outcome outcome = slump_flow::run(scene);
  for (const auto& s : outcome.series)
    if (&s == &outcome.series.back() || std::floor(s.time / 20.0) < std::floor((&s)[1].time / 20.0))
      std::printf("Mix A %.0f s: %.1f mm, %.2g m/s\n", s.time, 1e3 * s.spread, s.max_speed);
  EXPECT_EQ(outcome.checks.unconverged_steps, 0);
  EXPECT_TRUE(outcome.results.stopped_at.has_value());
  EXPECT_NEAR(1e3 * outcome.results.spread / 557.5, 1.0, 0.015);
}

}  // namespace
}  // namespace tremie
