// An apparatus of its own by a table of keys: repeated tables, lists, a key at the top.

#include <gtest/gtest.h>

#include "apparatus/common/shared_keys.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/resolved.hpp"

namespace tremie::scene {
namespace {

ApparatusKeys cell_keys() {
  ApparatusKeys keys{
      .name = "cell", .help = "One material cell.", .schema = {}, .presets = {}, .settle = settle_mix};
  keys.schema.push_back(
      {.name = "",
       .help = "",
       .keys = {{.name = "history", .kind = Kind::text, .help = "a CSV in place of the tables"},
                {.name = "speeds",
                 .dimension = Dimension::rotation,
                 .range = positive,
                 .shape = Shape::list,
                 .fallback = R"(["15 rpm", "30 rpm"])"}}});
  for (const Section& section : mix_sections()) keys.schema.push_back(section);
  Section history{.name = "history", .help = "A segment.", .keys = {}, .optional = false, .repeated = true};
  history.keys = {{.name = "duration",
                   .dimension = Dimension::time,
                   .range = positive,
                   .required = true,
                   .example = "1 s"},
                  {.name = "from", .dimension = Dimension::rate, .range = not_negative, .fallback = "0 1/s"},
                  {.name = "to", .dimension = Dimension::rate, .range = not_negative, .fallback = "0 1/s"}};
  keys.schema.push_back(history);
  return keys;
}

const std::string mix = "[mix]\nyield_stress = \"54 Pa\"\nplastic_viscosity = \"35.8 Pa.s\"\n";

Loaded load_cell(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load({"cell.toml", overrides, text}, std::vector{cell_keys()});
}

// "vane" is three letters from "cell" and five from "icar_vane", which it is part of.
TEST(Keys, TheNearestWordIsTheOneThatHoldsWhatWasTyped) {
  const std::vector<std::string> known = {"slump_flow", "l_box", "icar_vane", "cell"};
  EXPECT_EQ(nearest("vane", known), "icar_vane");
  EXPECT_EQ(nearest("slump", known), "slump_flow");
  EXPECT_EQ(nearest("sel", known), "cell");
  EXPECT_EQ(nearest("slumpflow", known), "slump_flow");
  for (const char* far : {"marsh_cone", "gravity", "triaxial", "penetrometer"})
    EXPECT_EQ(nearest(far, known), "") << far;
}

TEST(Keys, RepeatedTables) {
  const std::string text =
      "apparatus = \"cell\"\n" + mix +
      "[[history]]\nduration = \"100 s\"\n[[history]]\nduration = \"5 s\"\nto = \"20 1/s\"\n";
  const Loaded cell = load_cell(text);
  ASSERT_EQ(cell.values.count("history"), 2U);
  EXPECT_EQ(cell.values.number("history[0].duration"), 100.0);
  EXPECT_EQ(cell.values.number("history[0].to"), 0.0);
  EXPECT_EQ(cell.values.number("history[1].to"), 20.0);
  EXPECT_FALSE(cell.values.has("history"));
  const std::string resolved = write_resolved(cell.schema, cell.values);
  EXPECT_EQ(load_cell(resolved).values.number("history[1].to"), 20.0) << resolved;
}

TEST(Keys, ATopKeyInPlaceOfTables) {
  const Loaded cell = load_cell("apparatus = \"cell\"\nhistory = \"a.csv\"\n" + mix);
  EXPECT_EQ(cell.values.word("history"), "a.csv");
  EXPECT_EQ(cell.values.count("history"), 0U);
}

TEST(Keys, Lists) {
  const Loaded cell = load_cell("apparatus = \"cell\"\n" + mix, {R"(speeds=["6 rpm", "12 rpm", "18 rpm"])"});
  EXPECT_EQ(cell.values.numbers("speeds").size(), 3U);
  EXPECT_THROW(load_cell("apparatus = \"cell\"\nspeeds = \"6 rpm\"\n" + mix), InputError);
  EXPECT_THROW(load_cell("apparatus = \"cell\"\nspeeds = []\n" + mix), InputError);
}

TEST(Keys, FaultsInARepeatedTableNameItsPlace) {
  try {
    load_cell("apparatus = \"cell\"\n" + mix +
              "[[history]]\nduration = \"1 s\"\n[[history]]\nform = \"1 1/s\"\n");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_NE(what.find("cell.toml:8: history[1].form: unknown key; did you mean \"from\"?"),
              std::string::npos)
        << what;
    EXPECT_NE(what.find("cell.toml:7: history[1].duration: missing key"), std::string::npos) << what;
  }
}

TEST(Keys, TheTemplateIsValid) { EXPECT_NO_THROW(load_cell(write_template(cell_keys()))); }

}  // namespace
}  // namespace tremie::scene
