// ro-crate-metadata.json beside a result, by RO-Crate 1.1 (https://www.researchobject.org/ro-crate/specification/1.1):
// JSON-LD in flattened form, a metadata descriptor, a root data set, and an entity for every file.

#include <gtest/gtest.h>

#include <ctime>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "apparatus/report/folder/own_files.hpp"
#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[16];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now))};
}

class Crate : public ::testing::Test {
 protected:
  void SetUp() override {
    test::write_file(
        folder_ / "quick.toml",
        "apparatus = \"slump_flow\"\nmix = \"mix_c\"\n[test]\nduration = \"0.1 s\"\nlift_speed = "
        "\"instant\"\n[model]\ncell = \"20 mm\"\npoints_per_cell = 2\n");
  }
  test::Result tremie(const std::string& arguments, const std::string& environment = "-u SOURCE_DATE_EPOCH") {
    return test::shell("env " + environment + " '" TREMIE_PROGRAM "' " + arguments, folder_.path());
  }
  std::string bytes(const std::string& result) {
    return test::read_file(folder_ / (result + "/ro-crate-metadata.json"));
  }
  Json graph(const std::string& result) { return Json::parse(bytes(result))["@graph"]; }

  test::TemporaryFolder folder_;
};

Json entity(const Json& graph, const std::string& id) {
  for (const Json& e : graph)
    if (e["@id"] == id) return e;
  return nullptr;
}

/// Whether every entity has an own @id and a @type, only words of the context (or of JSON-LD), and values that are texts or
/// references to entities of the graph or to addresses.
void expect_flattened(const Json& graph) {
  std::set<std::string> ids;
  for (const Json& e : graph) EXPECT_TRUE(ids.insert(e["@id"]).second) << e["@id"];
  const std::set<std::string> words{
      "@id",         "@type",          "about",   "actionStatus", "conformsTo", "datePublished",
      "description", "encodingFormat", "hasPart", "identifier",   "instrument", "isBasedOn",
      "license",     "mentions",       "name",    "object",       "result",     "version"};
  const auto check = [&](const Json& value) {
    if (value.is_string()) return;
    ASSERT_TRUE(value.is_object() && value.size() == 1 && value.contains("@id")) << value;
    const std::string id = value["@id"];
    EXPECT_TRUE(ids.contains(id) || id.starts_with("http")) << id;
  };
  for (const Json& e : graph) {
    EXPECT_TRUE(e.contains("@type")) << e;
    for (const auto& [key, value] : e.items()) {
      EXPECT_TRUE(words.contains(key)) << key;
      if (!value.is_array()) check(value);
      if (value.is_array())
        for (const Json& one : value) check(one);
    }
  }
}

/// Ids of the files below a data set.
std::set<std::string> files_below(const Json& graph, const std::string& id) {
  std::set<std::string> files;
  const Json folder = entity(graph, id);
  for (const Json& part : folder["hasPart"]) {
    const std::string name = part["@id"];
    if (entity(graph, name)["@type"] == "File")
      files.insert(name);
    else
      files.merge(files_below(graph, name));
  }
  return files;
}

/// Files that a reader sees: not those that `tremie resume --until` and `--force` need.
std::set<std::string> files_in(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && !name.starts_with('.') && name != "ro-crate-metadata.json")
      files.insert(name);
  }
  return files;
}

TEST_F(Crate, HasTheRequiredEntitiesAndEveryFileOfTheResult) {
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --out with").code, 0);
  const Json crate = Json::parse(bytes("with"));
  EXPECT_EQ(crate["@context"], "https://w3id.org/ro/crate/1.1/context");
  const Json& all = crate["@graph"];
  expect_flattened(all);
  const Json descriptor = entity(all, "ro-crate-metadata.json"), root = entity(all, "./");
  EXPECT_EQ(descriptor["@type"], "CreativeWork");
  EXPECT_EQ(descriptor["conformsTo"]["@id"], "https://w3id.org/ro/crate/1.1");
  EXPECT_EQ(descriptor["about"]["@id"], "./");
  EXPECT_EQ(root["@type"], "Dataset");
  EXPECT_EQ(root["name"], "Mix C, slump flow without rest");
  EXPECT_EQ(files_below(all, "./"), files_in(folder_ / "with"));
  EXPECT_TRUE(files_below(all, "./").contains("frames/frame_00000.vtp"));
}

