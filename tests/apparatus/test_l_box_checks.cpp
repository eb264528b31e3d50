// What an L-box is marked for: cells that do not resolve its concrete.

#include <gtest/gtest.h>

#include "apparatus/registry/registry.hpp"

namespace tremie {
namespace {

const std::string plane = R"(apparatus = "l_box"
[mix]
yield_stress = "50 Pa"
plastic_viscosity = "30 Pa.s"
[test]
duration = "20 s"
[output]
frames = false
)";

std::vector<std::string> reasons(const std::string& cell, const std::string& duration = "20 s") {
  return scene::run(
             scene::read_text(plane, "plane.toml", {"model.cell=" + cell, "test.duration=" + duration}))
      .checks.reasons;
}

// The concrete stands 82 mm deep behind the gate: four cells of 20 mm, whose ratio is 2 % off, 1.6 cells of
// 50 mm, whose ratio is 1.02 where 0.75 is right. On cells of 50 mm along the channel it never reaches the
// end.
TEST(LBoxChecks, CellsThatDoNotResolveTheDepthAreMarked) {
  EXPECT_TRUE(reasons("20 mm").empty());
  for (const char* cell : {"50 mm", "100 mm", "[\"50 mm\", \"20 mm\"]", "[\"20 mm\", \"50 mm\"]"})
    EXPECT_EQ(reasons(cell).size(), 1u) << cell;
}

// While the column is high nothing is thin.
TEST(LBoxChecks, AHighColumnIsNotThin) { EXPECT_TRUE(reasons("25 mm", "0.3 s").empty()); }

}  // namespace
}  // namespace tremie
