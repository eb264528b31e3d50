#include "apparatus/cli/study/command_fit.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/charts.hpp"
#include "apparatus/cli/study/fit_report.hpp"
#include "apparatus/report/fit_results.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/io/write_error.hpp"
#include "rheometer/fits/fit.hpp"

namespace tremie::cli {
namespace {

using Json = nlohmann::ordered_json;
using scene::Dimension;
constexpr double two_pi = 2.0 * std::numbers::pi;

struct Options {
  std::string data, out;
  std::string vane_radius, vane_height, container_radius, speed, rest, yield_stress, plastic_viscosity;
  std::string kinetics = "gated", critical_shear_rate;
  bool quiet = false, json = false, force = false;
};

// --- in
// ---------------------------------------------------------------------------------------------------------

FitInput input_of(const Options& o) {
  FitInput in;
  in.instrument.vane_radius =
      quantity("--vane-radius", o.vane_radius, Dimension::length).value_or(in.instrument.vane_radius);
  in.instrument.vane_height =
      quantity("--vane-height", o.vane_height, Dimension::length).value_or(in.instrument.vane_height);
  in.instrument.container_radius = quantity("--container-radius", o.container_radius, Dimension::length)
                                       .value_or(in.instrument.container_radius);
  in.omega = quantity("--speed", o.speed, Dimension::rotation);
  in.rest = quantity("--rest", o.rest, Dimension::time);
  in.tau_0 = quantity("--yield-stress", o.yield_stress, Dimension::pressure);
  in.mu = quantity("--plastic-viscosity", o.plastic_viscosity, Dimension::viscosity);
  in.kinetics = o.kinetics == "roussel" ? Kinetics::roussel : Kinetics::gated;
  in.gamma_c = quantity("--critical-shear-rate", o.critical_shear_rate, Dimension::rate).value_or(in.gamma_c);
  return in;
}

/// Faults of the record and of the options are the user's to mend.
FitResult read_and_fit(const Options& o, FitInput& in) {
  try {
    const TorqueRecord record = read_torque_record(o.data);
    if (!in.omega && record.speed > 0.0) in.omega = record.speed;
    FitResult result = fit(record, in);
    result.notes.insert(result.notes.begin(), record.understood.begin(), record.understood.end());
    return result;
  } catch (const RecordError& error) {
    throw scene::InputError(error.what());
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(o.data + ": " + error.what());
  }
}

// --- out
// --------------------------------------------------------------------------------------------------------

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

/// What the fit was told, the defaults included: a fit can be repeated from its summary.
Json input_json(const Options& o, const FitInput& in) {
  return {{"record", o.data},
          {"vane_radius_mm", 1e3 * in.instrument.vane_radius},
          {"vane_height_mm", 1e3 * in.instrument.vane_height},
          {"container_radius_mm", 1e3 * in.instrument.container_radius},
          {"speed_rev_per_s", in.omega ? Json(*in.omega / two_pi) : Json(nullptr)},
          {"rest_s", json_of(in.rest)},
          {"yield_stress_Pa", json_of(in.tau_0)},
          {"plastic_viscosity_Pa_s", json_of(in.mu)},
          {"kinetics", o.kinetics},
          {"critical_shear_rate_per_s", in.gamma_c}};
}

void print_estimate(const char* name, const std::optional<Estimate>& e, const char* unit) {
  if (!e)
    fmt::print("{:<22} not told by this record\n", name);
  else if (e->given)
    fmt::print("{:<22} {:.4g} {} (given)\n", name, e->value, unit);
  else if (!e->ci95)
    fmt::print("{:<22} {:.4g} {} (no interval: as many readings as parameters)\n", name, e->value, unit);
  else
    fmt::print("{:<22} {:.4g} {} [{:.4g}, {:.4g}]\n", name, e->value, unit, e->ci95->low, e->ci95->high);
}

void print_result(const FitResult& r) {
  print_estimate("yield stress", r.tau_0, "Pa");
  print_estimate("plastic viscosity", r.mu, "Pa.s");
  if (r.kind == RecordKind::torque_decay) {
    print_estimate("static yield stress", r.static_yield_stress, "Pa");
    print_estimate("flocculation at start", r.lambda_0, "");
    print_estimate("alpha", r.alpha, "");
    print_estimate("A_thix", r.A_thix, "Pa/s");
    if (r.apparent) {
      const ApparentAlpha& all = r.apparent->windows.back();
      fmt::print(
          "{:<22} {:.4g} (exponential over {:.4g} s, shear rate 2 Omega/(1 - Ri^2/Ro^2) = {:.4g} 1/s)\n",
          "apparent alpha", all.alpha_newtonian_rate, all.window, r.apparent->newtonian_rate);
    }
  }
  if (r.plug) fmt::print("{:<22} {}\n", "plug", *r.plug ? "yes" : "no");
  fmt::print("{:<22} {} used, {} dropped, scatter {:.2g} %\n", "readings", r.readings, r.dropped_count,
             100.0 * r.scatter);
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, r.dropped.size()); ++i)
    fmt::print("{:<22} line {}: {}\n", "dropped", r.dropped[i].line, r.dropped[i].reason);
  if (r.dropped.size() > most) fmt::print("{:<22} and more, named in summary.json\n", "dropped");
  for (const auto& note : r.notes) fmt::print("{:<22} {}\n", "note", note);
}

