// The error bar of a result from three grids.

#include <gtest/gtest.h>

#include <cmath>

#include "apparatus/parts/cone/cone_test.hpp"
#include "apparatus/registry/error_estimate.hpp"

namespace tremie::scene {
namespace {

// f(h) = 100 + c h^p is what Richardson assumes: the order comes back, and the bar is 1.25 times the true
// error c h^p of the finest grid, for orders up to the first.
TEST(Extrapolation, FindsTheOrderAndTheErrorOfAPowerLaw) {
  for (const double p : {0.6, 0.8, 1.0})
    for (const double c : {3.0, -0.7}) {
      const auto f = [&](double h) { return 100.0 + c * std::pow(h, p); };
      const Extrapolation e = extrapolate(f(1.0), f(1.5), f(2.0));
      EXPECT_TRUE(e.richardson);
      EXPECT_NEAR(e.order, p, 1e-6);
      EXPECT_NEAR(e.error, 1.25 * std::abs(c), 1e-6 * std::abs(c));
    }
}

// An order above the first is not trusted: the bar is that of the first order, wider than the error.
TEST(Extrapolation, TrustsNoOrderAboveTheFirst) {
  const auto f = [](double h) { return 100.0 + std::pow(h, 3.5); };
  const Extrapolation e = extrapolate(f(1.0), f(1.5), f(2.0));
  EXPECT_TRUE(e.richardson);
  EXPECT_NEAR(e.error, 1.25 * (f(1.5) - f(1.0)) / 0.5, 1e-12);
  EXPECT_GT(e.error, 1.0);
}

// The same error over other grids: the order does not depend on how far apart they lie.
TEST(Extrapolation, KnowsHowFarApartTheGridsLie) {
  const auto f = [](double h) { return 100.0 + 0.5 * std::pow(h, 0.8); };
  const Extrapolation e = extrapolate(f(1.0), f(2.0), f(3.0), {2.0, 3.0});
  EXPECT_NEAR(e.order, 0.8, 1e-6);
  EXPECT_NEAR(e.error, 1.25 * 0.5, 1e-6);
}

// Grids that scatter show no order: 1.25 times their spread.
TEST(Extrapolation, TakesTheSpreadWhereNoOrderIsSeen) {
  const Extrapolation e = extrapolate(553.0, 550.0, 556.0);
  EXPECT_FALSE(e.richardson);
  EXPECT_DOUBLE_EQ(e.error, 1.25 * 6.0);
}

// Three equal readings are no proof of an exact one: a thousandth stays.
TEST(Extrapolation, IsNeverNothing) { EXPECT_DOUBLE_EQ(extrapolate(500.0, 500.0, 500.0).error, 0.5); }

// 431, 432 and 300 mm: the coarsest grid misses what the others see. A finer one, 433 mm, takes its place: 1.25 times the
// spread of 433, 431 and 432.
TEST(Extrapolation, DoubtsACoarseGridThatStandsAlone) {
  EXPECT_TRUE(is_doubtful(extrapolate(431.0, 432.0, 300.0), 431.0));
  EXPECT_FALSE(is_doubtful(extrapolate(431.0, 432.0, 425.0), 431.0));
  EXPECT_DOUBLE_EQ(extrapolate_with_finer(433.0, 431.0, 432.0).error, 1.25 * 2.0);
}

// A power law over h/1.5, h and 1.5 h: the bar about the value on h holds all of its error.
TEST(Extrapolation, StandsAboutTheScenesOwnGrid) {
  const auto f = [](double h) { return 100.0 - 3.0 * std::pow(h, 0.8); };
  const Extrapolation e = extrapolate_with_finer(f(1.0 / 1.5), f(1.0), f(1.5));
  EXPECT_TRUE(e.richardson);
  EXPECT_NEAR(e.order, 0.8, 1e-6);
  EXPECT_GE(e.error, 3.0);
  EXPECT_LE(e.error, 1.25 * 3.0);
}

Scene coarse_slump() {
  return read_text(
      "apparatus = \"slump_flow\"\nmix = \"mix_c\"\n[test]\nduration = \"0.2 s\"\nlift_speed = \"instant\"\n"
      "[model]\ncell = [\"20 mm\", \"10 mm\"]\npoints_per_cell = 2\n",
      "coarse");
}

TEST(ErrorEstimate, CoarsensCellsAndFixedSteps) {
  Scene scene = coarse_slump();
  model_of(scene).time_step = 1e-3;
  const Scene coarser = coarsened(scene, 1.5);
  const Model& model = std::any_cast<const cone::Scene&>(coarser.test).model;
  EXPECT_DOUBLE_EQ(model.cell[0], 0.03);
  EXPECT_DOUBLE_EQ(model.cell[1], 0.015);
  EXPECT_DOUBLE_EQ(model.time_step.value(), 1.5e-3);
  EXPECT_EQ(cells_override(scene, 0.5), "model.cell=[\"10 mm\", \"5 mm\"]");
}

// Every headline number that the three runs have gets a bar; t500 is never reached here and gets none.
TEST(ErrorEstimate, GivesEveryHeadlineItsBar) {
  const Scene scene = coarse_slump();
  const Outcome outcome = run(scene);
  const ErrorEstimate estimate = estimate_error(scene, outcome);
  ASSERT_EQ(estimate.bars.size(), 2u) << estimate.basis;
  EXPECT_EQ(estimate.bars[0].name, "spread_mm");
  EXPECT_EQ(estimate.bars[1].name, "height_mm");
  EXPECT_GT(estimate.bars[0].error, 0.0);
  EXPECT_FALSE(estimate.basis.empty());
}

TEST(ErrorEstimate, SaysWhyThereIsNone) {
  Outcome outcome;
  outcome.status = Status::interrupted;
  const ErrorEstimate estimate = estimate_error(coarse_slump(), outcome);
  EXPECT_TRUE(estimate.bars.empty());
  EXPECT_TRUE(estimate.basis.starts_with("none: "));
}

}  // namespace
}  // namespace tremie::scene
