#include "apparatus/report/folder/crate.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <ctime>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "libmpm/io/write_error.hpp"
#include "tremie_version.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;  // keys in the order of writing

constexpr const char* crate_file = "ro-crate-metadata.json";

Json reference(const std::string& id) { return {{"@id", id}}; }

/// The seconds since 1970 that SOURCE_DATE_EPOCH states; nothing where it is not set or no such number.
std::optional<std::time_t> stated_time() {
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (!text || !*text) return {};
  char* end = nullptr;
  const long long seconds = std::strtoll(text, &end, 10);
  constexpr long long last = 253402300799;  // of the year 9999
  if (*end != '\0' || seconds < 0 || seconds > last) return {};
  return static_cast<std::time_t>(seconds);
}

/// The media type of a file, and what a result calls it.
struct Kind {
  const char *type, *name;
};

Kind kind_of(const fs::path& file) {
  static const std::map<std::string, Kind, std::less<>> by_name{
      {"scene.toml", {"application/toml", "scene with every value in SI units"}},
      {"summary.json", {"application/json", "results, checks, cost"}},
      {"timeseries.csv", {"text/csv", "readings over time"}},
      {"results.h5", {"application/x-hdf5", "results, series and points in full precision"}},
      {"report.html", {"text/html", "report"}},
      {"frames.pvd", {"application/xml", "list of the frames for ParaView"}}};
  static const std::map<std::string, Kind, std::less<>> by_ending{
      {".csv", {"text/csv", "table"}},         {".svg", {"image/svg+xml", "chart"}},
      {".png", {"image/png", "picture"}},      {".vtp", {"application/xml", "points at one time"}},
      {".json", {"application/json", "data"}}, {".toml", {"application/toml", "input"}},
      {".html", {"text/html", "report"}},      {".md", {"text/markdown", "page"}},
      {".h5", {"application/x-hdf5", "data"}}};
  if (const auto named = by_name.find(file.string()); named != by_name.end()) return named->second;
  const auto ending = by_ending.find(file.extension().string());
  return ending == by_ending.end() ? Kind{"application/octet-stream", "data"} : ending->second;
}

std::vector<fs::directory_entry> sorted_entries(const fs::path& folder) {
  std::vector<fs::directory_entry> entries;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with('.') && name != crate_file && name != "checkpoint") entries.push_back(entry);
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

/// Adds the entities of a folder's files and folders to the graph. Returns references to those directly in it.
Json add_parts(const fs::path& folder, const fs::path& below, Json& graph) {
  Json parts = Json::array();
  for (const auto& entry : sorted_entries(folder / below)) {
    const fs::path name = below / entry.path().filename();
    const std::string id = entry.is_directory() ? name.string() + "/" : name.string();
    parts.push_back(reference(id));
    if (entry.is_directory()) {
      const std::size_t place = graph.size();
      graph.push_back({{"@id", id}, {"@type", "Dataset"}, {"name", name.filename().string()}});
      graph[place]["hasPart"] = add_parts(folder, name, graph);
    } else {
      const Kind kind = kind_of(name);
      graph.push_back({{"@id", id}, {"@type", "File"}, {"name", kind.name}, {"encodingFormat", kind.type}});
    }
  }
  return parts;
}

void add_if_given(Json& entity, const char* key, const std::string& text) {
  if (!text.empty()) entity[key] = text;
}

/// SPDX has a page for each of its names; a licence with a name of its own is described by that name alone.
std::string licence_address(const std::string& licence) {
  if (licence.starts_with("http")) return licence;
  const bool is_name = std::all_of(licence.begin(), licence.end(), [](unsigned char c) {
    return std::isalnum(c) || c == '-' || c == '.' || c == '+';
  });
  return is_name ? "https://spdx.org/licenses/" + licence : "#licence";
}

/// The concrete; what was computed is based on it.
void add_mix(const Crate& crate, Json& root, Json& graph) {
  if (crate.mix_name.empty() && crate.mix_source.empty()) return;
  Json mix{{"@id", "#mix"}, {"@type", "CreativeWork"}};
  mix["name"] = crate.mix_name.empty() ? "mix" : crate.mix_name;
  add_if_given(mix, "description", crate.mix_source);
  if (!crate.mix_licence.empty()) {
    const std::string id = licence_address(crate.mix_licence);
    mix["license"] = reference(id);
    graph.push_back({{"@id", id}, {"@type", "CreativeWork"}, {"name", crate.mix_licence}});
  }
  root["isBasedOn"] = reference("#mix");
  graph.push_back(mix);
}

/// The program, and its run from the input to the other files.
void add_run(const Crate& crate, const Json& files, Json& root, Json& graph) {
  graph.push_back({{"@id", "#tremie"},
                   {"@type", "SoftwareApplication"},
                   {"name", "Tremie"},
                   {"version", version},
                   {"identifier", fmt::format("commit {}, {}, {}", commit, compiler, instructions)}});
  Json run{{"@id", "#run"}, {"@type", "CreateAction"}, {"name", crate.command}};
  run["instrument"] = reference("#tremie");
  const bool has_input = std::find(files.begin(), files.end(), reference(crate.input)) != files.end();
  if (has_input) run["object"] = reference(crate.input);
  Json made = Json::array();
  for (const Json& file : files)
    if (file != reference(crate.input)) made.push_back(file);
  run["result"] = made;
  run["actionStatus"] = reference(crate.completed ? "http://schema.org/CompletedActionStatus"
                                                  : "http://schema.org/FailedActionStatus");
  root["mentions"] = reference("#run");
  graph.push_back(run);
}

}  // namespace

std::string write_crate(const fs::path& folder, const Crate& crate) {
  const std::optional<std::time_t> stated = stated_time();
  Json root{{"@id", "./"}, {"@type", "Dataset"}, {"name", crate.name}};
  add_if_given(root, "description", crate.description);
  root["datePublished"] = fmt::format("{:%Y-%m-%d}", fmt::gmtime(stated.value_or(std::time(nullptr))));
  Json others = Json::array();
  root["hasPart"] = add_parts(folder, "", others);
  add_mix(crate, root, others);
  add_run(crate, root["hasPart"], root, others);
  Json graph = Json::array();
  graph.push_back({{"@id", crate_file},
                   {"@type", "CreativeWork"},
                   {"conformsTo", reference("https://w3id.org/ro/crate/1.1")},
                   {"about", reference("./")}});
  graph.push_back(root);
  for (const Json& entity : others) graph.push_back(entity);
  const Json document{{"@context", "https://w3id.org/ro/crate/1.1/context"}, {"@graph", graph}};
  io::write_text(folder / crate_file, document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
  const char* text = std::getenv("SOURCE_DATE_EPOCH");
  if (stated || !text || !*text) return {};
  return fmt::format(
      "{}: datePublished is today: SOURCE_DATE_EPOCH=\"{}\" is no number of seconds since 1970", crate_file,
      text);
}

}  // namespace tremie::report
