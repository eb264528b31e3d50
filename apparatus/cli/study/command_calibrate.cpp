// tremie calibrate LAB.toml: from measurements to the mix, with intervals.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <thread>

#include "apparatus/calibration/calibrate.hpp"
#include "apparatus/calibration/calibration_page.hpp"
#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

using Json = nlohmann::ordered_json;
using calibration::Calibration;
using calibration::Lab;

struct CalibrateOptions {
  std::string file, out;
  int jobs = 0;
  std::size_t runs = 0;
  bool next = false, quiet = false, json = false, force = false;
};

Json parameters_json(const Calibration& c) {
  Json json = Json::object();
  for (const auto& p : c.parameters)
    json[p.key] = {{"value", p.value}, {"ci95", {p.low, p.high}}, {"unit", p.unit}, {"told", p.told}};
  return json;
}

Json forecasts_json(const Lab& lab, const Calibration& c) {
  Json list = Json::array();
  for (std::size_t i = 0; i < c.forecasts.size(); ++i) {
    const auto& test = lab.tests[lab.measured + i];
    Json json{{"apparatus", test.apparatus}, {"set", test.overrides}};
    for (const auto& reading : c.forecasts[i])
      json[reading.result] = reading.value
                                 ? Json{{"value", *reading.value}, {"ci95", {reading.low, reading.high}}}
                                 : Json(nullptr);
    list.push_back(json);
  }
  return list;
}

Json readings_json(const Calibration& c) {
  Json list = Json::array();
  for (const auto& r : c.readings)
    list.push_back({{"test", r.test},
                    {"result", r.result},
                    {"measured", r.measured},
                    {"standard_error", r.error},
                    {"best_fit", r.best_fit},
                    {"deviation_standard_errors", r.deviation},
                    {"emulator_error", r.emulator_error},
                    {"discretisation_error", r.discretisation_error}});
  return list;
}

Json contradictions_json(const Calibration& c) {
  Json list = Json::array();
  for (const auto& x : c.contradictions)
    list.push_back({{"reading", x.reading},
                    {"result", x.result},
                    {"measured", x.measured},
                    {"forecast", x.forecast},
                    {"ci99", {x.low, x.high}}});
  return list;
}

/// By reading, in the reading's unit; `over_measurement_error` is the largest of their ratios.
Json emulator_json(const Calibration& c) {
  Json json = Json::object();
  double worst = 0.0;
  for (const auto& r : c.readings) {
    json[r.test + "." + r.result] = r.emulator_error;
    worst = std::max(worst, r.emulator_error / r.error);
  }
  json["over_measurement_error"] = worst;
  return json;
}

std::string trials_csv(const Lab& lab, const Calibration& c) {
  std::string csv = "trial";
  for (const auto& unknown : lab.unknowns) csv += fmt::format(",{}", study::column_of(unknown));
  for (const auto& test : lab.tests)
    for (const auto& reading : test.readings) csv += fmt::format(",{}.{}", test.label, reading.result);
  csv += "\n";
  for (std::size_t i = 0; i < c.trials.size(); ++i) {
    csv += fmt::format("{}", i);
    for (std::size_t j = 0; j < lab.unknowns.size(); ++j)
      csv += fmt::format(",{:.8g}", study::level_at(lab.unknowns[j], c.trials[i].point[j]).number);
    for (const auto& row : c.trials[i].rows)
      for (const auto& reading : row.readings) {
        const auto* number = std::get_if<double>(&reading);
        csv += number ? fmt::format(",{:.8g}", *number) : ",";
      }
    csv += "\n";
  }
  return csv;
}

/// The first test's scene with the calibrated values: to run, and to be named by `mix = "mix.toml"`.
std::string mix_toml(const Lab& lab, const Calibration& c) {
  std::vector<double> shares;
  for (std::size_t i = 0; i < lab.unknowns.size(); ++i)
    shares.push_back(study::share_of(lab.unknowns[i], c.parameters[i].value));
  return calibration::scene_at(lab, lab.tests.front(), shares).resolved;
}

Json advice_json(const Lab& lab, const std::vector<calibration::Advice>& advice) {
  Json list = Json::array();
  for (const auto& a : advice) {
    Json left = Json::object();
    for (std::size_t i = 0; i < a.left.size(); ++i) left[lab.unknowns[i].key] = a.left[i];
    list.push_back({{"test", a.test},
                    {"result", a.result},
                    {"expected", a.value},
                    {"posterior_deviation", a.scatter},
                    {"standard_error", a.error},
                    {"bits", a.bits},
                    {"interval_left", left}});
  }
  return list;
}

