#pragma once

// What every test that lifts a cone shows beside its readings, and how its scene is read.

#include <string>
#include <vector>

#include "apparatus/common/flow_readings.hpp"
#include "apparatus/parts/cone/cone_test.hpp"
#include "apparatus/scene/keys.hpp"

namespace tremie::cone {

inline constexpr const char* time_label = "time since the start of the lift (s)";

using View = scene::RunView<Scene, Outcome>;

/// Spread and height over time and at the end.
template <class V>
scene::Reading<V> spread_row() {
  return {.name = "spread_mm",
          .words = "slump flow, mean diameter",
          .value = [](const V& v) { return scene::number(v.r.spread, scene::mm); },
          .at = [](const V&, const Sample& s) { return s.spread * scene::mm; },
          .label = "spread",
          .answer = [](const V&) { return std::optional(std::string()); },
          .headline = 1,
          .measurable = true};
}

/// When the spread has reached a diameter.
template <class V>
scene::Reading<V> time_row(const char* name, const char* words, const char* label,
                           scene::ResultValue (*time)(const V&)) {
  return {.name = name,
          .words = words,
          .value = time,
          .label = label,
          .digits = 2,
          .none = scene::not_reached<V>,
          .headline_digits = 2,
          .measurable = true};
}

template <class V>
scene::Reading<V> t500_row() {
  scene::Reading<V> row = time_row<V>("t500_s", "t500, time to a diameter of 500 mm", "t500",
                                      [](const V& v) { return scene::number(v.r.t500); });
  row.headline = 3;
  return row;
}

/// The charts over time: spread with what was measured, shear rate, flocculation.
std::vector<scene::Chart> charts_of(const Scene& scene, std::vector<scene::Reference> measured_spread);

/// The cone seen from the side as it rises, and the circle of 500 mm.
scene::Stage stage_of(const Scene& scene);

/// What the scene carries and what it leaves out, a line each.
std::vector<std::string> uses(const Scene& scene);

/// [cone] and [test].
scene::Schema sections();

/// Defaults that follow from other keys: cells in three dimensions, precision, mix and floor.
void settle(scene::Values& values);

/// Checked values as a scene. Throws InputError where several values contradict each other.
Scene read_scene(const scene::Values& values);

}  // namespace tremie::cone
