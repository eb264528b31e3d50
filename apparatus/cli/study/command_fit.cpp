#include "apparatus/cli/study/command_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/fit/fit_output.hpp"
#include "apparatus/cli/fit/fit_protocol.hpp"
#include "apparatus/cli/fit/protocol_report.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/fit_csv.hpp"
#include "apparatus/cli/study/fit_report.hpp"
#include "apparatus/report/fit_results.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/io/write_error.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/fits/replicates.hpp"
#include "rheometer/protocol/protocol.hpp"
#include "rheometer/vane/fit_with_blades.hpp"
#include "rheometer/vane/vane_ends.hpp"

namespace tremie::cli {
namespace {

using scene::Dimension;
constexpr double two_pi = 2.0 * std::numbers::pi;

struct Options {
  std::vector<std::string> data;
  std::string out;
  std::string vane_radius, vane_height, container_radius, speed, rest, yield_stress, plastic_viscosity;
  std::string kinetics = "auto", critical_shear_rate, law = "bingham", torque_offset;
  std::string ends = "none", blades = "none", max_aggregate, compliance;
  bool protocol = false, json = false, quiet = false, force = false;
};

/// What repeats a fit of these files, to be typed where it was.
std::string repeat(const Options& o, const std::vector<std::string>& files) {
  const Options unset;
  std::string text = "tremie fit";
  for (const std::string& file : files) text += " " + file;
  const auto add = [&](const char* name, std::string Options::*member) {
    if (o.*member != unset.*member) text += fmt::format(" {} '{}'", name, o.*member);
  };
  add("--vane-radius", &Options::vane_radius);
  add("--vane-height", &Options::vane_height);
  add("--container-radius", &Options::container_radius);
  add("--speed", &Options::speed);
  add("--rest", &Options::rest);
  add("--yield-stress", &Options::yield_stress);
  add("--plastic-viscosity", &Options::plastic_viscosity);
  add("--kinetics", &Options::kinetics);
  add("--law", &Options::law);
  add("--critical-shear-rate", &Options::critical_shear_rate);
  add("--instrument-compliance", &Options::compliance);
  add("--torque-offset", &Options::torque_offset);
  add("--ends", &Options::ends);
  add("--blades", &Options::blades);
  add("--max-aggregate", &Options::max_aggregate);
  return text + (o.protocol ? " --protocol" : "");
}

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
  in.kinetics = kinetics_named(o.kinetics).value_or(Kinetics{});
  in.max_aggregate = quantity("--max-aggregate", o.max_aggregate, Dimension::length).value_or(0.0);
  in.law = o.law == "auto"               ? FlowLaw::automatic
           : o.law == "herschel_bulkley" ? FlowLaw::herschel_bulkley
                                         : FlowLaw::bingham;
  in.gamma_c = quantity("--critical-shear-rate", o.critical_shear_rate, Dimension::rate).value_or(in.gamma_c);
  return in;
}

/// [N m] with its sign; 0 where it is not given.
double torque_offset(const Options& o) {
  if (o.torque_offset.empty()) return 0.0;
  try {
    return scene::parse_quantity(o.torque_offset, Dimension::torque);
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(fmt::format("--torque-offset: {}", error.what()));
  }
}

/// [rad/(N m)], 0 where it is not given.
double compliance(const Options& o) {
  if (o.compliance.empty()) return 0.0;
  std::size_t used = 0;
  double value = -1.0;
  try {
    value = std::stod(o.compliance, &used);
  } catch (const std::logic_error&) {  // no number: told below
  }
  std::string unit = o.compliance.substr(used);
  std::erase(unit, ' ');
  if (!(value >= 0.0) || !std::isfinite(value) || unit != "rad/(N.m)")
    throw scene::InputError(fmt::format(
        "--instrument-compliance: \"{}\" is no compliance; write \"0.02 rad/(N.m)\"", o.compliance));
  return value;
}

/// Faults of the record and of the options are the user's to mend.
template <class Read>
auto as_bad_input(const std::string& file, Read read) {
  try {
    return read();
  } catch (const RecordError& error) {
    throw scene::InputError(error.what());
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(file + ": " + error.what());
  }
}

/// The first table of reference_data/`folder`, which `option` reads, as its text and its file's name.
std::pair<std::string, std::string> vane_table(const std::string& folder, const std::string& option) {
  for (const auto& data : scene::data_folders()) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(data / folder, error))
      if (entry.path().extension() == ".csv")
        return {read_text_file(entry.path().string()), entry.path().filename().string()};
  }
  throw scene::InputError(fmt::format(
      "{} computed: its table, reference_data/{}/*.csv, is not there; allowed without it: {} none", option,
      folder, option));
}

