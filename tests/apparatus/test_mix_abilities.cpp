// Keys of the mix that some apparatus can compute: taken there, refused with a reason elsewhere.

#include <gtest/gtest.h>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "tests/apparatus/complaint.hpp"

namespace tremie::scene {
namespace {

using test::complaint;
using test::says;

const std::string vane = "apparatus = \"icar_vane\"\nmix = \"mix_a\"\n";
const std::string slump = "apparatus = \"slump_flow\"\nmix = \"mix_a\"\n";

TEST(MixAbilities, TheVaneAveragesOverALayer) {
  const Scene scene = read_text(vane, "a.toml", {"mix.thixotropy.layer=5 mm"});
  EXPECT_DOUBLE_EQ(std::any_cast<const icar_vane::Scene&>(scene.test).mix.thixotropy->layer, 0.005);
  const Scene again = read_text(scene.resolved, "a.toml");
  EXPECT_DOUBLE_EQ(std::any_cast<const icar_vane::Scene&>(again.test).mix.thixotropy->layer, 0.005);
  EXPECT_TRUE(says(complaint(slump, {"mix.thixotropy.layer=5 mm"}), {"mix.thixotropy.layer", "icar_vane"}));
  EXPECT_TRUE(
      says(complaint(vane, {"mix.thixotropy.layer=0 mm"}), {"mix.thixotropy.layer", "greater than 0"}));
}

TEST(MixAbilities, FlowsAreRigidBelowYield) {
  for (const std::string& flow : {vane, slump})
    EXPECT_TRUE(says(complaint(flow, {"mix.shear_modulus=2 kPa"}), {"mix.shear_modulus", "cell", "rigid"}));
}

// Where structure of a rest breaks down by less than the first power of the rate; not without a rest, not by strain.
TEST(MixAbilities, CheckSaysHowWideTheRestedConcreteIsSheared) {
  const auto width = [](const std::vector<std::string>& overrides) {
    return uses(read_text(vane, "a.toml", overrides));
  };
  const auto has = [](const std::vector<std::string>& lines, const std::string& part) {
    for (const std::string& line : lines)
      if (line.find(part) != std::string::npos) return true;
    return false;
  };
  EXPECT_TRUE(has(width({"test.rest=240 s"}), "sheared width of the rested concrete"));
  EXPECT_TRUE(has(width({"test.rest=240 s"}), "mix.thixotropy.layer"));
  EXPECT_TRUE(has(width({"test.rest=240 s", "mix.thixotropy.layer=5 mm"}), "mean shear rate over 5 mm"));
  EXPECT_FALSE(has(width({}), "sheared width"));  // no rest, no structure
  EXPECT_FALSE(has(width({"test.rest=240 s", "mix.thixotropy.kinetics=gated"}), "sheared width"));
}

}  // namespace
}  // namespace tremie::scene
