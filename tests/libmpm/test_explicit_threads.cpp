// Explicit steps by several threads, and of fast points.

#include <gtest/gtest.h>
#include <omp.h>

#include "tests/libmpm/explicit_schemes.hpp"

namespace tremie {
namespace {

using namespace test;

// The same bits with one and three threads, while the points are sorted again several times.
TEST(ExplicitThreads, SameBits) {
  const Scheme of_splines{StressUpdate::last, false, ShapeFunctions::b_spline, true},
      of_flip{StressUpdate::first, true, ShapeFunctions::gimp, true},
      of_singles{StressUpdate::first, false, ShapeFunctions::gimp, true, true};
  for (const Scheme& scheme : {of_splines, of_flip, of_singles}) {
    ExplicitSettings settings = settings_of(scheme, 1e-3);
    settings.wall_law = Coulomb{0.3};
    Points<3> first;
    for (const int threads : {1, 3}) {
      omp_set_num_threads(threads);
      settings.keep_affine = threads == 1;  // which no step reads
      auto body = collapsing_block();
      auto state = start_explicit(body, law, settings, shape_of<3>(scheme.shape));
      for (int i = 0; i < 100; ++i) explicit_step(body, law, settings, state);
      write_back(state, body);
      EXPECT_GT(state.sorts, 2);
      EXPECT_EQ(body.points.C.empty(), scheme.flip || !settings.keep_affine);
      if (threads == 1) first = body.points;
      for (std::size_t p = 0; p < first.size(); ++p) {
        ASSERT_EQ(body.points.x[p], first.x[p]);
        ASSERT_EQ(body.points.v[p], first.v[p]);
        ASSERT_EQ(body.points.ln_J[p], first.ln_J[p]);
        ASSERT_EQ(body.points.lambda[p], first.lambda[p]);
      }
    }
  }
  omp_set_num_threads(1);
}

// Fast points are sorted before they leave what their tile sees, from the first step on.
TEST(ExplicitSteps, SortFastPointsInTime) {
  omp_set_num_threads(1);
  for (const double cells_a_step : {0.01, 0.1, 0.2}) {
    auto body = collapsing_block();
    const ExplicitSettings settings =
        settings_of({StressUpdate::first, false, ShapeFunctions::gimp, true}, 1e-4);
    for (auto& v : body.points.v) v[0] = cells_a_step * body.grid.axes[0].h / 1e-4;
    auto state = start_explicit(body, law, settings, shape_of<3>(ShapeFunctions::gimp));
    for (int i = 0; i < 8; ++i) {
      EXPECT_FALSE(explicit_step(body, law, settings, state).failed) << cells_a_step;
      EXPECT_LT(state.drift, detail::drift_allowed(settings) + cells_a_step);
    }
  }
}

// A point that moves more than half a cell in a step has run away.
TEST(ExplicitSteps, FailWherePointsRunAway) {
  omp_set_num_threads(1);
  for (const bool single : {false, true}) {
    auto body = collapsing_block();
    for (auto& v : body.points.v) v[0] = 1e4;
    const ExplicitSettings settings =
        settings_of({StressUpdate::first, false, ShapeFunctions::gimp, true, single}, 1e-4);
    auto state = start_explicit(body, law, settings, shape_of<3>(ShapeFunctions::gimp));
    const ExplicitReport step = explicit_step(body, law, settings, state);
    EXPECT_TRUE(step.failed);
    EXPECT_EQ(body.time, step.dt);
  }
}

}  // namespace
}  // namespace tremie
