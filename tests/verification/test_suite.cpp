// What `tremie verify` is made of: orders, bounds, and a judge that cannot be fooled by a run that looks
// well.

#include <gtest/gtest.h>

#include <cmath>

#include "apparatus/verification/case.hpp"
#include "apparatus/verification/document.hpp"
#include "apparatus/verification/extremes.hpp"

namespace tremie::verification {
namespace {

TEST(Verification, FindsTheOrderOfAPowerLaw) {
  Series series{"", {}};
  for (double h : {8.0, 4.0, 2.0, 1.0}) series.runs.push_back({"", h, 0.3 * std::pow(h, 1.7), 0.0});
  EXPECT_NEAR(observed_order(series), 1.7, 1e-12);
  series.runs.resize(1);
  EXPECT_TRUE(std::isnan(observed_order(series)));
}

TEST(Verification, NamesTheBoundsThatAreBroken) {
  Problem one;
  one.name = "film";
  one.bounds = {{.what = "order", .value = 1.4, .limit = 1.5, .at_least = true},
                {.what = "error", .value = 1e-4, .limit = 1e-3},
                {.what = "not a number", .value = std::nan(""), .limit = 1.0}};
  const std::vector<Case> cases{{4, "Film", {one}}};
  EXPECT_FALSE(all_kept(cases));
  const auto lines = broken_bounds(cases);
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "case 4, film: order 1.4, at least 1.5 wanted");
}

Extreme quick_cell(std::function<std::string(const scene::Outcome&)> against) {
  return {.family = "cell",
          .name = "a cell",
          .scene =
              "apparatus = \"cell\"\n[mix]\nyield_stress = \"54 Pa\"\nplastic_viscosity = \"35.8 Pa.s\"\n"
              "[[history]]\nduration = \"1 s\"\nfrom = \"1 1/s\"\nto = \"2 1/s\"\n",
          .overrides = {},
          .against = std::move(against)};
}

TEST(Extremes, ARunAgainstPhysicsIsSilentlyWrong) {
  EXPECT_EQ(judge(quick_cell([](const auto&) { return std::string(); }), 1.0).ending, Ending::right);
  const Verdict wrong = judge(quick_cell([](const auto&) { return std::string("energy grows"); }), 1.0);
  EXPECT_EQ(wrong.ending, Ending::silent_wrong);
  EXPECT_EQ(wrong.why, "energy grows");
}

TEST(Extremes, ASceneWithoutMeaningIsRefused) {
  Extreme extreme = quick_cell([](const auto&) { return std::string(); });
  extreme.overrides = {"mix.yield_stress=-1 Pa"};
  EXPECT_EQ(judge(extreme, 1.0).ending, Ending::no_meaning);
}

// A spread that grows with the yield stress is wrong, wherever in the list its scene stands.
TEST(Extremes, AReadingMustNotGrowAlongItsRank) {
  std::vector<Extreme> cases(3);
  std::vector<Verdict> verdicts(3);
  for (std::size_t i = 0; i < 3; ++i) cases[i].monotone_key = "a", cases[i].reading = "spread_mm";
  cases[0].rank = 54.0, verdicts[0].reading = 600.0;
  cases[1].rank = 1.0, verdicts[1].reading = 700.0;
  cases[2].rank = 130.0, verdicts[2].reading = 650.0;
  judge_monotony(cases, verdicts);
  EXPECT_EQ(verdicts[0].ending, Ending::right);
  EXPECT_EQ(verdicts[1].ending, Ending::right);
  EXPECT_EQ(verdicts[2].ending, Ending::silent_wrong);
}

// The matrix covers what a user may throw at it: at least 200 scenes of the slump, the vane and the cell.
TEST(Extremes, AreAtLeastTwoHundred) {
  const auto all = extremes();
  EXPECT_GE(all.size(), 200u);
  for (const char* apparatus : {"slump", "vane", "cell"})
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Extreme& e) { return e.family.starts_with(apparatus); }));
}

}  // namespace
}  // namespace tremie::verification