int run(const Options& options) {
  const Stopwatch watch;
  FitInput in = input_of(options);
  const FitResult result = read_and_fit(options, in);
  const std::string name = std::filesystem::path(options.data).stem().string();
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder(options.out.empty() ? "runs/" + name : options.out, options.force);
  scene::Outcome outcome;
  outcome.apparatus = "fit";
  outcome.checks.reasons = result.reasons;
  io::write_text(folder.staging() / "fit.csv", fit_csv(result, in.instrument));
  const std::string note = draw(folder.staging(), fit_charts(result, in.instrument));
  io::write_text(folder.staging() / "report.html",
                 report::fit_html(fit_report(result, in.instrument, name, "tremie fit " + options.data)));
  watch.stop(outcome.cost);
  Json summary = summary_of(outcome);
  summary["results"] = report::fit_results(result);
  summary["input"] = input_json(options, in);
  io::write_text(folder.staging() / "summary.json", summary.dump(2) + "\n");
  folder.publish();
  for (const auto& reason : result.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
  if (options.json) print_result_as_json(folder.target());
  if (!options.quiet && !options.json) {
    print_result(result);
    if (!note.empty()) fmt::print("{:<22} {}\n", "note", note);
    fmt::print("{:<22} {}\n", "written to", folder.target().string());
  }
  return result.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_fit(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<Options>();
  auto* command = app.add_subcommand(fit_command.name, fit_command.description);
  command
      ->add_option("data", o->data,
                   "CSV: speed_rev_per_s,torque_N_m (flow curve) or time_s,torque_N_m (decay)")
      ->required();
  command->add_option("--vane-radius", o->vane_radius, "\"63.5 mm\" (ICAR) by default");
  command->add_option("--vane-height", o->vane_height, "\"127 mm\" (ICAR) by default");
  command->add_option("--container-radius", o->container_radius, "\"143 mm\" (ICAR) by default");
  command->add_option("--speed", o->speed, "of a torque decay: \"0.25 rev/s\"");
  command->add_option("--rest", o->rest, "before a torque decay: \"240 s\"");
  command->add_option("--yield-stress", o->yield_stress, "dynamic, where it is known: \"54 Pa\"");
  command->add_option("--plastic-viscosity", o->plastic_viscosity, "where it is known: \"35.8 Pa.s\"");
  command->add_option("--kinetics", o->kinetics, "of the flocculation")
      ->check(CLI::IsMember({"gated", "roussel"}));
  command->add_option("--critical-shear-rate", o->critical_shear_rate,
                      "of the gated kinetics, \"0.1 1/s\" by default");
  command->add_option("--out", o->out, "Folder for the result (default: runs/<record's name>)");
  add_json_option(*command, o->json);
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  command->add_flag("--force", o->force, "Replace an earlier result in the folder");
  command->footer("tremie fit torque.csv, with --speed \"0.25 rev/s\" --rest \"240 s\" for a torque decay");
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace tremie::cli
