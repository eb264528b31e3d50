#include "apparatus/report/compare/run_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/document.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"
#include "rheometer/tables/number_text.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void refuse_result(const fs::path& folder, const std::string& why) {
  throw scene::InputError(fmt::format("{}: {}", folder.string(), why));
}

std::string below(const std::string& place, const std::string& key) {
  return place.empty() ? key : place + "." + key;
}

/// "52.54 to 64.84" of an interval, else the items after each other.
std::string list_text(const Json& list) {
  std::vector<std::string> items;
  for (const auto& item : list)
    items.push_back(item.is_number()   ? scene::rounded(item.get<double>(), 4)
                    : item.is_string() ? item.get<std::string>()
                                       : item.dump());
  const bool interval = list.size() == 2 && list.front().is_number();
  return fmt::format("{}", fmt::join(items, interval ? " to " : "; "));
}

/// Of a value with its interval, {"value", "ci95"}, the value stands under the key itself. Lists of tables are left
/// out: they have no columns in common.
void flatten(const Json& json, const std::string& place, std::vector<Entry>& entries) {
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      flatten(value, key == "value" && json.contains("ci95") ? place : below(place, key), entries);
    return;
  }
  if (json.is_array() && !json.empty() && json.front().is_object()) return;
  Entry entry{place,
              json.is_null()     ? "–"
              : json.is_string() ? json.get<std::string>()
              : json.is_array()  ? list_text(json)
                                 : json.dump(),
              {}};
  if (json.is_number()) entry.number = json.get<double>();
  entries.push_back(std::move(entry));
}

std::string value_text(const scene::Node& node) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return *text;
  if (const auto* whole = std::get_if<std::int64_t>(&node.value)) return fmt::format("{}", *whole);
  if (const auto* number = std::get_if<double>(&node.value)) return scene::write_number(*number);
  if (const auto* truth = std::get_if<bool>(&node.value)) return *truth ? "true" : "false";
  std::string text;
  if (const auto* array = std::get_if<scene::Array>(&node.value))
    for (const auto& element : *array) text += (text.empty() ? "" : ", ") + value_text(element);
  return "[" + text + "]";
}

void flatten(const scene::Node& node, const std::string& place, std::vector<Entry>& entries) {
  const auto* table = std::get_if<scene::Table>(&node.value);
  const auto* array = std::get_if<scene::Array>(&node.value);
  if (table) {
    for (const auto& member : *table) flatten(member.node, below(place, member.key), entries);
  } else if (array && !array->empty() && std::holds_alternative<scene::Table>(array->front().value)) {
    for (std::size_t i = 0; i < array->size(); ++i)
      flatten((*array)[i], fmt::format("{}[{}]", place, i), entries);
  } else {
    entries.push_back({place, value_text(node), {}});
  }
}

Json read_summary(const fs::path& folder) {
  std::error_code error;
  if (!fs::exists(folder, error)) refuse_result(folder, "there is no such folder");
  if (!fs::is_directory(folder, error))
    refuse_result(folder, "is no folder; compare takes folders of results");
  std::ifstream stream(folder / "summary.json");
  if (!stream) refuse_result(folder, "holds no result: summary.json is missing");
  try {
    Json json = Json::parse(stream);
    for (const char* key : {"apparatus", "status", "results", "checks"})
      if (!json.contains(key)) refuse_result(folder, fmt::format("its summary.json has no \"{}\"", key));
    if (!json["results"].is_object()) refuse_result(folder, "its summary.json has no results");
    return json;
  } catch (const Json::exception&) {
    refuse_result(folder, "its summary.json is no JSON");
  }
}

std::vector<scene::Column> read_columns(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<scene::Column> columns;
  std::string line, field;
  if (std::getline(stream, line))
    for (std::istringstream head(line); std::getline(head, field, ',');) columns.push_back({field, {}});
  while (std::getline(stream, line)) {
    std::istringstream row(line);
    for (auto& column : columns) {
      if (!std::getline(row, field, ',')) field.clear();
      column.values.push_back(parse_number(field).value_or(std::nan("")));
    }
  }
  return columns;
}

bool is_scene_apparatus(const std::string& name) {
  const auto& all = scene::all_apparatus();
  return std::any_of(all.begin(), all.end(), [&](const auto& a) { return a.keys.name == name; });
}

void read_tables(const fs::path& folder, RunResult& run) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".csv" && entry.path().filename() != "timeseries.csv")
      files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    FileColumns table{file.filename().string(), read_columns(file)};
    if (table.columns.size() > 1 && table.columns.front().name != "time_s")
      run.tables.push_back(std::move(table));
  }
}

}  // namespace

const Entry* find_entry(const std::vector<Entry>& entries, const std::string& key) {
  const auto found =
      std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &*found;
}

std::vector<Entry> scene_entries(const std::string& text, const std::string& name) {
  std::vector<Entry> entries;
  flatten(scene::parse_text(text, name, scene::Layer::scene), "", entries);
  return entries;
}

RunResult read_run_result(const std::string& given) {
  const fs::path folder = fs::path(given).has_filename() ? fs::path(given) : fs::path(given).parent_path();
  const Json summary = read_summary(folder);
  RunResult run;
  run.folder = given, run.name = folder.filename().string();
  if (run.name == "." || run.name == "..") run.name = fs::canonical(folder).filename().string();
  run.apparatus = summary["apparatus"].get<std::string>(), run.status = summary["status"].get<std::string>();
  if (summary.contains("tremie"))
    run.program = fmt::format("{} ({})", summary["tremie"].value("version", "?"),
                              summary["tremie"].value("commit", "?"));
  if (summary["checks"].contains("reasons"))
    run.reasons = summary["checks"]["reasons"].get<std::vector<std::string>>();
  flatten(summary["results"], "", run.results);
  if (summary.contains("error")) flatten(summary["error"], "", run.errors);
  for (const char* file : {"scene.toml", "timeseries.csv"})
    if (is_scene_apparatus(run.apparatus) && !fs::exists(folder / file))
      refuse_result(folder, fmt::format("holds a {} without its {}", run.apparatus, file));
  if (fs::exists(folder / "scene.toml")) flatten(scene::parse_file(folder / "scene.toml"), "", run.scene);
  run.series = {"timeseries.csv", read_columns(folder / "timeseries.csv")};
  if (is_scene_apparatus(run.apparatus)) read_tables(folder, run);
  return run;
}

}  // namespace tremie::report
