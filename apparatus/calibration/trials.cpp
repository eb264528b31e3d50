#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "apparatus/calibration/calibrate.hpp"
#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/study/rows/pool.hpp"

namespace tremie::calibration {
namespace {

constexpr char mend_mark = '!';  ///< before a message for the user, in place of a row

std::vector<std::string> results_of(const Test& test) {
  std::vector<std::string> names;
  for (const Measurement& reading : test.readings) names.push_back(reading.result);
  return names;
}

std::vector<std::size_t> first(std::size_t n) {
  std::vector<std::size_t> items(n);
  std::iota(items.begin(), items.end(), std::size_t{0});
  return items;
}

std::string errors_as_text(const Lab& lab, const Test& test, const Point& point) {
  std::vector<double> errors(test.readings.size(), 0.0);
  auto scene = scene_at(lab, test, point);
  scene::set_threads(scene, 1);
  scene.output.frames = false;
  const auto estimate = scene::estimate_error(scene, scene::run(scene));
  for (const auto& bar : estimate.bars)
    for (std::size_t i = 0; i < errors.size(); ++i)
      if (test.readings[i].result == bar.name) errors[i] = 0.5 * bar.error;  // a bar is two standard errors
  return nlohmann::json(errors).dump();
}

}  // namespace

bool run_trials(const Lab& lab, const std::vector<Point>& points, const Settings& settings,
                std::vector<Trial>& trials) {
  const std::size_t tests = lab.tests.size(), before = trials.size();
  for (const Point& point : points) trials.push_back({point, std::vector<study::Row>(tests)});
  const auto work = [&](std::size_t item) -> std::string {
    const Test& test = lab.tests[item % tests];
    try {
      return study::row_json(study::run_scene([&] { return scene_at(lab, test, points[item / tests]); },
                                              results_of(test), item, lab.file.string() + ": " + test.label));
    } catch (const scene::InputError& error) {
      return mend_mark + std::string(error.what());
    }
  };
  const bool whole = study::run_pool(
      first(points.size() * tests), settings.jobs, work,
      [&](const study::Finished& finished) {
        const std::size_t readings = lab.tests[finished.item % tests].readings.size();
        if (finished.text && finished.text->starts_with(mend_mark))
          throw scene::InputError(finished.text->substr(1));
        const auto row = finished.text ? study::row_from_json(*finished.text, readings) : std::nullopt;
        trials[before + finished.item / tests].rows[finished.item % tests] =
            row ? *row : study::dead_row(readings, finished.item, finished.death);
      },
      settings.stop);
  if (!whole) trials.resize(before);
  return whole;
}

std::vector<std::vector<double>> discretisation_errors(const Lab& lab, const Point& point,
                                                       const Settings& settings) {
  std::vector<std::vector<double>> errors;
  for (const Test& test : lab.tests) errors.emplace_back(test.readings.size(), 0.0);
  study::run_pool(
      first(lab.tests.size()), settings.jobs,
      [&](std::size_t item) { return errors_as_text(lab, lab.tests[item], point); },
      [&](const study::Finished& finished) {
        if (finished.text)
          errors[finished.item] = nlohmann::json::parse(*finished.text).get<std::vector<double>>();
      },
      settings.stop);
  return errors;
}

}  // namespace tremie::calibration
