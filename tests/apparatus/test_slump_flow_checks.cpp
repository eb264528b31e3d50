// What a slump flow is marked for: cells and volumes that cannot be trusted.

#include <gtest/gtest.h>

#include "apparatus/engine.hpp"
#include "apparatus/scene/scene.hpp"

namespace tremie {
namespace {

const std::string thin = R"(apparatus = "slump_flow"
[mix]
yield_stress = "20 Pa"
plastic_viscosity = "35.8 Pa.s"
[test]
duration = "5 s"
lift_speed = "instant"
[output]
frames = false
)";

bool marked_as_thin(const std::vector<std::string>& overrides) {
  const auto outcome = scene::run(scene::read_text(thin, "thin.toml", overrides));
  for (const auto& reason : outcome.checks.reasons)
    if (reason.find("thinner than a cell") != std::string::npos) return true;
  return false;
}

// After 5 s this body is 18 to 30 mm thick, whatever the scheme: one cell of 40 mm cannot shear, three of 10
// mm can.
TEST(SlumpFlowChecks, ABodyThinnerThanACellIsMarked) {
  EXPECT_TRUE(marked_as_thin({"model.cell=40 mm"}));
  EXPECT_TRUE(marked_as_thin({"model.cell=40 mm", "model.scheme=explicit", "model.yield=papanastasiou"}));
  EXPECT_FALSE(marked_as_thin({"model.cell=10 mm"}));
}

// A fill of 300 mm at K = 1 MPa starts 0.43 % compressed: 1.8 % is three times that and half a per cent more.
TEST(SlumpFlowChecks, AVolumeThatTheWeightDoesNotExplainIsMarked) {
  for (const auto& [end, marked] :
       {std::pair{-0.0247, true}, {0.02, true}, {-0.017, false}, {-3e-4, false}}) {
    Checks checks;
    checks.volume_change = end;
    engine::judge_volume(-0.00428, checks);
    EXPECT_EQ(!checks.reasons.empty(), marked) << end;
    checks.reasons.clear();
    checks.max_speed_end = 0.5;  // it may have just hit the floor
    engine::judge_volume(-0.00428, checks);
    EXPECT_TRUE(checks.reasons.empty()) << end;
  }
}

}  // namespace
}  // namespace tremie
