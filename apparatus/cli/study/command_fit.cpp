#include "apparatus/cli/study/command_fit.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/charts.hpp"
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
  std::string kinetics = "auto", critical_shear_rate;
  bool quiet = false, force = false;
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
  in.choose_kinetics = o.kinetics == "auto";
  in.kinetics = o.kinetics == "roussel" ? Kinetics::roussel
                : o.kinetics == "power" ? Kinetics::power
                                        : Kinetics::gated;
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

Json json_of(const std::optional<Estimate>& e) {
  if (!e) return nullptr;
  Json json{{"value", e->value}, {"ci95", nullptr}};
  if (e->ci95) json["ci95"] = {e->ci95->low, e->ci95->high};
  if (e->given) json["given"] = true;
  return json;
}

template <class T>
Json json_of(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json apparent_json(const FitResult& r) {
  if (!r.apparent) return nullptr;
  const ApparentReading& a = *r.apparent;
  Json json{{"offset_torque_N_m", a.offset_torque},
            {"offset", a.offset},
            {"method", "least squares in ln(lambda)"},
            {"shear_rate_newtonian_per_s", a.newtonian_rate},
            {"shear_rate_at_vane_per_s", json_of(a.rate_at_vane)}};
  for (const ApparentAlpha& w : a.windows)
    json["windows"].push_back({{"window_s", w.window},
                               {"coefficient_per_s", w.coefficient},
                               {"alpha_newtonian_rate", w.alpha_newtonian_rate},
                               {"alpha_rate_at_vane", json_of(w.alpha_rate_at_vane)}});
  return json;
}

Json dropped_json(const FitResult& r) {
  Json list = Json::array();
  const bool decay = r.kind == RecordKind::torque_decay;
  for (const DroppedPoint& p : r.dropped)
    list.push_back({{"line", p.line},
                    {decay ? "time_s" : "speed_rev_per_s", decay ? p.x : p.x / two_pi},
                    {"torque_N_m", p.torque},
                    {"reason", p.reason}});
  return list;
}

Json candidates_json(const FitResult& r) {
  Json list = Json::array();
  for (const Candidate& c : r.candidates)
    list.push_back({{"model", c.name},
                    {"parameters", c.parameters},
                    {"relative_scatter", c.scatter},
                    {"residual_correlation", c.correlation},
                    {"aicc", json_of(c.aicc)},
                    {"aicc_difference", json_of(c.difference)},
                    {"fits", c.fits},
                    {"chosen", c.chosen}});
  return list;
}

Json results_json(const FitResult& r) {
  Json j;
  j["kind"] = r.kind == RecordKind::torque_decay ? "torque_decay" : "flow_curve";
  j["yield_stress_Pa"] = json_of(r.tau_0);
  j["plastic_viscosity_Pa_s"] = json_of(r.mu);
  j["static_yield_stress_Pa"] = json_of(r.static_yield_stress);
  j["flocculation_start"] = json_of(r.lambda_0);
  j["alpha"] = json_of(r.alpha);
  j["structuration_rate_Pa_per_s"] = json_of(r.A_thix);
  j["alpha_apparent"] = r.apparent ? Json(r.apparent->windows.back().alpha_newtonian_rate) : Json(nullptr);
  j["alpha_apparent_basis"] = apparent_json(r);
  j["plug"] = json_of(r.plug);
  j["plug_below_rev_per_s"] = r.plug_below ? Json(*r.plug_below / two_pi) : Json(nullptr);
  j["sheared_radius_mm"] = r.sheared_radius ? Json(1e3 * *r.sheared_radius) : Json(nullptr);
  j["points_dropped"] = dropped_json(r);
  j["points_dropped_count"] = r.dropped_count;
  j["points_used"] = r.readings;
  j["relative_scatter"] = r.scatter;
  j["residual_correlation"] = r.correlation;
  j["effective_readings"] = r.effective_readings;
  j["model"] = r.model;
  j["exponent"] = json_of(r.exponent);
  j["models"] = candidates_json(r);
  j["choice"] = r.choice;
  j["notes"] = r.notes;
  return j;
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

void print_estimate_if(const std::optional<Estimate>& e, const char* name, const char* unit) {
  if (e) print_estimate(name, e, unit);
}

void print_candidates(const FitResult& r) {
  if (r.candidates.size() > 1) {
    fmt::print("{:<22} {:>10} {:>9} {:>11} {:>8} {:>8}\n", "model", "parameters", "scatter", "correlation",
               "AICc", "fits");
    for (const Candidate& c : r.candidates)
      fmt::print("{:<22} {:>10} {:>7.2f} % {:>11.2f} {:>8} {:>8}\n", (c.chosen ? "* " : "  ") + c.name, c.parameters,
                 100.0 * c.scatter, c.correlation, c.difference ? fmt::format("+{:.1f}", *c.difference) : "-",
                 c.fits ? "yes" : "no");
  }
  if (!r.choice.empty()) fmt::print("{:<22} {}\n", "chosen", r.choice);
}

void print_result(const FitResult& r) {
  print_candidates(r);
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
  print_estimate_if(r.exponent, "exponent n", "");
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
  watch.stop(outcome.cost);
  Json summary = summary_of(outcome);
  summary["results"] = results_json(result);
  summary["input"] = input_json(options, in);
  io::write_text(folder.staging() / "summary.json", summary.dump(2) + "\n");
  folder.publish();
  for (const auto& reason : result.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
  if (!options.quiet) {
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
      ->check(CLI::IsMember({"auto", "gated", "roussel", "power"}));
  command->add_option("--critical-shear-rate", o->critical_shear_rate,
                      "of the gated kinetics, \"0.1 1/s\" by default");
  command->add_option("--out", o->out, "Folder for the result (default: runs/<record's name>)");
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  command->add_flag("--force", o->force, "Replace an earlier result in the folder");
  command->callback([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace tremie::cli