/// A note where the ends' factor is that of the table's last Bingham number.
void note_beyond_ends(const Options& o, const FitInput& in, FitResult& result) {
  if (o.ends != "computed" || !in.omega || !result.tau_0 || !result.mu) return;
  const auto [text, name] = vane_table("vane_ends", "--ends");
  const double last = largest_bingham_number(text, name),
               Bi = result.tau_0->value / (result.mu->value * *in.omega);
  if (Bi > last)
    result.notes.push_back(fmt::format(
        "ends: the Bingham number, {:.3g}, lies beyond the table's {:.3g}, whose factor is taken", Bi, last));
}

/// A note where a reading's Bingham number lies beyond the blades' table: the slowest reading's, with the largest yield stress.
void note_beyond_blades(const TorqueRecord& record, const FitInput& in, const BladeTable& table,
                        FitResult& result) {
  const auto& yield = result.static_yield_stress ? result.static_yield_stress : result.tau_0;
  double slowest = in.omega.value_or(0.0);
  for (const double omega : record.omega)
    if (omega > 0.0 && (slowest <= 0.0 || omega < slowest)) slowest = omega;
  if (!yield || !result.mu || !(slowest > 0.0)) return;
  const double last = largest_bingham_number(table, in.instrument);
  const double Bi = yield->value / (result.mu->value * slowest);
  if (Bi > 1.001 * last)
    result.notes.push_back(fmt::format(
        "blades: the Bingham number, up to {:.3g}, lies beyond the table's {:.3g}, whose factor is taken", Bi,
        last));
}

/// The fit of a vane: of the torques that its cylinder would have taken, where the blades are corrected for.
FitResult fit_vane(const Options& o, const TorqueRecord& record, const FitInput& in) {
  if (o.blades == "none") {
    FitResult result = fit(record, in);
    result.notes.push_back(
        o.ends == "none" ? taken_for_a_cylinder
                         : "the ends alone are corrected: a vane with blades takes 15 to 30 % less than the "
                           "cylinder of this fit, which --blades computed corrects");
    return result;
  }
  const auto [text, name] = vane_table("vane_blades", "--blades");
  const BladeTable table = blade_table(text, name);
  VaneFit vane = fit_with_blades(record, in, table);
  vane.fit.notes.push_back(
      fmt::format("torques are the cylinder's: the record's divided by {:.3f} to {:.3f}, what four thin "
                  "blades take of it",
                  vane.least_factor, vane.most_factor));
  note_beyond_blades(record, in, table, vane.fit);
  if (vane.fit.alpha && !vane.fit.alpha->given)
    vane.fit.notes.push_back(
        "alpha: with blades it reads some 30 % too small, more than its interval: what stands between the "
        "blades is not broken down; without --blades the two errors nearly cancel");
  return vane.fit;
}

/// A flow curve as it would be if the ends carried at every speed what they carry at the middle one, for which `factor`
/// stands in the vane's height: each torque over what its own Bingham number has, by the values of `fitted`.
TorqueRecord with_even_ends(const TorqueRecord& record, const FitInput& in, double factor,
                            const FitResult& fitted) {
  const auto [text, name] = vane_table("vane_ends", "--ends");
  Instrument vane = in.instrument;
  vane.vane_height /= factor;
  TorqueRecord even = record;
  for (std::size_t i = 0; i < record.omega.size(); ++i)
    if (record.omega[i] > 0.0)
      even.torque[i] *= factor / end_factor_from_table(text, name, vane,
                                                       std::max(0.0, fitted.tau_0->value) /
                                                           (fitted.mu->value * record.omega[i]));
  return even;
}

/// `factor`: of the ends, which is in the height of `in` already; 1 for none.
FitResult read_and_fit(const Options& o, const std::string& file, FitInput in, double factor) {
  return as_bad_input(file, [&] {
    const TorqueRecord record = read_torque_record(file, torque_offset(o));
    if (!in.omega && record.speed > 0.0) in.omega = record.speed;
    FitResult result = fit_vane(o, record, in);
    if (o.ends == "computed" && factor != 1.0 && record.kind == RecordKind::flow_curve && result.tau_0 &&
        result.mu && result.mu->value > 0.0)
      result = fit_vane(o, with_even_ends(record, in, factor, result), in);
    note_beyond_ends(o, in, result);
    result.notes.insert(result.notes.begin(), record.understood.begin(), record.understood.end());
    return result;
  });
}

