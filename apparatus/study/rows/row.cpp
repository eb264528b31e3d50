#include "apparatus/study/rows/row.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apparatus/report/summary.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::study {
namespace {

using Json = nlohmann::ordered_json;

const scene::Result* find_in(const std::vector<scene::Result>& results, const std::string& name) {
  for (const auto& result : results)
    if (result.name == name) return &result;
  return nullptr;
}

Reading as_reading(const scene::ResultValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  if (const auto* truth = std::get_if<bool>(&value)) return std::string(*truth ? "true" : "false");
  return std::monostate{};
}

Json json_of(const Reading& reading) {
  if (const auto* number = std::get_if<double>(&reading)) return *number;
  if (const auto* word = std::get_if<std::string>(&reading)) return *word;
  return nullptr;
}

Reading reading_from(const Json& json) {
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  return std::monostate{};
}

void fill_from(const scene::Outcome& outcome, const std::vector<std::string>& results,
               const std::string& place, Row& row) {
  row.status = report::status_name(outcome.status);
  row.reasons = outcome.checks.reasons;
  row.exit_code = row.reasons.empty() && outcome.status == Status::completed ? 0 : 3;
  row.cpu = outcome.cost.cpu;
  row.moving = outcome.moving_at_end;
  for (std::size_t i = 0; i < results.size(); ++i) {
    const auto reading = reading_of(outcome, results[i]);
    if (!reading) {
      const auto known = result_names(outcome.results);
      throw scene::InputError(
          fmt::format("{}: a {} has no result \"{}\"{}; it has {}", place, outcome.apparatus, results[i],
                      scene::nearest_in_brackets(results[i], known), fmt::join(known, ", ")));
    }
    row.readings[i] = *reading;
  }
}

Row empty_row(std::size_t results, std::size_t row) {
  return {row, std::vector<Reading>(results), "failed", 1, {}};
}

}  // namespace

std::optional<double> trusted_number(const Row& row, std::size_t reading) {
  const auto* number = std::get_if<double>(&row.readings[reading]);
  return row.exit_code == 0 && number ? std::optional(*number) : std::nullopt;
}

bool same_result(const Row& a, const Row& b) {
  return a.row == b.row && a.readings == b.readings && a.status == b.status && a.exit_code == b.exit_code &&
         a.reasons == b.reasons && a.moving == b.moving;
}

std::optional<Reading> reading_of(const scene::Outcome& outcome, const std::string& name) {
  const auto* results = &outcome.results;
  std::size_t start = 0;
  for (auto dot = name.find('.'); dot != std::string::npos; dot = name.find('.', start)) {
    const auto* found = find_in(*results, name.substr(start, dot - start));
    if (!found) return std::nullopt;
    const auto* below = std::get_if<std::vector<scene::Result>>(&found->value);
    if (!below) return Reading{};
    results = below;
    start = dot + 1;
  }
  const auto* found = find_in(*results, name.substr(start));
  if (!found) return std::nullopt;
  return as_reading(found->value);
}

std::vector<std::string> result_names(const std::vector<scene::Result>& results, const std::string& prefix) {
  std::vector<std::string> names;
  for (const auto& result : results) {
    if (const auto* below = std::get_if<std::vector<scene::Result>>(&result.value)) {
      const auto inner = result_names(*below, prefix + result.name + ".");
      names.insert(names.end(), inner.begin(), inner.end());
    } else {
      names.push_back(prefix + result.name);
    }
  }
  return names;
}

Row run_scene(const std::function<scene::Scene()>& read, const std::vector<std::string>& results,
              std::size_t index, const std::string& place) {
  Row row = empty_row(results.size(), index);
  scene::Outcome outcome;
  try {
    auto scene = read();
    scene::set_threads(scene, 1);
    scene.output.frames = false;
    outcome = scene::run(scene);
  } catch (const scene::InputError& error) {
    row.exit_code = 2;
    row.reasons = {error.what()};
    return row;
  } catch (const std::exception& error) {
    row.reasons = {error.what()};
    return row;
  }
  fill_from(outcome, results, place, row);
  return row;
}

Row run_row(const Definition& study, std::size_t row, const std::vector<std::string>& overrides) {
  return run_scene([&] { return scene::read(study.base, overrides); }, study.results, row,
                   study.file.string() + ": read.results");
}

Row dead_row(std::size_t results, std::size_t index, const std::string& death) {
  Row row = empty_row(results, index);
  row.reasons = {"its process was " + death};
  return row;
}

std::string row_json(const Row& row) {
  Json json{{"row", row.row}, {"readings", Json::array()}, {"status", row.status}};
  for (const Reading& reading : row.readings) json["readings"].push_back(json_of(reading));
  json["exit_code"] = row.exit_code;
  json["reasons"] = row.reasons;
  json["cpu_s"] = row.cpu;
  if (row.moving) json["moving_at_end"] = true;
  return json.dump() + "\n";
}

std::optional<Row> row_from_json(const std::string& text, std::size_t results) {
  if (!text.ends_with('\n')) return std::nullopt;
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    Row row;
    row.row = json.at("row");
    for (const auto& reading : json.at("readings")) row.readings.push_back(reading_from(reading));
    row.status = json.at("status");
    row.exit_code = json.at("exit_code");
    row.reasons = json.at("reasons").get<std::vector<std::string>>();
    row.cpu = json.at("cpu_s");
    row.moving = json.value("moving_at_end", false);
    if (row.readings.size() != results) return std::nullopt;
    return row;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

}  // namespace tremie::study
