// tremie compare DIR DIR…: results side by side.

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/report/compare/comparison.hpp"
#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

struct CompareOptions {
  std::vector<std::string> folders;
  std::string out = "runs/compare";
  bool quiet = false, force = false, json = false;
};

std::string command_of(const CompareOptions& options) {
  std::string text = "tremie compare";
  for (const auto& folder : options.folders) text += " " + folder;
  return text;
}

void write(const report::Comparison& comparison, const CompareOptions& options, const Stopwatch& watch,
           const std::filesystem::path& folder) {
  scene::Outcome outcome;
  outcome.apparatus = "compare";
  outcome.checks.reasons = report::comparison_reasons(comparison);
  watch.stop(outcome.cost);
  auto summary = summary_of(outcome);
  summary["results"] = report::comparison_json(comparison);
  io::write_text(folder / "compare.csv", report::comparison_csv(comparison));
  io::write_text(folder / "report.html", report::comparison_html(comparison, command_of(options)));
  io::write_text(folder / "summary.json", summary.dump(2) + "\n");
}

/// "348.2 ± 8.1" where the run states its error.
std::string value_text(const report::ComparedRow& row, std::size_t i) {
  if (!row.numbers[i]) return row.texts[i];
  const std::string text = fmt::format("{:.6g}", *row.numbers[i]);
  return row.errors[i] ? text + " ± " + scene::rounded(*row.errors[i], 2) : text;
}

bool states_errors(const report::Comparison& comparison) {
  return std::any_of(comparison.runs.begin(), comparison.runs.end(),
                     [](const auto& run) { return !run.errors.empty(); });
}

void print_text(const report::Comparison& comparison) {
  say("{}\n", report::comparison_headline(comparison));
  if (states_errors(comparison)) say("{}\n", report::error_sentence(comparison));
  if (const auto text = report::scene_sentence(comparison); !text.empty()) say("{}\n", text);
  std::size_t longest = 0;
  for (const auto& row : comparison.results) longest = std::max(longest, row.key.size());
  for (const auto& row : comparison.results) {
    if (!row.differs) continue;
    std::vector<std::string> values;
    for (std::size_t i = 0; i < row.texts.size(); ++i) values.push_back(value_text(row, i));
    say("{:<{}}  {}\n", row.key, longest, fmt::join(values, " | "));
  }
}

int run_comparison(const CompareOptions& options) {
  const Stopwatch watch;
  const auto comparison = report::compare(options.folders);
  const HeldInterrupts held;  // outlives the folder
  report::RunFolder folder(
      options.out, options.force,
      std::vector<std::filesystem::path>(options.folders.begin(), options.folders.end()));
  write(comparison, options, watch, folder.staging());
  folder.publish();
  const auto reasons = report::comparison_reasons(comparison);
  for (const auto& reason : reasons) say(stderr, "not to be trusted: {}\n", reason);
  if (options.json) print_result_as_json(folder.target());
  if (!options.quiet && !options.json) {
    print_text(comparison);
    say("written to {}\n", folder.target().string());
  }
  return reasons.empty() ? done : not_to_be_trusted;
}

}  // namespace

void add_command_compare(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CompareOptions>();
  Command command(app, "compare", "Compare results: curves side by side, keys and readings that differ");
  command.required("folders", options->folders, "Folders of results, two to eight");
  command.option_with_default("--out", options->out, "Folder for the comparison");
  add_json_option(command, options->json);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.flag("--force", options->force, "Replace an earlier result in the folder");
  command.example("tremie compare runs/fresh runs/rested");
  command.run([options, &exit_code] { exit_code = run_comparison(*options); });
}

}  // namespace tremie::cli
