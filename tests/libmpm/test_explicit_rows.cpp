// Explicit steps one by one, in a row, and by several threads.

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
    settings.friction_coefficient = 0.3;
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

// Steps that follow each other without a meeting of the threads are the same steps.
TEST(ExplicitSteps, InARowAreThoseOneByOne) {
  constexpr std::int64_t n = 30;
  omp_set_num_threads(2);
  std::vector<Scheme> of_all = schemes;
  of_all.push_back({StressUpdate::first, false, ShapeFunctions::gimp, true, true});
  for (const Scheme& scheme : of_all) {
    ExplicitSettings settings = settings_of(scheme, 1e-4);
    settings.keep_affine = false;
    auto body = collapsing_block(), same = collapsing_block();
    auto state = start_explicit(body, law, settings, shape_of<3>(scheme.shape)),
         others = start_explicit(same, law, settings, shape_of<3>(scheme.shape));
    std::size_t longest = 0;
    for (std::int64_t done = 0; done < n;) {
      const auto row = explicit_steps(body, law, settings, n - done, state);
      longest = std::max(longest, row.size());
      for (const ExplicitReport& one : row) {
        const ExplicitReport other = explicit_step(same, law, settings, others);
        EXPECT_EQ(one.max_speed, other.max_speed);
        EXPECT_EQ(one.shear_rate_mean, other.shear_rate_mean);
        EXPECT_EQ(one.limits.viscous, other.limits.viscous);
        EXPECT_FALSE(one.failed);
      }
      done += std::ssize(row);
      ASSERT_LE(done, n);
    }
    EXPECT_GT(longest, 4U);
    EXPECT_EQ(state.sorts, 1);  // else it may come a few steps later, with other sums
    EXPECT_EQ(body.time, same.time);
    write_back(state, body), write_back(others, same);
    EXPECT_EQ(body.points.x, same.points.x);
    EXPECT_EQ(body.points.v, same.points.v);
    EXPECT_EQ(body.points.ln_J, same.points.ln_J);
    EXPECT_EQ(body.points.lambda, same.points.lambda);
  }
  omp_set_num_threads(1);
}

// Nobody knows how long the next step is, or where a wall will be: then there is one.
TEST(ExplicitSteps, AreOneWhereTheNextIsNotKnown) {
  omp_set_num_threads(1);
  auto body = collapsing_block(), chosen = collapsing_block();
  ExplicitSettings settings;
  auto state_of_chosen = start_explicit(chosen, law, settings, {});
  EXPECT_EQ(explicit_steps(chosen, law, settings, 100, state_of_chosen).size(), 1U);
  settings.fixed_dt = 1e-5;
  EXPECT_EQ(explicit_steps(chosen, law, settings, 100, state_of_chosen).size(), 1U);  // its length was chosen
  auto state = start_explicit(body, law, settings, {});
  EXPECT_EQ(explicit_steps(body, law, settings, 100, state).size(), 1U);  // nor how fast the points are
  EXPECT_GT(explicit_steps(body, law, settings, 100, state).size(), 1U);
  EXPECT_EQ(explicit_steps(body, law, settings, 0, state).size(), 1U);
  const RigidWall<3> wall = [](const Vec<3>&, double) { return std::optional<WallView<3>>(); };
  EXPECT_EQ(explicit_steps(body, law, settings, 100, state, wall).size(), 1U);
}

// Fast points are sorted before they leave what their tile sees, from the first step on.
TEST(ExplicitSteps, AreFewOfFastPoints) {
  omp_set_num_threads(1);
  for (const double cells_a_step : {0.01, 0.1, 0.2}) {
    auto body = collapsing_block();
    const ExplicitSettings settings =
        settings_of({StressUpdate::first, false, ShapeFunctions::gimp, true}, 1e-4);
    for (auto& v : body.points.v) v[0] = cells_a_step * body.grid.axes[0].h / 1e-4;
    auto state = start_explicit(body, law, settings, shape_of<3>(ShapeFunctions::gimp));
    for (int done = 0; done < 8;) {
      const auto row = explicit_steps(body, law, settings, 8 - done, state);
      EXPECT_FALSE(row.back().failed) << cells_a_step;
      EXPECT_LT(state.drift, detail::drift_allowed + cells_a_step);
      done += static_cast<int>(row.size());
    }
  }
}

// What has run away is the last that is reported, whatever was done with it since.
TEST(ExplicitSteps, EndWithTheOneThatFails) {
  omp_set_num_threads(1);
  for (const bool single : {false, true}) {
    auto body = collapsing_block();
    for (auto& v : body.points.v) v[0] = 1e4;
    const ExplicitSettings settings =
        settings_of({StressUpdate::first, false, ShapeFunctions::gimp, true, single}, 1e-4);
    auto state = start_explicit(body, law, settings, shape_of<3>(ShapeFunctions::gimp));
    const auto row = explicit_steps(body, law, settings, 8, state);
    ASSERT_EQ(row.size(), 1U);
    EXPECT_TRUE(row[0].failed);
    EXPECT_EQ(body.time, row[0].dt);
  }
}

}  // namespace
}  // namespace tremie
