#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/cell/cell.hpp"
#include "apparatus/common/outcome_parts.hpp"
#include "rheometer/reference/references.hpp"

namespace tremie::cell {

namespace {

using scene::number;
using scene::or_nan;

/// A run as the rows of the table see it.
struct View {
  using Sample = CellSample;
  const Scene& scene;
  const CellResult& r;
  const std::vector<CellSample>& series = r.samples;
};

/// The largest of the stresses [Pa]; empty where no sample has one.
std::optional<double> largest_stress(const View& v) {
  if (v.r.peak) return v.r.peak->stress;
  std::optional<double> largest;
  for (const CellSample& s : v.series)
    if (s.shear_stress) largest = std::max(largest.value_or(*s.shear_stress), *s.shear_stress);
  return largest;
}

std::string shown(std::optional<double> value, const char* unit) {
  return value ? fmt::format("{:.4g}{}", *value, unit) : "does not apply";
}

std::vector<std::string> stress_lines(const View& v) {
  const CellSample& last = v.series.back();
  return {"largest stress       " + shown(largest_stress(v), " Pa"),
          "stress at the end    " + shown(last.shear_stress, " Pa"),
          "flocculation         " + shown(last.flocculation, ""),
          "largest error        " + shown(v.r.flocculation_error_max, " of lambda against CVODE"),
          "hysteresis area      " + shown(v.r.hysteresis_area, " Pa/s")};
}

bool is_elastic(const View& v) { return v.r.peak.has_value(); }

std::vector<std::string> elastic_lines(const View& v) {
  return {fmt::format("strain at its peak   {:.4g}", v.r.peak->strain),
          "largest error        " + shown(v.r.stress_error_max, " Pa of the stress against CVODE")};
}

std::vector<std::string> comparison_lines(const View& v) {
  if (!v.scene.cell.mix.thixotropy || has_integrated_references()) return {};
  return {"no comparison        built without SUNDIALS: apt-get install libsundials-dev"};
}

const std::vector<scene::Reading<View>>& readings() {
  using V = const View&;
  using S = const CellSample&;
  static const std::vector<scene::Reading<View>> table{
      {.name = "stress_max_Pa",
       .words = "largest shear stress",
       .value = [](V v) { return number(largest_stress(v)); },
       .digits = 1,
       .answer = [](V) { return std::optional<std::string>("largest stress"); },
       .lines = stress_lines},
      {.name = "stress_end_Pa",
       .words = "shear stress at the end",
       .value = [](V v) { return number(v.series.back().shear_stress); },
       .digits = 1,
       .answer = [](V) { return std::optional<std::string>("at the end"); }},
      {"flocculation_end", "flocculation state λ at the end",
       [](V v) { return number(v.series.back().flocculation); }},
      {"hysteresis_area_Pa_per_s", "area of the hysteresis loop",
       [](V v) { return number(v.r.hysteresis_area); }},
      {.name = "flocculation_error_max",
       .words = "largest difference of λ from CVODE",
       .value = [](V v) { return number(v.r.flocculation_error_max); },
       .lines = comparison_lines},
      {.name = "strain_at_stress_max",
       .words = "shear strain since the shear began, at the largest stress",
       .value = [](V v) { return number(v.r.peak->strain); },
       .applies = is_elastic,
       .lines = elastic_lines},
      {.name = "stress_error_max_Pa",
       .words = "largest difference of the stress from CVODE",
       .value = [](V v) { return number(v.r.stress_error_max); },
       .applies = is_elastic},
      {"time_s", "time since the start of the test", {}, [](V, S s) { return s.time; }},
      {"shear_rate_per_s", "", {}, [](V, S s) { return s.shear_rate; }},
      {"shear_stress_Pa", "", {}, [](V, S s) { return or_nan(s.shear_stress); }},
      {"flocculation", "flocculation state λ", {}, [](V, S s) { return or_nan(s.flocculation); }},
      {"flocculation_reference",
       "flocculation state λ by CVODE",
       {},
       [](V, S s) { return or_nan(s.flocculation_reference); }},
      {.name = "strain",
       .words = "shear strain since the shear began",
       .at = [](V, S s) { return or_nan(s.strain); },
       .applies = is_elastic},
      {.name = "shear_stress_reference_Pa",
       .words = "shear stress by CVODE",
       .at = [](V, S s) { return or_nan(s.shear_stress_reference); },
       .applies = is_elastic}};
  return table;
}

/// A reason where the update of the flocculation state is off its reference by more than 1 % of the largest value, or of the
/// static yield stress at that time.
std::string update_is_off(const View& v) {
  double largest = 0.0, of_the_stress = 0.0;
  for (const CellSample& s : v.series) {
    if (!s.flocculation || !s.flocculation_reference) continue;
    const double reference = *s.flocculation_reference;
    largest = std::max(largest, reference);
    of_the_stress = std::max(of_the_stress, std::abs(*s.flocculation - reference) / (1.0 + reference));
  }
  const auto& error = v.r.flocculation_error_max;
  if (!error || !(*error > 0.01 * std::max(largest, 1e-6) || of_the_stress > 0.01)) return {};
  return fmt::format(
      "the flocculation's update is up to {:.2g} off CVODE, more than 1 %: a smaller model.time_step",
      *error);
}

/// A reason where there is no reference.
std::string reference_gave_up(const View& v) {
  if (v.r.reference_failed.empty()) return {};
  return fmt::format("the flocculation's update cannot be checked: {}", v.r.reference_failed);
}

/// A reason where the elastic cell's stress is off its reference.
std::string stress_is_off(const View& v) {
  const auto& error = v.r.stress_error_max;
  if (!error || !(*error > 0.01 * v.r.peak->stress)) return {};
  return fmt::format(
      "the stress is {:.2g} Pa off CVODE, more than 1 % of its largest value: a smaller model.time_step",
      *error);
}

std::vector<scene::Chart> charts_of(const View& v) {
  std::vector<scene::Chart> charts;
  const std::string name = v.scene.name + ": ";
  if (largest_stress(v))
    charts = {{"flow_curve.svg",
               name + "flow curve",
               "shear rate (1/s)",
               "shear stress (Pa)",
               {"shear_stress_Pa"},
               {},
               {},
               "",
               "shear_rate_per_s"},
              {"stress.svg", name + "shear stress", "time (s)", "shear stress (Pa)", {"shear_stress_Pa"}}};
  if (v.scene.cell.mix.thixotropy)
    charts.push_back(
        {"flocculation.svg", name + "flocculation", "time (s)", "flocculation state λ", {"flocculation"}});
  return charts;
}

/// The result under the names of timeseries.csv and summary.json.
scene::Outcome outcome(const Scene& scene, const CellResult& result) {
  const View view{scene, result};
  scene::Outcome o;
  o.apparatus = "cell";
  read_into(readings(), view, o);
  o.asked = scene.name + ", one material cell";
  o.has_points = false;
  scene::add_reasons<View>({update_is_off, reference_gave_up, stress_is_off}, view, o.checks.reasons);
  o.cost.steps = result.steps;
  o.cost.points = 1;
  o.cost.simulated = result.samples.back().time;
  o.charts = charts_of(view);
  return o;
}

std::vector<std::string> uses(const std::any& any_scene) {
  const MaterialCell& cell = std::any_cast<Scene>(&any_scene)->cell;
  return {fmt::format("{} pieces of the history; no points, no grid", cell.history.size()),
          fmt::format("flocculation: {}",
                      cell.mix.thixotropy ? "computed, and by CVODE beside it" : "not computed"),
          cell.mix.G > 0.0
              ? fmt::format("below the yield stress: elastic, {:g} Pa, and by CVODE beside it", cell.mix.G)
              : "below the yield stress: rigid (no mix.shear_modulus)"};
}

}  // namespace

scene::Apparatus apparatus() {
  scene::Apparatus cell = scene::apparatus_of(keys(), "material cell", readings());
  cell.read = [](scene::Loaded& loaded) -> std::any { return build(loaded); };
  cell.uses = uses;
  cell.run = [](const std::any& any_scene, const scene::RunOptions&, const scene::Observer&) {
    const Scene& scene = *std::any_cast<Scene>(&any_scene);
    return outcome(scene, run(scene));
  };
  return cell;
}

}  // namespace tremie::cell