// --- the ends of the vane

constexpr double usual_bingham_number = 1.0;

/// tau_0/(mu Omega) of the record at the middle of its speeds, by what is given or by a fit without ends, whose quotient
/// the ends leave as it is; that of usual concrete where the record tells no viscosity or is a protocol's.
double bingham_number(const Options& o, const FitInput& in) {
  std::optional<double> tau_0 = in.tau_0, mu = in.mu, omega = in.omega;
  if (!o.protocol) {
    const FitResult none = read_and_fit(o, o.data.front(), in, 1.0);
    if (none.tau_0) tau_0 = none.tau_0->value;
    if (none.mu) mu = none.mu->value;
    std::vector<double> speeds = none.curve.x;
    if (none.kind == RecordKind::flow_curve && !speeds.empty()) {
      std::nth_element(speeds.begin(), speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2),
                       speeds.end());
      omega = speeds[speeds.size() / 2];
    }
  }
  if (!tau_0 || !mu || !omega || *mu <= 0.0 || *omega <= 0.0) return usual_bingham_number;
  return std::max(0.0, *tau_0 / (*mu * *omega));
}

/// The factor of the ends on the height of the vane.
double end_factor(const Options& o, const FitInput& in) {
  if (o.ends == "textbook") return textbook_end_factor(in.instrument);
  if (o.ends == "none") return 1.0;
  return as_bad_input("--ends computed", [&] {
    const auto [text, name] = vane_table("vane_ends", "--ends");
    return end_factor_from_table(text, name, in.instrument, bingham_number(o, in));
  });
}

/// By how much the ends move each value: the same fit without them, beside the fit with them.
Json ends_json(const Options& o, const std::string& file, const FitInput& in, double factor,
               const FitResult& with) {
  FitInput without = in;
  without.instrument.vane_height /= factor;
  const FitResult none = read_and_fit(o, file, without, 1.0);
  Json moves;
  const auto add = [&](const char* key, const std::optional<Estimate>& a, const std::optional<Estimate>& b) {
    if (a && b && !a->given) moves[key] = {{"without_ends", b->value}, {"change", a->value / b->value - 1.0}};
  };
  add("yield_stress_Pa", with.tau_0, none.tau_0);
  add("plastic_viscosity_Pa_s", with.mu, none.mu);
  add("consistency_Pa_s_n", with.consistency, none.consistency);
  add("flow_index", with.flow_index, none.flow_index);
  add("static_yield_stress_Pa", with.static_yield_stress, none.static_yield_stress);
  add("flocculation_start", with.lambda_0, none.lambda_0);
  add("alpha", with.alpha, none.alpha);
  add("structuration_rate_Pa_per_s", with.A_thix, none.A_thix);
  return moves;
}

// --- out
// --------------------------------------------------------------------------------------------------------

/// What the fit was told, the defaults included: a fit can be repeated from its summary.
Json input_json(const Options& o, const FitInput& in) {
  return {{"record", o.data.size() == 1 ? Json(o.data.front()) : Json(o.data)},
          {"vane_radius_mm", 1e3 * in.instrument.vane_radius},
          {"vane_height_mm", 1e3 * in.instrument.vane_height},
          {"container_radius_mm", 1e3 * in.instrument.container_radius},
          {"speed_rev_per_s", in.omega ? Json(*in.omega / two_pi) : Json(nullptr)},
          {"rest_s", json_of(in.rest)},
          {"yield_stress_Pa", json_of(in.tau_0)},
          {"plastic_viscosity_Pa_s", json_of(in.mu)},
          {"kinetics", o.kinetics},
          {"law", o.law},
          {"ends", o.ends},
          {"blades", o.blades},
          {"torque_offset_N_m", torque_offset(o)},
          {"critical_shear_rate_per_s", in.gamma_c}};
}

/// What a fit gives: the JSON of results, reasons, files with the charts, and lines for the screen.
struct Answer {
  Json results;
  std::vector<std::string> reasons;
  std::vector<std::pair<std::string, std::string>> files;
  std::function<void()> print;
};

std::string percent(const std::optional<double>& v) { return v ? fmt::format("{:.2g} %", 100.0 * *v) : "-"; }

void print_moves(const Json& moves, const Options& o, double factor) {
  if (o.ends == "none") return;
  fmt::print("{:<22} {}: torque {:.4g} times that of the side", "ends", o.ends, factor);
  for (const auto& [key, move] : moves.items())
    fmt::print("; {} {:+.1f} %", key, 100.0 * move["change"].get<double>());
  fmt::print("\n");
}

