// One material cell at a prescribed shear rate, against the laws in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "rheometer/cell/material_cell.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie {
namespace {

Mix mix_a(bool thixotropic = true) {
  Mix mix;
  mix.tau_0 = 54.0;
  mix.mu = 35.8;
  if (thixotropic) mix.thixotropy = Thixotropy{1.3, GatedKinetics{0.01}};
  return mix;
}

// Exact Bingham in simple shear, an independent computation: 0.5, 1, 5, 12.43 1/s gives 71.9, 89.8, 233,
// 498.994 Pa.
TEST(MaterialCell, GivesBinghamStressInSimpleShear) {
  const double rate[] = {0.5, 1.0, 5.0, 12.43}, stress[] = {71.9, 89.8, 233.0, 498.994};
  for (int i = 0; i < 4; ++i) {
    const CellResult r = run_cell({mix_a(false), 0.0, {{1.0, rate[i], rate[i]}}, {}}, ExactBingham{});
    EXPECT_NEAR(*r.samples.back().shear_stress, stress[i], 1e-10);
    EXPECT_FALSE(r.samples.back().flocculation.has_value());
  }
}

// Papanastasiou, equation (33): mu g + tau_0 (1 - e^(-m g)); bi-viscous below gamma_c: (mu + tau_0/gamma_c)
// g.
TEST(MaterialCell, GivesTheRegularisedStresses) {
  const double g = 0.05;
  const CellResult p = run_cell({mix_a(false), 0.0, {{1.0, g, g}}, {}}, Papanastasiou{5.0});
  EXPECT_NEAR(*p.samples.back().shear_stress, 35.8 * g + 54.0 * (1.0 - std::exp(-5.0 * g)), 1e-12);
  const CellResult b = run_cell({mix_a(false), 0.0, {{1.0, g, g}}, {}}, BiViscous{0.1});
  EXPECT_NEAR(*b.samples.back().shear_stress, (35.8 + 54.0 / 0.1) * g, 1e-12);
}

// 240 s of rest: lambda = 1.3 * 240/54, so the first stress in shear is 54 + 312 + mu g = 366 Pa + mu g.
TEST(MaterialCell, StartsWithTheStaticYieldStressAfterARest) {
  const CellResult r = run_cell({mix_a(), 240.0, {{10.0, 1.0, 1.0}}, {}}, ExactBingham{});
  EXPECT_NEAR(*r.samples.front().shear_stress, 366.0 + 35.8, 1e-9);
  EXPECT_NEAR(*r.samples.back().flocculation, 1.3 * 240.0 / 54.0 * std::exp(-0.1), 1e-12);
}

// Gated and under linear rates the update is exact, so it meets CVODE to the reference's own error.
TEST(MaterialCell, MeetsItsReference) {
  const std::vector<ShearSegment> loop{{100.0, 0.0, 0.0}, {20.0, 0.0, 10.0}, {20.0, 10.0, 0.0}};
  const CellResult r = run_cell({mix_a(), 0.0, loop, {}}, ExactBingham{});
  ASSERT_TRUE(r.flocculation_error_max);
  EXPECT_LT(*r.flocculation_error_max, 1e-10);
  EXPECT_GE(r.samples.size(), 2000u);
}

// Without thixotropy up and down coincide: no loop. With it, and lambda broken down at high rate between the
// branches, the area is int (lambda_up - lambda_down) tau_0 d gamma: with lambda = 1 on the way up (alpha =
// 0) and 0 on the way down there would be 54 * 10; here the closed form is that of a ramp, a hold and a ramp.
TEST(MaterialCell, TheHysteresisAreaIsThatBetweenTheBranches) {
  const std::vector<ShearSegment> loop{{10.0, 0.0, 10.0}, {10.0, 10.0, 0.0}};
  const CellResult none = run_cell({mix_a(false), 0.0, loop, {}}, ExactBingham{});
  EXPECT_NEAR(*none.hysteresis_area, 0.0, 1e-9);

  Mix mix = mix_a();
  mix.thixotropy = Thixotropy{0.0, RousselKinetics{0.02}, 1.0};
  const CellResult r = run_cell({mix, 0.0, loop, 1e-3}, ExactBingham{});
  // up: lambda = e^(-a g^2/2) at g = t; down: lambda = e^(-a (100 - g^2/2)), a = 0.02
  double area = 0.0;
  const int n = 20000;
  for (int i = 0; i < n; ++i) {
    const double g = 10.0 * (i + 0.5) / n;
    area += 54.0 * (std::exp(-0.01 * g * g) - std::exp(-0.02 * (100.0 - 0.5 * g * g))) * 10.0 / n;
  }
  EXPECT_NEAR(*r.hysteresis_area / area, 1.0, 1e-6);
}

TEST(MaterialCell, LeavesOpenWhatDoesNotApply) {
  const CellResult rest = run_cell({mix_a(), 0.0, {{10.0, 0.0, 0.0}}, {}}, ExactBingham{});
  EXPECT_FALSE(rest.samples.back().shear_stress.has_value());
  EXPECT_FALSE(rest.hysteresis_area.has_value());
  const CellResult regularised = run_cell({mix_a(), 0.0, {{10.0, 0.0, 0.0}}, {}}, Papanastasiou{5.0});
  EXPECT_EQ(*regularised.samples.back().shear_stress, 0.0);
  const CellResult open = run_cell({mix_a(), 0.0, {{10.0, 0.0, 5.0}}, {}}, ExactBingham{});
  EXPECT_FALSE(open.hysteresis_area.has_value());
}

TEST(MaterialCell, ReadsAHistoryFromCsv) {
  const auto s = parse_shear_history("time_s,shear_rate_per_s\n0,0\n100,0\n100,5\n110,10\n", "h.csv");
  ASSERT_EQ(s.size(), 2u);
  EXPECT_EQ(s[0].duration, 100.0);
  EXPECT_EQ(s[1].from, 5.0);
  EXPECT_EQ(s[1].to, 10.0);
  for (const char* text : {"", "time_s,shear_rate_per_s\n", "time_s,shear_rate_per_s\n0,1\n",
                           "time_s,shear_rate_per_s\n0,1\n1,-1\n", "time_s,shear_rate_per_s\n1,1\n0,1\n",
                           "time_s,shear_rate_per_s\n1,1\n1,2\n",
                           "time_s,shear_rate_per_s\n0,1\n1,nan\n2,1\n", "time_s,torque_N_m\n0,1\n1,1\n"})
    EXPECT_THROW(parse_shear_history(text, "h.csv"), RecordError) << text;
}

TEST(MaterialCell, RefusesWhatHasNoMeaning) {
  EXPECT_THROW(run_cell({mix_a(), 0.0, {}, {}}, ExactBingham{}), std::invalid_argument);
  EXPECT_THROW(run_cell({mix_a(), 0.0, {{1.0, -1.0, 0.0}}, {}}, ExactBingham{}), std::invalid_argument);
  EXPECT_THROW(run_cell({mix_a(), 0.0, {{1.0, 1.0, 1.0}}, 1e-9}, ExactBingham{}), std::invalid_argument);
}

}  // namespace
}  // namespace tremie