TEST_F(Crate, NamesProgramSceneCommandAndMix) {
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --out with --set mix.licence=CC-BY-4.0").code, 0);
  const Json all = graph("with"), run = entity(all, "#run"), mix = entity(all, "#mix");
  const Json summary = Json::parse(test::read_file(folder_ / "with/summary.json"));
  EXPECT_EQ(entity(all, "#tremie")["version"], summary["tremie"]["version"]);
  EXPECT_EQ(run["instrument"]["@id"], "#tremie");
  EXPECT_EQ(run["object"]["@id"], "scene.toml");
  EXPECT_EQ(run["name"], "tremie run quick.toml --set 'mix.licence=CC-BY-4.0'");
  EXPECT_EQ(mix["name"], "Mix C");
  EXPECT_NE(std::string(mix["description"]).find("Wilkes"), std::string::npos);
  EXPECT_EQ(entity(all, mix["license"]["@id"])["name"], "CC-BY-4.0");
}

// Cost and sums differ between two runs; a description of the same scene does not.
TEST_F(Crate, HasTheSameBytesTwice) {
  const std::string day = "SOURCE_DATE_EPOCH=86400";
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --out first --threads 1", day).code, 0);
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --out second --threads 2", day).code, 0);
  EXPECT_EQ(bytes("first"), bytes("second"));
}

// 86400 s after the start of 1970 is its second day.
TEST_F(Crate, TakesItsDateFromTheEnvironmentOrToday) {
  const auto dated = tremie("run quick.toml --crate --out dated", "SOURCE_DATE_EPOCH=86400");
  EXPECT_EQ(entity(graph("dated"), "./")["datePublished"], "1970-01-02");
  EXPECT_EQ(dated.text.find("datePublished"), std::string::npos) << dated.text;
  for (const char* none : {"-u SOURCE_DATE_EPOCH", "SOURCE_DATE_EPOCH=today", "SOURCE_DATE_EPOCH=-1"}) {
    const std::string before = today();
    const auto undated = tremie("run quick.toml --crate --force --out undated", none);
    EXPECT_EQ(undated.code, 0) << none;
    const std::string day = entity(graph("undated"), "./")["datePublished"];
    EXPECT_TRUE(day == before || day == today()) << none << ": " << day;  // midnight may lie between
    EXPECT_EQ(undated.text.find("datePublished is today") != std::string::npos, none[0] == 'S')
        << undated.text;
  }
}

TEST_F(Crate, IsReplacedByForceAndKeptWhereItWasChanged) {
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --out with").code, 0);
  EXPECT_EQ(tremie("run quick.toml --quiet --force --out with").code, 0);
  EXPECT_FALSE(fs::exists(folder_ / "with/ro-crate-metadata.json"));
  ASSERT_EQ(tremie("run quick.toml --quiet --crate --force --out with").code, 0);
  test::write_file(folder_ / "with/ro-crate-metadata.json", "{}");
  const auto refused = tremie("run quick.toml --quiet --force --out with");
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.text.find("ro-crate-metadata.json"), std::string::npos) << refused.text;
  EXPECT_EQ(bytes("with"), "{}");
}

TEST_F(Crate, DescribesAFit) {
  test::write_file(
      folder_ / "record.csv",
      "speed_rev_per_s,torque_nm\n0.5,1.90\n0.4,1.62\n0.3,1.35\n0.2,1.07\n0.1,0.80\n0.05,0.66\n");
  const auto fit = tremie("fit record.csv --quiet --crate --out fitted");
  ASSERT_TRUE(fit.code == 0 || fit.code == 3) << fit.text;
  const Json all = graph("fitted");
  expect_flattened(all);
  EXPECT_EQ(entity(all, "./")["name"], "Fit of record.csv");
  EXPECT_EQ(files_below(all, "./"), files_in(folder_ / "fitted"));
}

}  // namespace
}  // namespace tremie
