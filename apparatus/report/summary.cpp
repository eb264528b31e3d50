#include "apparatus/report/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apparatus/scene/units.hpp"
#include "tremie_version.hpp"

namespace tremie::report {
namespace {

using Json = nlohmann::ordered_json;  // keys in the order of writing; not-a-number becomes null

Json to_json(const std::vector<scene::Result>& results);

Json to_json(const scene::ResultValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* truth = std::get_if<bool>(&value)) return *truth;
  if (const auto* below = std::get_if<std::vector<scene::Result>>(&value)) return to_json(*below);
  return nullptr;
}

Json to_json(const std::vector<scene::Result>& results) {
  Json json = Json::object();
  for (const auto& [name, value] : results) json[name] = to_json(value);
  return json;
}

Json checks_json(const Checks& checks) {
  return {{"volume_change", checks.volume_change},
          {"mass_error", checks.mass_error},
          {"unconverged_steps", checks.unconverged_steps},
          {"points_lost", checks.points_lost},
          {"max_speed_end_m_per_s", checks.max_speed_end},
          {"stability_limit_exceeded", checks.stability_limit_exceeded},
          {"stood_still", checks.stood_still},
          {"reasons", checks.reasons}};
}

Json cost_json(const Cost& cost) {
  return {{"wall_s", cost.wall},
          {"cpu_s", cost.cpu},
          {"steps", cost.steps},
          {"points", cost.points},
          {"cells_active", cost.cells_active},
          {"bytes_per_point", cost.bytes_per_point},
          {"peak_rss_bytes", cost.peak_rss_bytes},
          {"threads", cost.threads},
          {"simulated_s", cost.simulated}};
}

/// Null where there are no points: what is told of points, cells and steps.
void leave_out_points(bool steps_too, Json& summary) {
  for (const char* key : {"volume_change", "mass_error", "unconverged_steps", "points_lost",
                          "max_speed_end_m_per_s", "stability_limit_exceeded", "stood_still"})
    summary["checks"][key] = nullptr;
  for (const char* key : {"cells_active", "bytes_per_point"}) summary["cost"][key] = nullptr;
  if (steps_too)
    for (const char* key : {"steps", "points", "simulated_s"}) summary["cost"][key] = nullptr;
}

Json error_json(const scene::ErrorEstimate& error) {
  Json json = Json::object();
  for (const auto& bar : error.bars) json[bar.name] = bar.error;
  json["basis"] = error.basis;
  json["cpu_s"] = error.cpu;
  return json;
}

}  // namespace

const char* status_name(Status status) {
  return status == Status::completed ? "completed" : status == Status::interrupted ? "interrupted" : "failed";
}

Json run_summary(const scene::Outcome& outcome) {
  Json json;
  json["schema"] = 1;
  json["tremie"] = {
      {"version", version}, {"commit", commit}, {"compiler", compiler}, {"instructions", instructions}};
  json["apparatus"] = outcome.apparatus;
  json["status"] = status_name(outcome.status);
  json["results"] = to_json(outcome.results);
  json["checks"] = checks_json(outcome.checks);
  json["cost"] = cost_json(outcome.cost);
  if (!outcome.has_points) leave_out_points(outcome.cost.points == 0, json);
  if (outcome.error) json["error"] = error_json(*outcome.error);
  return json;
}

std::string summary_json(const scene::Outcome& outcome) { return run_summary(outcome).dump(2) + "\n"; }

std::string columns_csv(const std::vector<scene::Column>& series) {
  std::string text;
  for (const auto& column : series) text += (text.empty() ? "" : ",") + column.name;
  text += '\n';
  const std::size_t rows = series.empty() ? 0 : series.front().values.size();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t i = 0; i < series.size(); ++i) {
      if (i > 0) text += ',';
      const double value = series[i].values[row];
      if (std::isfinite(value)) text += scene::write_number(value);
    }
    text += '\n';
  }
  return text;
}

}  // namespace tremie::report