Answer one_record(const Options& o, const FitInput& in, double factor) {
  const std::string& file = o.data.front();
  auto result = std::make_shared<FitResult>(read_and_fit(o, file, in, factor));
  const report::FitReport page = fit_report(*result, in.instrument, file, repeat(o, {file}));
  Answer a{report::fit_results(*result), result->reasons, report::fit_chart_files(page), {}};
  a.files.emplace_back("fit.csv", fit_csv(*result));
  a.files.emplace_back("report.html", report::fit_html(page));
  const Json moves = o.ends == "none" ? Json() : ends_json(o, file, in, factor, *result);
  a.results["ends"] = {{"correction", o.ends}, {"factor", factor}, {"moves", moves}};
  a.results["blades"] = {{"correction", o.blades}};
  a.print = [=] {
    print_result(*result);
    print_moves(moves, o, factor);
  };
  return a;
}

Answer protocol(const Options& o, FitInput in, double factor) {
  const std::string& file = o.data.front();
  ProtocolOptions options;
  options.compliance = compliance(o);
  ProtocolRecord record;
  auto reading = std::make_shared<ProtocolReading>(as_bad_input(file, [&] {
    record = parse_protocol_record(read_text_file(file), file, torque_offset(o));
    return read_protocol(record, in, options);
  }));
  Answer a{protocol_json(*reading), reading->reasons, protocol_chart_files(record, *reading), {}};
  a.files.emplace_back("sections.csv", protocol_csv(*reading));
  a.files.emplace_back("report.html", protocol_html(record, *reading, file, repeat(o, {file})));
  a.results["understood"] = record.understood;
  a.results["ends"] = {{"correction", o.ends}, {"factor", factor}};
  a.print = [=, understood = record.understood] {
    print_protocol(*reading);
    print_moves(Json(), o, factor);
    for (const auto& note : understood) fmt::print("{:<22} {}\n", "read", note);
  };
  return a;
}

Answer replicates(const Options& o, const FitInput& in, double factor) {
  std::vector<FitResult> fits;
  std::vector<report::FitReport> reports;
  Answer a;
  a.results = {{"kind", "replicates"}, {"records", Json::array()}};
  for (const std::string& file : o.data) {
    fits.push_back(read_and_fit(o, file, in, factor));
    Json one{{"record", file}};
    one.update(report::fit_results(fits.back()));
    a.results["records"].push_back(one);
    for (const auto& why : fits.back().reasons) a.reasons.push_back(file + ": " + why);
    a.files.emplace_back(fmt::format("fit_{}.csv", fits.size()), fit_csv(fits.back()));
    reports.push_back(fit_report(fits.back(), in.instrument, file, repeat(o, {file})));
    a.files.emplace_back(fmt::format("report_{}.html", fits.size()), report::fit_html(reports.back()));
  }
  const std::vector<ReplicateMean> means = replicate_means(fits);
  Json& mean = a.results["mean"] = Json::object();
  for (const ReplicateMean& m : means) {
    mean[m.name] = json_of(std::optional(m.mean));
    mean[m.name].update({{"unit", m.unit},
                         {"records", m.records},
                         {"scatter_between", json_of(m.between)},
                         {"scatter_within", json_of(m.within)},
                         {"scatter_between_laboratories", json_of(m.laboratories)}});
  }
  a.files.emplace_back("report.html",
                       report::replicates_html(replicates_report(fits, means, reports, repeat(o, o.data))));
  a.results["ends"] = {{"correction", o.ends}, {"factor", factor}};
  a.results["blades"] = {{"correction", o.blades}};
  a.print = [=] {
    for (std::size_t i = 0; i < fits.size(); ++i) {
      fmt::print("--- {}\n", o.data[i]);
      print_result(fits[i]);
    }
    fmt::print("--- mean of {} records\n{:<22} {:>10} {:>24} {:>9} {:>9} {:>13}\n", fits.size(), "", "mean",
               "95 %", "between", "within", "laboratories");
    for (const ReplicateMean& m : means)
      fmt::print("{:<22} {:>10} {:>24} {:>9} {:>9} {:>13}\n", m.name, scene::rounded(m.mean.value, 4),
                 m.mean.ci95 ? fmt::format("[{}, {}] {}", scene::rounded(m.mean.ci95->low, 4),
                                           scene::rounded(m.mean.ci95->high, 4), m.unit)
                             : "-",
                 percent(m.between), percent(m.within), percent(m.laboratories));
    fmt::print(
        "between laboratories one cement paste scattered by 27 % in yield stress and 24 % in viscosity "
        "(Haist et al. 2020)\n");
  };
  return a;
}

