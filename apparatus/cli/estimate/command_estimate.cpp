// tremie estimate: yield stress and plastic viscosity from a slump flow, in milliseconds.

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/estimate/estimate.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::cli {
namespace {

using Json = nlohmann::ordered_json;
using scene::Dimension;

struct Options {
  std::string spread, t500, density, spread_error, t500_error;
  bool json = false;
};

estimate::Measured measured_of(const Options& o) {
  estimate::Measured m;
  m.spread = *quantity("--spread", o.spread, Dimension::length);
  if (m.spread <= 0.2) throw scene::InputError("--spread: must be more than the cone's 200 mm at its bottom");
  m.t500 = quantity("--t500", o.t500, Dimension::time);
  m.density = quantity("--density", o.density, Dimension::density).value_or(m.density);
  m.spread_error = quantity("--spread-error", o.spread_error, Dimension::length).value_or(m.spread_error);
  m.t500_error = quantity("--t500-error", o.t500_error, Dimension::time).value_or(m.t500_error);
  if (!m.t500 && !o.t500_error.empty()) throw scene::InputError("--t500-error: goes with --t500");
  return m;
}

Json json_of(const std::optional<estimate::Interval>& i) {
  if (!i) return nullptr;
  return {{"value", i->value}, {"ci95", {i->low, i->high}}};
}

void print_json(const estimate::Estimate& e) {
  const Json json{{"results",
                   {{"yield_stress_Pa", json_of(e.tau_0)},
                    {"plastic_viscosity_Pa_s", json_of(e.mu)},
                    {"yield_stress_thin_layer_law_Pa", e.tau_0_thin_layer},
                    {"yield_stress_with_plug_stress_Pa", e.tau_0_plug}}},
                  {"checks", {{"reasons", e.reasons}}}};
  fmt::print("{}\n", json.dump(2));
}

void print_interval(const char* name, const std::optional<estimate::Interval>& i, const char* unit,
                    const char* none) {
  if (i)
    fmt::print("{:<24} {:.3g} {} [{:.3g}, {:.3g}]\n", name, i->value, unit, i->low, i->high);
  else
    fmt::print("{:<24} {}\n", name, none);
}

void print_text(const Options& o, const estimate::Estimate& e) {
  print_interval("yield stress", e.tau_0, "Pa", "not in the table");
  print_interval("plastic viscosity", e.mu, "Pa.s", o.t500.empty() ? "takes --t500" : "not in the table");
  fmt::print("{:<24} {:.3g} Pa (thin layer at rest, Roussel and Coussot)\n", "by the closed forms",
             e.tau_0_thin_layer);
  fmt::print("{:<24} {:.3g} Pa (with the plug's normal stress)\n", "", e.tau_0_plug);
}

int run(const Options& options) {
  const auto result =
      estimate::estimate(estimate::find_slump_table(scene::data_folders()), measured_of(options));
  options.json ? print_json(result) : print_text(options, result);
  for (const auto& reason : result.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
  return result.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_estimate(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<Options>();
  Command command(app, "estimate", "Yield stress and plastic viscosity from a slump flow, by a table");
  command.required("--spread", o->spread, "Slump flow: \"590 mm\"");
  command.option("--t500", o->t500, "Time to 500 mm from the start of the lift: \"2.5 s\"");
  command.option("--density", o->density, "\"2400 kg/m3\" by default");
  command.option("--spread-error", o->spread_error, "One standard error, \"15 mm\" by default");
  command.option("--t500-error", o->t500_error, "One standard error, \"0.2 s\" by default");
  command.flag("--json", o->json, "Print one JSON object");
  command.example("tremie estimate --spread \"590 mm\" --t500 \"2.5 s\"");
  command.run([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace tremie::cli
