#pragma once

// Rows that the tables of several tests share. View is a RunView whose Sample has the members that the rows name, and whose
// results have stopped_at.

#include <utility>

#include "apparatus/common/outcome_parts.hpp"
#include "apparatus/common/readings.hpp"

namespace tremie::scene {

/// One table of several parts, in their order.
template <class View, class... Parts>
std::vector<Reading<View>> table_of(Parts... parts) {
  std::vector<Reading<View>> table;
  (table.insert(table.end(), parts.begin(), parts.end()), ...);
  return table;
}

template <class View>
using Rows = std::vector<Reading<View>>;

template <class View>
Rows<View> time_column() {
  return {
      {"time_s", "time since the start of the test", {}, [](const View&, const auto& s) { return s.time; }}};
}

template <class View>
bool is_thixotropic(const View& v) {
  return v.scene.mix.thixotropy.has_value();
}

template <class View>
Rows<View> shear_columns() {
  return {{"shear_rate_mean_per_s",
           "shear rate, volume mean",
           {},
           [](const View&, const auto& s) { return s.shear_rate_mean; }},
          {.name = "flocculation_mean",
           .words = "flocculation state λ, volume mean",
           .at = [](const View&, const auto& s) { return or_nan(s.flocculation_mean); },
           .applies = is_thixotropic<View>}};
}

/// Of a flow of points: largest speed, shear rate, flocculation, volume.
template <class View>
Rows<View> motion_columns() {
  return table_of<View>(
      Rows<View>{
          {"max_speed_m_per_s", "largest speed", {}, [](const View&, const auto& s) { return s.max_speed; }}},
      shear_columns<View>(),
      Rows<View>{{"volume_change", "change of volume, ΣV/V0 − 1", {}, [](const View&, const auto& s) {
                    return s.volume_change;
                  }}});
}

template <class View>
Rows<View> step_columns() {
  return {{"time_step_s", "", {}, [](const View&, const auto& s) { return s.time_step; }},
          {"iterations", "iterations of the yield method in the step", {}, [](const View&, const auto& s) {
             return static_cast<double>(s.iterations);
           }}};
}

template <class View>
Rows<View> stopped_row() {
  return {{.name = "stopped_at_s",
           .words = "came to rest at",
           .value = [](const View& v) { return number(v.r.stopped_at); },
           .none = [](const View& v) { return std::string(still_moving(v.status)); },
           .lines = [](const View& v) { return std::vector{stopped_line(v.r.stopped_at, v.status)}; }}};
}

template <class View>
Rows<View> flocculation_rows() {
  return {{.name = "flocculation_mean_start",
           .words = "flocculation state λ at the start, mean",
           .value = [](const View& v) { return number(v.series.front().flocculation_mean); },
           .lines =
               [](const View& v) {
                 return flocculation_lines(v.series.front().flocculation_mean,
                                           v.series.back().flocculation_mean);
               }},
          {"flocculation_mean_end", "flocculation state λ at the end, mean",
           [](const View& v) { return number(v.series.back().flocculation_mean); }}};
}

/// Rows that a run has together or not at all.
template <class View>
Rows<View> only_where(bool (*applies)(const View&), Rows<View> rows) {
  for (Reading<View>& row : rows) row.applies = applies;
  return rows;
}

/// The outcome of a run: the readings of its table, the mix's name and the test in words. The rest is omitted for a mix
/// without thixotropy.
template <class View>
Outcome outcome_of(const std::vector<Reading<View>>& table, const View& view, const std::string& mix_name,
                   const std::string& test) {
  Outcome outcome;
  outcome.status = view.status;
  outcome.checks = view.run.checks;
  outcome.cost = view.run.cost;
  read_into(table, view, outcome);
  outcome.asked = asked_text(mix_name, test, view.scene.mix.thixotropy ? view.scene.rest : 0.0);
  return outcome;
}

/// "not reached yet" of a run that ended early, "never reached" of another.
template <class View>
std::string not_reached(const View& v) {
  return ended_early(v.status) ? "not reached yet" : "never reached";
}

}  // namespace tremie::scene