int run(const Options& options) {
  const Stopwatch watch;
  FitInput in = input_of(options);
  if (options.protocol && options.data.size() > 1)
    throw scene::InputError("--protocol reads one record; " + std::to_string(options.data.size()) +
                            " are given");
  if (options.blades != "none" && (options.protocol || options.law != "bingham"))
    throw scene::InputError("--blades computed is for a flow curve by Bingham's law, or a decay; not with " +
                            std::string(options.protocol ? "--protocol" : "--law " + options.law));
  as_bad_input("the instrument", [&] {
    check(in.instrument);
    return 0;
  });
  const double factor = end_factor(options, in);
  const Json given = input_json(options, in);
  in.instrument.vane_height *= factor;  // torque and height enter all formulas as their quotient
  const Answer answer = options.protocol          ? protocol(options, in, factor)
                        : options.data.size() > 1 ? replicates(options, in, factor)
                                                  : one_record(options, in, factor);
  const std::string name = std::filesystem::path(options.data.front()).stem().string();
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder(options.out.empty() ? "runs/" + name : options.out, options.force);
  scene::Outcome outcome;
  outcome.apparatus = "fit";
  outcome.checks.reasons = answer.reasons;
  for (const auto& [file, text] : answer.files) io::write_text(folder.staging() / file, text);
  watch.stop(outcome.cost);
  Json summary = summary_of(outcome);
  summary["results"] = answer.results;
  summary["input"] = given;
  io::write_text(folder.staging() / "summary.json", summary.dump(2) + "\n");
  folder.publish();
  for (const auto& reason : answer.reasons) fmt::print(stderr, "not to be trusted: {}\n", reason);
  if (options.json) {
    print_result_as_json(folder.target());
  } else if (!options.quiet) {
    answer.print();
    fmt::print("{:<22} {}\n", "written to", folder.target().string());
  }
  return answer.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_fit(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<Options>();
  Command command(app, fit_command.name, fit_command.description);
  command.required("data", o->data,
                   "CSV or an instrument's export: speed and torque (flow curve), time and torque (decay), "
                   "or all three; several files are replicates");
  command.option("--vane-radius", o->vane_radius, "\"63.5 mm\" (ICAR) by default");
  command.option("--vane-height", o->vane_height, "\"127 mm\" (ICAR) by default");
  command.option("--container-radius", o->container_radius, "\"143 mm\" (ICAR) by default");
  command.option("--speed", o->speed, "of a torque decay: \"0.25 rev/s\"");
  command.option("--rest", o->rest, "before a torque decay: \"240 s\"");
  command.option("--yield-stress", o->yield_stress, "dynamic, where it is known: \"54 Pa\"");
  command.option("--plastic-viscosity", o->plastic_viscosity, "where it is known: \"35.8 Pa.s\"");
  std::vector<std::string> kinetics = kinetics_words();
  kinetics.insert(kinetics.begin(), "auto");
  command.choice("--kinetics", o->kinetics, kinetics, "of the flocculation");
  command.choice("--law", o->law, {"auto", "bingham", "herschel_bulkley"},
                 "of a flow curve: the law, or both compared");
  command.option("--critical-shear-rate", o->critical_shear_rate,
                 "of the gated kinetics, \"0.1 1/s\" by default");
  command.flag("--protocol", o->protocol, "Read every section of a record with time, speed and torque");
  command.option("--instrument-compliance", o->compliance,
                 "the instrument's own turn by torque: \"0.02 rad/(N.m)\"");
  command.option("--torque-offset", o->torque_offset, "of the unloaded instrument, taken off: \"0.3 mN.m\"");
  command.choice("--ends", o->ends, {"none", "textbook", "computed"}, "what the ends of the vane carry");
  command.choice(
      "--blades", o->blades, {"none", "computed"},
      "what blades take less than the cylinder that they span; with --ends computed for a real vane");
  command.option("--max-aggregate", o->max_aggregate, "largest grain, to judge the gap by: \"16 mm\"");
  add_json_option(command, o->json);
  command.option("--out", o->out, "Folder for the result (default: runs/<record's name>)");
  command.flag("--quiet", o->quiet, "Print nothing but errors");
  command.flag("--force", o->force, "Replace an earlier result in the folder");
  command.example("tremie fit torque.csv, with --speed \"0.25 rev/s\" --rest \"240 s\" for a torque decay");
  command.run([o, &exit_code] { exit_code = run(*o); });
}

}  // namespace tremie::cli
