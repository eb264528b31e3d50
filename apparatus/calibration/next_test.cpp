#include "apparatus/calibration/next_test.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::calibration {
namespace {

constexpr std::size_t draws = 16;  ///< a standard deviation from as many is good to a fifth

struct Candidate {
  const char *words, *apparatus;
  std::vector<std::string> overrides;
  const char *result, *unit;
  double error, relative_error;  ///< usual in a laboratory, one standard error; the larger one counts
};

std::vector<Candidate> candidates() {
  std::vector<Candidate> list;
  for (const char* rest : {"0", "60", "240", "600"})
    list.push_back({"slump flow",
                    "slump_flow",
                    {fmt::format("test.rest={} s", rest), until_it_rests},
                    "spread_mm",
                    "mm",
                    15.0,
                    0.0});
  list.push_back({"slump flow", "slump_flow", {"test.rest=0 s"}, "t500_s", "s", 0.2, 0.0});
  list.push_back({"L-box", "l_box", {"model.cell=15 mm"}, "passing_ratio", "", 0.03, 0.0});
  for (const char* rest : {"60", "240"})
    list.push_back({"vane, peak",
                    "icar_vane",
                    {fmt::format("test.rest={} s", rest)},
                    "torque_peak_N_m",
                    "N m",
                    0.02,
                    0.05});
  return list;
}

/// Points of equal weight: the quantiles of the posterior in the order of its points.
std::vector<Point> drawn(const Posterior& posterior) {
  std::vector<Point> points;
  double sum = 0.0;
  for (std::size_t i = 0; i < posterior.points.size(); ++i) {
    sum += posterior.weights[i];
    while (points.size() < draws &&
           sum > (static_cast<double>(points.size()) + 0.5) / static_cast<double>(draws))
      points.push_back(posterior.points[i]);
  }
  return points;
}

bool can_be_read(const Lab& lab, const Test& test) {
  try {
    scene_at(lab, test, std::vector<double>(lab.unknowns.size(), 0.5));
    return true;
  } catch (const scene::InputError&) {
    return false;
  }
}

/// Without thixotropy a longer rest is the same test.
bool same_reading(const Advice& a, const Advice& b) {
  return a.result == b.result && a.value == b.value && a.scatter == b.scatter;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v / static_cast<double>(values.size());
  return sum;
}

double covariance(const std::vector<double>& a, const std::vector<double>& b) {
  const double mean_a = mean(a), mean_b = mean(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - mean_a) * (b[i] - mean_b);
  return sum / static_cast<double>(a.size() - 1);
}

/// Empty where fewer than half of the draws have the reading.
std::vector<Advice> judged(const Lab& lab, const Candidate& c, const std::vector<Trial>& trials,
                           std::size_t test) {
  std::vector<double> readings;
  std::vector<std::vector<double>> unknowns(lab.unknowns.size());
  for (const Trial& trial : trials) {
    const auto number = study::trusted_number(trial.rows[test], 0);
    if (!number) continue;
    readings.push_back(*number);
    for (std::size_t i = 0; i < unknowns.size(); ++i) unknowns[i].push_back(trial.point[i]);
  }
  if (2 * readings.size() < trials.size() || readings.size() < 4) return {};
  Advice advice;
  advice.test = c.words;
  advice.result = c.result;
  advice.unit = c.unit;
  if (c.overrides.front().starts_with("test.rest="))
    advice.test += " after " + c.overrides.front().substr(std::string("test.rest=").size());
  advice.value = mean(readings);
  const double variance = covariance(readings, readings);
  advice.scatter = std::sqrt(variance);
  advice.error = std::max(c.error, c.relative_error * advice.value);
  const double told = variance / (variance + advice.error * advice.error);
  advice.bits = -0.5 * std::log2(1.0 - told);
  for (const auto& unknown : unknowns) {
    const double own = covariance(unknown, unknown), both = covariance(unknown, readings);
    const double squared = own > 0.0 && variance > 0.0 ? both * both / (own * variance) : 0.0;
    advice.left.push_back(std::sqrt(std::max(0.0, 1.0 - squared * told)));
  }
  return {advice};
}

}  // namespace

std::vector<Advice> advise(const Lab& lab, const Calibration& calibration, const Settings& settings) {
  Lab asked = lab;
  asked.tests.clear();
  std::vector<Candidate> kept;
  for (const Candidate& c : candidates()) {
    const Test test{c.words, c.words, c.apparatus, c.overrides, {{"", c.result}}};
    if (!can_be_read(lab, test)) continue;
    asked.tests.push_back(test);
    kept.push_back(c);
  }
  std::vector<Trial> trials;
  if (asked.tests.empty() || !run_trials(asked, drawn(calibration.posterior), settings, trials)) return {};
  std::vector<Advice> list;
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (const Advice& advice : judged(lab, kept[i], trials, i))
      if (std::none_of(list.begin(), list.end(), [&](const Advice& a) { return same_reading(a, advice); }))
        list.push_back(advice);
  std::stable_sort(list.begin(), list.end(),
                   [](const Advice& a, const Advice& b) { return a.bits > b.bits; });
  return list;
}

}  // namespace tremie::calibration