Json results_json(const Lab& lab, const Calibration& c, const std::vector<calibration::Advice>& advice) {
  double cpu = 0.0;
  for (const auto& trial : c.trials)
    for (const auto& row : trial.rows) cpu += row.cpu;
  return {{"parameters", parameters_json(c)},
          {"forecast", forecasts_json(lab, c)},
          {"next", advice.empty() ? Json(nullptr) : advice_json(lab, advice)},
          {"emulator_error", emulator_json(c)},
          {"readings", readings_json(c)},
          {"contradictions", contradictions_json(c)},
          {"chi_square", c.chi_square},
          {"posterior_points", c.effective_points},
          {"r_hat", c.r_hat ? Json(*c.r_hat) : Json(nullptr)},
          {"runs", c.trials.size() * lab.tests.size()},
          {"runs_cpu_s", cpu}};
}

void print_advice(const std::vector<calibration::Advice>& advice) {
  for (const auto& a : advice)
    say("{:<36} {} {:.3g} ± {:.2g} expected, test ± {:.2g}: {:.1f} bits\n", "next? " + a.test, a.result,
        a.value, a.scatter, a.error, a.bits);
}

void print_result(const Lab& lab, const Calibration& c) {
  for (const auto& p : c.parameters)
    say("{:<36} {:.4g} {} [{:.4g}, {:.4g}]  {}\n", p.key, p.value, p.unit, p.low, p.high, p.told);
  for (const auto& r : c.readings)
    say("{:<36} measured {:.4g}, best fit {:.4g}, emulator ± {:.2g}\n", r.words + ": " + r.result, r.measured,
        r.best_fit, r.emulator_error);
  for (std::size_t i = 0; i < c.forecasts.size(); ++i)
    for (const auto& f : c.forecasts[i])
      if (f.value)
        say("{:<36} {:.4g} [{:.4g}, {:.4g}]\n", lab.tests[lab.measured + i].words + ": " + f.result, *f.value,
            f.low, f.high);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void write_result(const Lab& lab, const Calibration& c, const std::vector<calibration::Advice>& advice,
                  const Stopwatch& watch, const std::filesystem::path& folder) {
  scene::Outcome outcome;
  outcome.apparatus = "calibrate";
  outcome.checks.reasons = c.reasons;
  watch.stop(outcome.cost);
  Json summary = summary_of(outcome);
  summary["results"] = results_json(lab, c, advice);
  io::write_text(folder / "mix.toml", mix_toml(lab, c));
  io::write_text(folder / "trials.csv", trials_csv(lab, c));
  io::write_text(folder / "report.html",
                 calibration::calibration_html(lab, c, advice, text_of(lab.file),
                                               "tremie calibrate " + lab.file.string()));
  io::write_text(folder / "summary.json", summary.dump(2) + "\n");
}

int stopped() {
  say(stderr, "interrupted: nothing written\n");
  return interrupted;
}

int run_calibration(const CalibrateOptions& options) {
  const Stopwatch watch;
  const Lab lab = calibration::read_lab(options.file);
  report::RunFolder folder(options.out.empty() ? "runs/" + lab.name : options.out, options.force, lab.files);
  stop_on_interrupt();
  calibration::Settings settings;
  settings.jobs =
      options.jobs > 0 ? options.jobs : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  settings.most_trials = options.runs;
  settings.stop = &stop_requested;
  if (!options.quiet)
    settings.say = [](const std::string& text) {
      say("{}\n", text);
      std::fflush(stdout);
    };
  const Calibration result = calibration::calibrate(lab, settings);
  if (result.interrupted) return stopped();
  std::vector<calibration::Advice> advice;
  if (options.next) {
    if (settings.say) settings.say("what to measure next");
    advice = calibration::advise(lab, result, settings);
    if (stop_requested) return stopped();
  }
  write_result(lab, result, advice, watch, folder.staging());
  folder.publish();
  for (const auto& reason : result.reasons) say(stderr, "not to be trusted: {}\n", reason);
  if (options.json) print_result_as_json(folder.target());
  if (!options.quiet) {
    print_result(lab, result);
    print_advice(advice);
    say("{:<36} {}\n", "written to", folder.target().string());
  }
  return result.reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_calibrate(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<CalibrateOptions>();
  Command command(app, calibrate_command.name, calibrate_command.description);
  command.required("lab", o->file, "Laboratory file (TOML): [[measured]], [unknown], [known], [[forecast]]");
  command.option("--out", o->out, "Folder for the result (default: runs/<file's name>)");
  command.number("--jobs", o->jobs, 1, 4096,
                 "Runs at a time, one thread each (default: the machine's cores)");
  command.number("--runs", o->runs, 10, 100000, "Runs of each test at most (default: 30 for each unknown)");
  command.flag("--next", o->next,
               "Also rank further tests by what they would add; about four times the time");
  add_json_option(command, o->json);
  command.flag("--quiet", o->quiet, "Print nothing but errors");
  command.flag("--force", o->force, "Replace an earlier result in the folder");
  command.example(
      "tremie calibrate lab.toml, which has [[measured]] tests with their errors, and [unknown] keys with "
      "ranges.");
  command.run([o, &exit_code] {
    o->quiet = o->quiet || o->json;
    exit_code = run_calibration(*o);
  });
}

}  // namespace tremie::cli
