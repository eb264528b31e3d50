// The same scene gives the same series whatever the number of threads, to 1e-12: sums that threads share are added in a
// fixed order. And twice on two threads the same to the last bit.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "apparatus/registry/registry.hpp"

namespace tremie {
namespace {

std::vector<scene::Column> series_of(const std::string& text, int threads) {
  auto scene = scene::read_text(text, "threads.toml");
  scene::set_threads(scene, threads);
  return scene::run(scene).series;
}

/// Largest difference of two series over the largest value of the column; `compared` counts the values.
double difference(const std::vector<scene::Column>& a, const std::vector<scene::Column>& b,
                  std::size_t& compared) {
  double most = a.size() == b.size() ? 0.0 : 1e300;
  for (std::size_t c = 0; c < std::min(a.size(), b.size()); ++c) {
    if (a[c].values.size() != b[c].values.size()) return 1e300;
    double scale = 0.0;
    for (const double value : a[c].values)
      if (std::isfinite(value)) scale = std::max(scale, std::abs(value));
    for (std::size_t i = 0; i < a[c].values.size(); ++i, ++compared)
      if (std::isfinite(a[c].values[i]) && scale > 0.0)
        most = std::max(most, std::abs(a[c].values[i] - b[c].values[i]) / scale);
  }
  return most;
}

TEST(SomeThreads, GiveTheSameDigits) {
  const std::string body =
      "apparatus = \"slump_flow\"\nmix = \"mix_a\"\ntest = {rest = \"60 s\", duration = \"0.03 s\"}\n";
  const std::string law = "points_per_cell = 2, yield = \"papanastasiou\", regularisation = \"0.2 s\"";
  const std::map<std::string, std::string> scenes{
      {"implicit quarter", body + "model = {space = \"quarter\", cell = \"25 mm\", points_per_cell = 2}"},
      {"half a box",
       "apparatus = \"l_box\"\nmix = \"mix_a\"\ntest = {duration = \"0.03 s\"}\nmodel = {space = \"half\", "
       "cell = "
       "\"33 mm\", points_per_cell = 2}"},
      {"explicit",
       body + "model = {space = \"quarter\", cell = \"25 mm\", scheme = \"explicit\", " + law + "}"},
      {"single sums",
       body +
           "model = {space = \"quarter\", cell = \"25 mm\", scheme = \"explicit_usf\", precision = "
           "\"single\", " +
           law + "}"}};
  for (const auto& [name, text] : scenes) {
    const auto one = series_of(text, 1), two = series_of(text, 2), again = series_of(text, 2),
               four = series_of(text, 4);
    std::size_t compared = 0;
    EXPECT_LE(difference(one, two, compared), 1e-12) << name << ", two threads";
    EXPECT_LE(difference(one, four, compared), 1e-12) << name << ", four threads";
    EXPECT_EQ(difference(two, again, compared), 0.0) << name << ", twice on two";
    EXPECT_GT(compared, 20u) << name;
  }
}

}  // namespace
}  // namespace tremie
