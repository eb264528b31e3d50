#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "apparatus/cell/cell.hpp"
#include "rheometer/reference/references.hpp"

namespace tremie::cell {

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<scene::Column> series_of(const CellResult& result) {
  std::vector<scene::Column> series{{"time_s", {}},
                                    {"shear_rate_per_s", {}},
                                    {"shear_stress_Pa", {}},
                                    {"flocculation", {}},
                                    {"flocculation_reference", {}}};
  for (const CellSample& s : result.samples) {
    series[0].values.push_back(s.time);
    series[1].values.push_back(s.shear_rate);
    series[2].values.push_back(s.shear_stress.value_or(none));
    series[3].values.push_back(s.flocculation.value_or(none));
    series[4].values.push_back(s.flocculation_reference.value_or(none));
  }
  return series;
}

std::string shown(std::optional<double> value, const char* unit) {
  return value ? fmt::format("{:.4g}{}", *value, unit) : "does not apply";
}

}  // namespace

scene::Outcome outcome(const Scene& scene, const CellResult& result) {
  const CellSample& last = result.samples.back();
  scene::Outcome o;
  o.apparatus = "cell";
  double stress_max = none;
  for (const CellSample& s : result.samples)
    if (s.shear_stress)
      stress_max = std::isfinite(stress_max) ? std::max(stress_max, *s.shear_stress) : *s.shear_stress;
  o.results = {{"stress_max_Pa", scene::number(stress_max)},
               {"stress_end_Pa", scene::number(last.shear_stress)},
               {"flocculation_end", scene::number(last.flocculation)},
               {"hysteresis_area_Pa_per_s", scene::number(result.hysteresis_area)},
               {"flocculation_error_max", scene::number(result.flocculation_error_max)}};
  o.asked = scene.name + ", one material cell";
  o.answers = {{"stress_max_Pa", "largest stress", "Pa", 1}, {"stress_end_Pa", "at the end", "Pa", 1}};
  o.series = series_of(result);
  o.checks.volume_change = o.checks.mass_error = o.checks.max_speed_end = none;  // a cell has none
  double largest = 0.0;
  for (const CellSample& s : result.samples)
    largest = std::max(largest, s.flocculation_reference.value_or(0.0));
  if (result.flocculation_error_max && *result.flocculation_error_max > 0.01 * std::max(largest, 1e-6))
    o.checks.reasons.push_back(
        fmt::format("the flocculation's update is {:.2g} off CVODE, more than 1 % of its largest value: a "
                    "smaller model.time_step",
                    *result.flocculation_error_max));
  o.cost.steps = result.steps;
  o.cost.points = 1;
  o.cost.simulated = last.time;
  const bool any_stress = std::any_of(result.samples.begin(), result.samples.end(),
                                      [](const CellSample& s) { return s.shear_stress.has_value(); });
  if (any_stress)
    o.charts = {{"flow_curve.svg",
                 scene.name + ": flow curve",
                 "shear rate (1/s)",
                 "shear stress (Pa)",
                 {"shear_stress_Pa"},
                 {},
                 {},
                 "",
                 "shear_rate_per_s"},
                {"stress.svg",
                 scene.name + ": shear stress",
                 "time (s)",
                 "shear stress (Pa)",
                 {"shear_stress_Pa"},
                 {}}};
  if (scene.cell.mix.thixotropy)
    o.charts.push_back({"flocculation.svg",
                        scene.name + ": flocculation",
                        "time (s)",
                        "flocculation state λ",
                        {"flocculation"},
                        {}});
  o.lines = {"largest stress       " +
                 shown(std::isfinite(stress_max) ? std::optional(stress_max) : std::nullopt, " Pa"),
             "stress at the end    " + shown(last.shear_stress, " Pa"),
             "flocculation         " + shown(last.flocculation, ""),
             "largest error        " + shown(result.flocculation_error_max, " of lambda against CVODE"),
             "hysteresis area      " + shown(result.hysteresis_area, " Pa/s")};
  if (scene.cell.mix.thixotropy && !has_integrated_references())
    o.lines.push_back("no comparison        built without SUNDIALS: apt-get install libsundials-dev");
  return o;
}

}  // namespace tremie::cell
