// What the web page calls: a scene as TOML in, summary.json out, and the points on the way. One thread.

#include <algorithm>
#include <any>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "apparatus/estimate/estimate.hpp"
#include "apparatus/estimate/estimate_json.hpp"
#include "apparatus/parts/cone/cone_test.hpp"
#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/summary.hpp"
#include "apparatus/scene/load.hpp"

// Written in JavaScript (callbacks.js). Texts are UTF-8 and the callee's to copy.
extern "C" {
/// Simulated time of a run of so many [s]; `run` is 0 for the scene's, 1 for those of its error bar.
void tremie_page_progress(double time, double duration, int run);
/// n points, four numbers each: r and z [m], shear rate [1/s], flocculation (0 without thixotropy).
void tremie_page_frame(double time, int n, const float* points);
void tremie_page_result(const char* json);
void tremie_page_error(const char* message);
}

namespace {

using namespace tremie;

/// Simulated time between two frames [s]: the concrete spreads within one second. A long test has fewer, which the
/// browser must hold all.
constexpr double page_frame_interval = 0.1, most_frames = 600.0;

void hand_over(const Frame& frame) {
  std::vector<float> points;
  points.reserve(4 * frame.position.size());
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    const auto& x = frame.position[p];
    points.push_back(static_cast<float>(std::hypot(x[0], x[1])));
    points.push_back(static_cast<float>(x[2]));
    points.push_back(static_cast<float>(frame.shear_rate[p]));
    points.push_back(frame.flocculation.empty() ? 0.0F : static_cast<float>(frame.flocculation[p]));
  }
  tremie_page_frame(frame.time, static_cast<int>(frame.position.size()), points.data());
}

void hand_over(const scene::Scene& scene, const scene::Outcome& outcome) {
  nlohmann::ordered_json json;
  json["summary"] = report::run_summary(outcome);
  json["scene"] = scene.resolved;
  json["notes"] = scene.notes;
  json["lines"] = outcome.lines;
  json["timeseries"] = report::columns_csv(outcome.series);
  tremie_page_result(json.dump().c_str());
}

scene::Observer observer_of_run(int run) {
  return {.on_progress = [run](const scene::Progress& p) { tremie_page_progress(p.time, p.duration, run); }};
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

void run(const char* toml, const char* overrides, bool with_error) {
  scene::Scene scene = scene::read_text(toml, "scene.toml", lines_of(overrides));
  scene.output.frames = true;
  if (auto* test = std::any_cast<cone::Scene>(&scene.test))
    test->frame_interval = std::max(page_frame_interval, test->duration / most_frames);
  scene::Observer observer = observer_of_run(0);
  observer.on_frame = [](const Frame& frame) { hand_over(frame); };
  scene::Outcome outcome = scene::run(scene, observer);
  hand_over(scene, outcome);
  if (!with_error) return;
  outcome.error = scene::estimate_error(scene, outcome, observer_of_run(1));
  hand_over(scene, outcome);
}

}  // namespace

/// Runs a scene with these values set over it, "mix.yield_stress=61 Pa", a line each: frames and progress, then its result; `with_error`: then the result again with its error
/// bars. Instead of a result an error, where the scene is not right.
extern "C" void tremie_page_run(const char* toml, const char* overrides, int with_error) {
  try {
    run(toml, overrides, with_error != 0);
  } catch (const std::exception& error) {
    tremie_page_error(error.what());
  }
}

/// `tremie estimate --json` of a spread [m] and a t500 [s], not-a-number where none was measured; errors are one standard error.
extern "C" void tremie_page_estimate(double spread, double spread_error, double t500, double t500_error,
                                     double density) {
  try {
    estimate::Measured measured{
        .spread = spread, .spread_error = spread_error, .t500_error = t500_error, .density = density};
    if (!std::isnan(t500)) measured.t500 = t500;
    const auto table = estimate::find_slump_table(scene::data_folders());
    tremie_page_result(estimate::estimate_json(estimate::estimate(table, measured)).c_str());
  } catch (const std::exception& error) {
    tremie_page_error(error.what());
  }
}

int main() {}
