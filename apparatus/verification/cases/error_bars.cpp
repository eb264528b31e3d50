// Case 11: is the error bar of `tremie run --with-error` honest? The answer on cells of half the size must
// lie inside it.

#include <fmt/format.h>

#include <cmath>

#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/verification/suite.hpp"

namespace tremie::verification {
namespace {

struct Trial {
  std::string name, scene;
  std::string reading;
};

std::vector<Trial> trials(Depth depth) {
  std::vector<Trial> all;
  for (const char* mix : {"mix_a", "mix_b", "mix_c"})
    for (const double across : {20.0, 15.0, 10.0}) {
      if (across == 10.0 && depth == Depth::quick) continue;
      all.push_back(
          {fmt::format("slump, {}, {:g} x {:g} mm", mix, across, 0.5 * across),
           fmt::format("apparatus = \"slump_flow\"\nmix = \"{}\"\n[test]\nduration = \"10 s\"\n[model]\n"
                       "cell = [\"{:g} mm\", \"{:g} mm\"]\n[output]\nframes = false\n",
                       mix, across, 0.5 * across),
           "spread_mm"});
    }
  for (const double cell : {8.0, 4.0, 2.0})
    all.push_back(
        {fmt::format("vane (Couette), mix_a after 240 s, {:g} mm", cell),
         fmt::format("apparatus = \"icar_vane\"\nmix = \"mix_a\"\n[test]\nrest = \"240 s\"\nduration = \"5 "
                     "s\"\n[model]\nspace = \"couette\"\ncell = \"{:g} mm\"\n[output]\nframes = false\n",
                     cell),
         "torque_end_N_m"});
  return all;
}

double reading_of(const scene::Outcome& outcome, const std::string& name) {
  return scene::find_number(outcome, name).value_or(std::nan(""));
}

}  // namespace

Case error_bars_case(Depth depth) {
  Table table{.name = "Error bars against the answer on cells of half the size",
              .text = "",
              .columns = {"scene", "value", "bar", "finer", "inside", "extra CPU", "basis"}};
  int inside = 0, n = 0;
  for (const Trial& trial : trials(depth)) {
    const auto scene = scene::read_text(trial.scene, trial.name);
    const auto outcome = scene::run(scene);
    const auto estimate = scene::estimate_error(scene, outcome);
    const double value = reading_of(outcome, trial.reading);
    const double finer = reading_of(scene::run(scene::coarsened(scene, 0.5)), trial.reading);
    double bar = 0.0;
    for (const auto& b : estimate.bars)
      if (b.name == trial.reading) bar = b.error;
    const bool holds = std::abs(finer - value) <= bar;
    inside += holds;
    ++n;
    table.rows.push_back({trial.name, fmt::format("{:.4g}", value), fmt::format("± {:.2g}", bar),
                          fmt::format("{:.4g}", finer), holds ? "yes" : "**no**",
                          fmt::format("{:.0f} %", 100.0 * estimate.cpu / outcome.cost.cpu),
                          estimate.basis.substr(0, estimate.basis.find(';'))});
  }
  table.text = fmt::format("{} of {} finer answers lie inside the bar.", inside, n);
  table.bounds = {{.what = "bars that do not hold", .value = static_cast<double>(n - inside), .limit = 1.0}};
  return {11, "Error bars", {}, {table}};
}

}  // namespace tremie::verification
