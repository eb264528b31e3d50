// What a slump flow by explicit steps costs in memory, frames included.

#include <gtest/gtest.h>

#include <cstdio>

#include "apparatus/registry/registry.hpp"
#include "tests/peak_memory.hpp"

namespace tremie {
namespace {

const std::string cone = R"(apparatus = "slump_flow"
mix = "mix_a"
[model]
space = "full"
scheme = "explicit"
yield = "papanastasiou"
[test]
duration = "0.0003 s"
lift_speed = "instant"
)";

/// Whether the cone ran, and gave its frames.
bool runs(const char* cell) {
  std::size_t frames = 0;
  scene::Observer observer;
  observer.on_frame = [&](const Frame& frame) {
    frames += frame.position.size() == frame.shear_rate.size() ? 1 : 0;
  };
  const auto outcome =
      scene::run(scene::read_text(cone, "cone.toml", {std::string("model.cell=") + cell}), observer);
  return outcome.status == Status::completed && frames == 2;
}

/// Points of the cone on such cells.
double points_of(const char* cell) {
  const auto scene = scene::read_text(cone, "cone.toml", {std::string("model.cell=") + cell});
  return static_cast<double>(scene::estimate(scene)->points);
}

// From 43,976 to 203,652 points of Mix A the peak grows by what a point costs, all told: its state sorted
// (92 bytes), what a reading has of it (88), tiles, what a frame has more. It is 260; a tenth is for chance.
TEST(ExplicitMemory, BytesAPointOfALargeBody) {
  if (!test::memory_can_be_measured) GTEST_SKIP() << "the sanitizer's own memory is most of it";
  const double small = test::peak_memory_of([] { return runs("10 mm"); }),
               large = test::peak_memory_of([] { return runs("6 mm"); });
  ASSERT_GT(small, 0.0);
  ASSERT_GT(large, 0.0);
  const double bytes = (large - small) / (points_of("6 mm") - points_of("10 mm"));
  std::printf("%.0f bytes a point\n", bytes);
  EXPECT_LE(bytes, 290.0);
}

}  // namespace
}  // namespace tremie
