// Moulds by name, what follows from a mould's size, and the readings that belong to one mould alone.

#include <gtest/gtest.h>

#include "apparatus/parts/cone/readings.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/load.hpp"

namespace tremie {
namespace {

const std::string mini = R"(apparatus = "slump_flow"
cone = "haegermann"
[mix]
yield_stress = "300 Pa"
plastic_viscosity = "2 Pa.s"
[test]
duration = "10 s"
[output]
frames = false
)";

cone::Scene scene_of(const std::vector<std::string>& overrides = {}) {
  return std::any_cast<const cone::Scene&>(scene::read_text(mini, "mini.toml", overrides).test);
}

scene::Outcome outcome_of(const std::vector<std::string>& overrides) {
  return scene::run(scene::read_text(mini, "mini.toml", overrides));
}

// EN 1015-3 gives diameters of 70 and 100 mm and a height of 60 mm.
TEST(Moulds, ANameStandsForAFile) {
  const cone::Cone haegermann = scene_of().cone;
  EXPECT_EQ(haegermann.top_radius, 0.035);
  EXPECT_EQ(haegermann.bottom_radius, 0.05);
  EXPECT_EQ(haegermann.height, 0.06);
  EXPECT_EQ(scene_of({"cone=vicat", "cone.height=50 mm"}).cone.height, 0.05);
  EXPECT_EQ(scene_of({"cone=vicat"}).cone.top_radius, 0.03);
  for (const std::string& name : scene::names_in("cones"))
    EXPECT_GT(cone::volume(scene_of({"cone=" + name}).cone), 0.0) << name;
  try {
    scene_of({"cone=hagerman"});
    FAIL();
  } catch (const scene::InputError& error) {
    const std::string message = error.what();
    for (const char* part : {"cone: there is no cone \"hagerman\"", "haegermann", "table [cone]"})
      EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

// A cone of half the size has an eighth of the volume, and cells of half the size.
TEST(Moulds, CellsAreAsLargeToAnyMould) {
  const auto full = scene_of({"cone=abrams"}).model.cell, half = scene_of({"cone=half_abrams"}).model.cell;
  EXPECT_EQ(full, (std::array{0.01, 0.005}));
  EXPECT_DOUBLE_EQ(half[0], 0.005);
  EXPECT_DOUBLE_EQ(half[1], 0.0025);
  EXPECT_EQ(scene_of({"model.cell=8 mm"}).model.cell, (std::array{0.008, 0.008}));
  EXPECT_NEAR(scene_of({"model.space=quarter", "cone=half_abrams"}).model.cell[0], 0.007, 1e-12);
}

// 8 Pa spread to some 840 mm, 9.9 mm thick on average: half of the default 5 mm a cell, so that the film has four rows. On
// cells of a quarter that height, half as wide, it ended at 845 mm, on those of 5 mm 19 mm short of that.
TEST(Moulds, CellsAreFlatForWhatWillBeAThinFilm) {
  const std::vector<std::string> film{"cone=abrams", "mix.yield_stress=8 Pa"};
  const auto cell = scene_of(film).model.cell;
  EXPECT_EQ(cell[0], 0.01);
  EXPECT_NEAR(cell[1], 0.0023, 0.00025);
  EXPECT_EQ(
      scene_of({"cone=abrams", "mix.yield_stress=8 Pa", "model.cell=[\"10 mm\", \"5 mm\"]"}).model.cell[1],
      0.005);
  EXPECT_EQ(scene_of({"cone=abrams", "mix.yield_stress=0 Pa"}).model.cell[1],
            0.005);  // no rest, no depth at rest
  const auto thinner = scene_of({"cone=haegermann", "mix.yield_stress=3 Pa"}).model.cell;
  EXPECT_LT(thinner[1], 0.3 * thinner[0]);
}

// Froude's similarity: lengths by 1/2, times by 1/sqrt 2, stresses by 1/2, viscosities by 1/2^1.5, a bulk modulus by 1/2.
// Steps of a largest length and a speed of rest that do not scale leave a few tenths of a per cent.
TEST(Moulds, AHalfConeIsTheWholeOneOnItsScale) {
  const std::vector<std::string> whole{"cone=abrams", "mix.yield_stress=200 Pa",
                                       "mix.plastic_viscosity=20 Pa.s", "mix.bulk_modulus=1 MPa",
                                       "test.lift_speed=instant"},
      half{"cone=half_abrams", "mix.yield_stress=100 Pa", "mix.plastic_viscosity=7.07107 Pa.s",
           "mix.bulk_modulus=0.5 MPa", "test.lift_speed=instant"};
  const double a = *scene::find_number(outcome_of(whole), "spread_mm"),
               b = *scene::find_number(outcome_of(half), "spread_mm");
  EXPECT_NEAR(2.0 * b / a, 1.0, 0.003);
}

// EN 206: S1 10 to 40 mm, S2 50 to 90, S3 100 to 150, S4 160 to 210, S5 from 220, read to 10 mm.
TEST(Moulds, SlumpClasses) {
  EXPECT_EQ(cone::slump_class(0.004), "");
  EXPECT_EQ(cone::slump_class(0.0449), "S1");
  EXPECT_EQ(cone::slump_class(0.0451), "S2");
  EXPECT_EQ(cone::slump_class(0.094), "S2");
  EXPECT_EQ(cone::slump_class(0.150), "S3");
  EXPECT_EQ(cone::slump_class(0.156), "S4");
  EXPECT_EQ(cone::slump_class(0.215), "S5");
}

// A class belongs to the mould of its standard: 300 Pa keep a mini cone's shape, and 2 kPa an Abrams cone's.
TEST(Moulds, ClassesBelongToTheAbramsCone) {
  const auto small = outcome_of({});
  for (const char* name : {"class_en12350_8", "class_en206_slump", "within_tremie_range", "t500_s"})
    EXPECT_TRUE(std::holds_alternative<std::monostate>(*scene::find_result(small, name))) << name;
  EXPECT_NE(small.judged.find("Not the Abrams cone"), std::string::npos) << small.judged;
  const auto stiff = outcome_of({"cone=abrams", "mix.yield_stress=1200 Pa", "mix.plastic_viscosity=30 Pa.s"});
  EXPECT_EQ(std::get<std::string>(*scene::find_result(stiff, "class_en206_slump")).front(), 'S');
  ASSERT_FALSE(stiff.answers.empty());
  EXPECT_EQ(stiff.answers.front().name, "slump_mm");
}

}  // namespace
}  // namespace tremie
