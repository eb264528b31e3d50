// tremie verify: how wrong is it, for how much run time?

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <thread>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/registry/cost_estimate.hpp"
#include "apparatus/registry/machine_pace.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/validation/validation.hpp"
#include "apparatus/verification/document.hpp"
#include "apparatus/verification/suite.hpp"

namespace tremie::cli {
namespace {

struct VerifyOptions {
  std::vector<std::string> cases;
  std::string out;
  bool quick = false, full = false, validation = false, force = false, json = false;
};

std::string known_cases() {
  std::string text;
  for (const auto& entry : verification::suite())
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", entry.name, entry.number);
  return text;
}

/// The cases asked for by name or number, all without any, in the suite's order.
std::vector<verification::Entry> chosen(const std::vector<std::string>& cases) {
  const auto suite = verification::suite();
  const auto is = [](const verification::Entry& entry, const std::string& name) {
    return name == entry.name || name == std::to_string(entry.number);
  };
  for (const std::string& name : cases)
    if (std::none_of(suite.begin(), suite.end(), [&](const auto& entry) { return is(entry, name); }))
      throw scene::InputError(
          fmt::format("verify: there is no case \"{}\"; there are {}", name, known_cases()));
  std::vector<verification::Entry> entries;
  for (const auto& entry : suite)
    if (cases.empty() ||
        std::any_of(cases.begin(), cases.end(), [&](const auto& name) { return is(entry, name); }))
      entries.push_back(entry);
  return entries;
}

std::string command_line(const VerifyOptions& options) {
  std::string text = "tremie verify";
  for (const auto& name : options.cases) text += " " + name;
  return text + (options.full ? " --full" : " --quick");
}

/// One object: whether every bound is kept, which are not, and what each case cost.
nlohmann::ordered_json summary_of_cases(const std::vector<verification::Entry>& entries,
                                        const std::vector<verification::Case>& cases,
                                        const std::vector<double>& cpu) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < entries.size(); ++i)
    list.push_back({{"number", entries[i].number},
                    {"name", entries[i].name},
                    {"what", entries[i].what},
                    {"kept", verification::all_kept({cases[i]})},
                    {"cpu_s", cpu[i]}});
  return {{"schema", 1},
          {"results", {{"cases", list}, {"kept", verification::all_kept(cases)}}},
          {"checks", {{"reasons", verification::broken_bounds(cases)}}}};
}

nlohmann::ordered_json summary_of_sections(const std::vector<validation::Section>& sections) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& section : sections)
    for (const auto& c : section.comparisons)
      list.push_back({{"section", section.name},
                      {"what", c.what},
                      {"unit", c.unit},
                      {"measured", c.measured},
                      {"measured_error", c.measured_error},
                      {"predicted", c.predicted},
                      {"predicted_error", c.predicted_error},
                      {"verdict", validation::verdict(c)}});
  return {{"schema", 1},
          {"results", {{"comparisons", list}}},
          {"checks", {{"reasons", nlohmann::json::array()}}}};
}

/// A measurement that is missed is a finding of the page, not a fault of the run.
int validate(const VerifyOptions& options) {
  if (!options.cases.empty()) throw scene::InputError("verify: --validation has no cases");
  report::RunFolder folder(options.out.empty() ? "runs/validation" : options.out, options.force);
  FILE* const screen = options.json ? stderr : stdout;
  stop_on_interrupt();
  validation::Settings settings{std::max(1, static_cast<int>(std::thread::hardware_concurrency())),
                                folder.staging(),
                                [screen](const std::string& text) {
                                  say(screen, "{}\n", text);
                                  std::fflush(screen);
                                },
                                &stop_requested};
  const auto start = std::chrono::steady_clock::now();
  try {
    const auto sections = validation::all_sections(settings);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    validation::write_page(sections, wall.count(), folder.staging());
    folder.publish();
    say(screen, "written to {}\n", (folder.target() / "VALIDATION.md").string());
    if (options.json) answer(summary_of_sections(sections).dump(2) + "\n");
  } catch (const validation::Interrupted&) {
    say(screen, "interrupted: nothing written\n");
    return interrupted;
  }
  return done;
}

/// CPU seconds that the cases will take here; in full four times as many.
double expected_seconds(std::span<const verification::Entry> entries, bool full) {
  const scene::Scene section = scene::read_text("apparatus = \"slump_flow\"\nmix = \"mix_a\"\n", "section");
  double cpu = 0.0;
  for (const auto& entry : entries) cpu += (full ? 4.0 : 1.0) * entry.quick_cpu;
  return cpu * scene::machine_pace(section);
}

int verify(const VerifyOptions& options) {
  if (options.validation) return validate(options);
  const auto entries = chosen(options.cases);
  report::RunFolder folder(options.out.empty() ? "runs/verification" : options.out, options.force);
  const auto depth = options.full ? verification::Depth::full : verification::Depth::quick;
  FILE* const screen = options.json ? stderr : stdout;
  std::vector<verification::Case> cases;
  std::vector<double> cpu;
  stop_on_interrupt();
  say(screen, "{} cases, about {} of CPU on this machine\n", entries.size(),
      scene::duration_text(expected_seconds(entries, options.full)));
  for (const auto& entry : entries) {
    if (stop_requested) {
      say(screen, "interrupted: nothing written\n");
      return interrupted;
    }
    say(screen, "case {}: {}\n", entry.number, entry.what);
    std::fflush(screen);
    const double start = cpu_seconds();
    cases.push_back(entry.run(depth));
    cpu.push_back(cpu_seconds() - start);
    const bool kept = verification::all_kept({cases.back()});
    say(screen, "        {} in {:.1f} s of CPU\n", kept ? "all bounds kept" : "a bound is broken",
        cpu.back());
    std::fflush(screen);
  }
  verification::write_document(cases, command_line(options), folder.staging());
  folder.publish();
  for (const auto& line : verification::broken_bounds(cases)) say(stderr, "not kept: {}\n", line);
  say(screen, "written to {}\n", (folder.target() / "VERIFICATION.md").string());
  if (options.json) answer(summary_of_cases(entries, cases, cpu).dump(2) + "\n");
  return verification::all_kept(cases) ? done : not_to_be_trusted;
}

}  // namespace

void add_command_verify(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<VerifyOptions>();
  Command command(app, verify_command.name, verify_command.description);
  command.option("cases", options->cases, "Cases by name or number (default: all): " + known_cases());
  command.flag("--quick", options->quick, "Coarser cells, two to four minutes of one core (the default)");
  command.flag_without("--full", {"--quick"}, options->full, "All cells; four times as long");
  command.flag_without(
      "--validation", {"--quick", "--full"}, options->validation,
      "Compare predictions with measurements on concrete instead; some four minutes of one core");
  command.option("--out", options->out,
                 "Folder for the result (default: runs/verification or runs/validation)");
  add_json_option(command, options->json);
  command.flag("--force", options->force, "Replace an earlier result in the folder");
  command.run([options, &exit_code] { exit_code = verify(*options); });
}

}  // namespace tremie::cli
