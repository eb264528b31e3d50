// From a slump flow back to the mix: closed forms, and the table against direct runs.

#include <gtest/gtest.h>

#include "apparatus/estimate/closed_forms.hpp"
#include "apparatus/estimate/estimate.hpp"
#include "apparatus/estimate/rheograph.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::estimate {
namespace {

const SlumpTable& table() {
  static const SlumpTable read = read_slump_table(TREMIE_TABLE);
  return read;
}

const double abrams = Mould{}.volume;

/// What a laboratory would measure on a mix, by a run to rest of the default scene with these keys besides.
Measured direct_run(double tau_0, double mu, double density, const std::string& keys = "") {
  const auto scene =
      scene::read_text("apparatus = \"slump_flow\"\n[mix]\nyield_stress = \"" + std::to_string(tau_0) +
                           " Pa\"\nplastic_viscosity = \"" + std::to_string(mu) + " Pa.s\"\ndensity = \"" +
                           std::to_string(density) + " kg/m3\"\n[test]\nduration = \"100000 s\"\n" + keys,
                       "direct");
  const auto outcome = scene::run(scene);
  Measured m;
  m.spread = 1e-3 * std::get<double>(*scene::find_result(outcome, "spread_mm"));
  m.slump = 1e-3 * std::get<double>(*scene::find_result(outcome, "slump_mm"));
  if (const auto* t500 = std::get_if<double>(scene::find_result(outcome, "t500_s"))) m.t500 = *t500;
  m.density = density;
  return m;
}

// Roussel and Coussot's law, V the Abrams cone's: 54, 130 and 366 Pa spread 596, 500 and 406 mm at 2400 kg/m3
// (published to the millimetre, which is 1 % of the yield stress by its fifth power).
TEST(ClosedForms, ThinLayerLawInvertsItsPublishedSpreads) {
  EXPECT_NEAR(thin_layer_yield_stress(0.596, 2400, abrams), 54, 0.6);
  EXPECT_NEAR(thin_layer_yield_stress(0.500, 2400, abrams), 130, 1.3);
  EXPECT_NEAR(thin_layer_yield_stress(0.406, 2400, abrams), 366, 3.7);
}

// h^2/2 - a l h = l (R - r): 557.5 and 445.5 mm for 54 and 130 Pa, computed apart from this program.
TEST(ClosedForms, PlugFormInvertsItsSpreads) {
  EXPECT_NEAR(plug_yield_stress(0.5575, 2400, abrams), 54, 0.5);
  EXPECT_NEAR(plug_yield_stress(0.4455, 2400, abrams), 130, 1.3);
}

// The table states 3 mm and 2 % as one standard error (30 runs: 1.2 mm and 1.8 % root mean square, 4.3 mm and 5.3 % at
// most); three of them are allowed here, for mixes that lie between its nodes and for another density.
TEST(Estimate, TableMeetsDirectRuns) {
  const double mixes[][3] = {{47.0, 26.0, 2400.0}, {95.0, 12.0, 2150.0}, {28.0, 44.0, 2600.0}};
  for (const auto& [tau_0, mu, density] : mixes) {
    const Measured direct = direct_run(tau_0, mu, density);
    const TableReading read = interpolate(table(), tau_0, mu, density);
    EXPECT_NEAR(read.spread, *direct.spread, 3.0 * table_spread_error * read.spread) << tau_0;
    EXPECT_NEAR(read.slump, *direct.slump, 3.0 * table_slump_error * Mould{}.height) << tau_0;
    if (direct.t500 && read.t500) {
      EXPECT_NEAR(*read.t500, *direct.t500, 3.0 * table_t500_error * *direct.t500) << tau_0;
    }
    const MixEstimate e = estimate(table(), direct);
    EXPECT_TRUE(e.reasons.empty()) << (e.reasons.empty() ? "" : e.reasons.front());
    ASSERT_TRUE(e.tau_0);
    EXPECT_LT(e.tau_0->low, tau_0);
    EXPECT_GT(e.tau_0->high, tau_0);
    if (!direct.t500) continue;
    ASSERT_TRUE(e.mu);
    EXPECT_LT(e.mu->low, mu);
    EXPECT_GT(e.mu->high, mu);
    EXPECT_NEAR(e.tau_0->value, tau_0, 0.08 * tau_0);
    EXPECT_NEAR(e.mu->value, mu, 0.08 * mu);
  }
}

// A slump alone: runs of two stiff mixes are met within what the interval says, whatever their viscosity.
TEST(Estimate, SlumpGivesTheYieldStressOfStiffMixes) {
  for (const auto& [tau_0, mu] : {std::pair{520.0, 40.0}, {1050.0, 130.0}}) {
    const Measured direct = direct_run(tau_0, mu, 2400.0);
    Measured m;
    m.slump = direct.slump;
    const MixEstimate e = estimate(table(), m);
    EXPECT_TRUE(e.reasons.empty());
    ASSERT_TRUE(e.tau_0);
    EXPECT_NEAR(e.tau_0->value, tau_0, 0.08 * tau_0);
    EXPECT_LT(e.tau_0->low, tau_0);
    EXPECT_GT(e.tau_0->high, tau_0);
    EXPECT_FALSE(e.mu || e.tau_0_thin_layer);
  }
}

// Each mould's table against a run of its own, by a mix that lies between its nodes: 0.6 % of the spread is what its cells and
// its nodes differ by.
TEST(Estimate, OtherMouldsHaveTablesOfTheirOwn) {
  const std::filesystem::path data = std::filesystem::path(TREMIE_TABLE).parent_path().parent_path();
  const auto at = [&](const char* name) { return find_slump_table(std::vector{data}, name); };
  const auto haegermann = at("haegermann");
  EXPECT_DOUBLE_EQ(haegermann.mould.foot, 0.1);
  const Measured direct = direct_run(
      33.0, 4.0, 2100.0, "[cone]\ntop_radius = \"35 mm\"\nbottom_radius = \"50 mm\"\nheight = \"60 mm\"\n");
  EXPECT_NEAR(interpolate(haegermann, 33.0, 4.0, 2100.0).spread / *direct.spread, 1.0, 0.006);
  EXPECT_THROW(at("marsh"), scene::InputError);
  EXPECT_THROW(check_readings({.spread = 0.09}, haegermann.mould), scene::InputError);  // within the foot
  EXPECT_THROW(check_readings({.slump = 0.06}, haegermann.mould), scene::InputError);   // all of its height
  EXPECT_THROW(check_readings({.spread = 0.2, .t500 = 1.0}, haegermann.mould),
               scene::InputError);  // no such reading
  EXPECT_THROW(check_readings({.spread = 0.3, .t500 = 1.0}, Mould{}),
               scene::InputError);  // never reaches 500 mm
  EXPECT_THROW(check_readings({}, haegermann.mould), scene::InputError);
}

// A stiff mix that is fluid overshoots by its inertia: of a spread without t500 its yield stress is told once the viscosity is
// known. 250 Pa and 6 Pa.s against themselves, by a run on half the cells.
TEST(Estimate, AKnownViscosityNarrowsTheYieldStress) {
  const Measured direct = direct_run(250.0, 6.0, 2400.0, "");
  const Measured alone{.spread = direct.spread, .spread_error = 0.002};
  Measured with = alone;
  with.mu = 6.0;
  const auto wide = estimate(table(), alone), narrow = estimate(table(), with);
  EXPECT_NEAR(narrow.tau_0->value / 250.0, 1.0, 0.05);
  EXPECT_LT(narrow.tau_0->high - narrow.tau_0->low, 0.5 * (wide.tau_0->high - wide.tau_0->low));
  EXPECT_EQ(narrow.mu->value, 6.0);
  with.mu = 5000.0;
  EXPECT_FALSE(estimate(table(), with).reasons.empty());
}

// The interval is the measurement's: a fourth of the error makes it markedly narrower.
TEST(Estimate, IntervalFollowsTheMeasurementsError) {
  Measured m{.spread = 0.555, .t500 = 2.5};
  const auto wide = estimate(table(), m);
  m.spread_error /= 4.0;
  m.t500_error /= 4.0;
  const auto narrow = estimate(table(), m);
  EXPECT_LT(narrow.tau_0->high - narrow.tau_0->low, 0.5 * (wide.tau_0->high - wide.tau_0->low));
}

// A contour's points read back as what the contour says: 2 mm and 2 % are what interpolating along another line than the
// contour's may differ by between nodes.
TEST(Rheograph, ContoursReadBack) {
  const auto at_600 = spread_contour(table(), 0.6), at_3_s = t500_contour(table(), 3.0);
  ASSERT_GT(at_600.size(), 10u);
  ASSERT_GT(at_3_s.size(), 5u);
  for (const auto& [mu, tau_0] : at_600)
    EXPECT_NEAR(interpolate(table(), tau_0, mu, 2400.0).spread, 0.6, 0.002) << mu;
  for (const auto& [mu, tau_0] : at_3_s)
    EXPECT_NEAR(*interpolate(table(), tau_0, mu, 2400.0).t500, 3.0, 0.06);
  // tau_0/rho and mu/rho carry a flow to another density
  const auto lighter = at_density(table(), 1200.0);
  EXPECT_NEAR(spread_contour(lighter, 0.6).front().second, 0.5 * at_600.front().second, 1e-9);
}

TEST(Estimate, OutsideOfTheTableSaysSo) {
  const auto far = estimate(table(), {.spread = 1.2});
  EXPECT_FALSE(far.reasons.empty());
  EXPECT_FALSE(far.tau_0);
  EXPECT_FALSE(estimate(table(), {.spread = 0.45, .t500 = 2.0}).reasons.empty());   // 500 mm was not reached
  EXPECT_FALSE(estimate(table(), {.spread = 0.60, .t500 = 60.0}).reasons.empty());  // too slow for any mix
  EXPECT_FALSE(estimate(table(), {.spread = 0.55, .density = 1000.0}).reasons.empty());
  EXPECT_FALSE(estimate(table(), {.spread = 0.70, .t500 = 19.5})
                   .reasons.empty());  // its best fit is the table's first
}

// The table's entries that do not reach 500 mm have no t500, so that next to them an interval ends where the table does:
// the mix of 80 Pa and 30 Pa.s that spreads 501 mm is not in it.
// A t500 that no mix of the table has puts the best mix on the table's edge: marked, and still inside of its interval.
TEST(Estimate, AnIntervalHoldsItsValue) {
  for (const double t500 : {0.3, 3.0, 300.0}) {
    const MixEstimate e = estimate(table(), {.spread = 0.560, .t500 = t500});
    EXPECT_EQ(e.reasons.empty(), t500 == 3.0) << t500;
    ASSERT_TRUE(e.tau_0 && e.mu);
    for (const Interval& of : {*e.tau_0, *e.mu}) {
      EXPECT_LE(of.low, of.value) << t500;
      EXPECT_GE(of.high, of.value) << t500;
    }
  }
}

TEST(Estimate, ASpreadNextTo500MillimetresSaysThatItsT500IsNoUse) {
  for (const double t500 : {5.0, 9.73})
    EXPECT_FALSE(estimate(table(), {.spread = 0.501, .t500 = t500}).reasons.empty());
  EXPECT_FALSE(estimate(table(), {.spread = 0.51, .t500 = 6.0}).reasons.empty());
  EXPECT_TRUE(estimate(table(), {.spread = 0.501}).reasons.empty());
  EXPECT_TRUE(estimate(table(), {.spread = 0.55, .t500 = 3.0}).reasons.empty());
}

}  // namespace
}  // namespace tremie::estimate
