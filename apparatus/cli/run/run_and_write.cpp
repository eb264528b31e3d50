#include "apparatus/cli/run/run_and_write.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/progress.hpp"
#include "apparatus/cli/run/keeper.hpp"
#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/report/folder/crate.hpp"
#include "apparatus/report/run_files/html.hpp"
#include "apparatus/report/run_files/result_files.hpp"

namespace tremie::cli {
namespace {

int exit_code_of(const scene::Outcome& outcome) {
  if (outcome.status == Status::interrupted) return interrupted;
  return outcome.checks.reasons.empty() && outcome.status == Status::completed ? done : not_to_be_trusted;
}

void print_outcome(const scene::Scene& scene, const scene::Outcome& outcome) {
  for (const auto& line : outcome.lines) say("{}\n", line);
  if (const std::string line = report::measured_line(outcome); !line.empty())
    say("measured        {}\n", line);
  for (const auto& line : scene::error_lines(scene, outcome)) say("error           {}\n", line);
  if (!outcome.has_points) return;
  const Checks& c = outcome.checks;
  say("checks          volume {:+.3g} %, mass {:.1e}, {} unconverged steps, {} points lost\n",
      100.0 * c.volume_change, c.mass_error, c.unconverged_steps, c.points_lost);
  const Cost& cost = outcome.cost;
  say("cost            {:.2f} s of CPU, {:.2f} s by the clock, {} steps, {} points, {:.0f} MB\n", cost.cpu,
      cost.wall, cost.steps, cost.points, static_cast<double>(cost.peak_rss_bytes) / 1e6);
  if (outcome.status == Status::interrupted) say("interrupted at {:.2f} s\n", cost.simulated);
}

void print_reasons(const scene::Outcome& outcome) {
  for (const auto& reason : outcome.checks.reasons) say(stderr, "not to be trusted: {}\n", reason);
}

/// An accuracy that was not reached is said.
void note_accuracy(const report::RunRequest& request, scene::Outcome& outcome) {
  if (request.accuracy.empty() || outcome.status != Status::completed) return;
  const auto& error = *outcome.error;
  if (error.bars.empty()) {
    outcome.checks.reasons.push_back("the accuracy cannot be judged: " + error.basis);
    return;
  }
  const auto* value = std::get_if<double>(scene::find_result(outcome, error.bars.front().name));
  const double reached = error.bars.front().error / std::abs(*value);
  if (reached > accuracy_of(request.accuracy))
    outcome.checks.reasons.push_back(fmt::format(
        "the accuracy of {} was not reached: {} is accurate to {:.2g} %: halve model.cell, or give a "
        "looser --accuracy",
        request.accuracy, error.bars.front().name, 100.0 * reached));
}

/// A run that an interrupt ended is described as it stands.
void add_crate(const scene::Scene& scene, const report::RunRequest& request, const scene::Outcome& outcome,
               const std::filesystem::path& folder, std::vector<std::string>& notes) {
  report::Crate crate{.name = outcome.asked.empty() ? request.name : outcome.asked,
                      .description = report::headline_of(outcome),
                      .command = request.command,
                      .mix_name = scene.measured.name,
                      .mix_source = scene.measured.source,
                      .mix_licence = scene.measured.licence,
                      .completed = outcome.status == Status::completed};
  for (const auto& reason : outcome.checks.reasons) crate.description += "; not to be trusted: " + reason;
  if (const std::string note = report::write_crate(folder, crate); !note.empty()) notes.push_back(note);
}

/// Who keeps this run's checkpoints; nobody where the scene wants none.
std::optional<Keeper> keeper_of(const scene::Scene& scene, const report::RunRequest& request,
                                const report::RunFolder& folder,
                                const std::optional<report::Checkpoint>& from) {
  if (!scene.output.checkpoint_interval) return std::nullopt;
  return std::optional<Keeper>(std::in_place, folder.checkpoint(), *scene.output.checkpoint_interval, request,
                               from);
}

scene::Outcome run_and_write(const scene::Scene& scene, const report::RunRequest& request, bool quiet,
                             const report::RunFolder& folder, const std::optional<report::Checkpoint>& from,
                             std::vector<std::string>& notes) {
  report::ResultFiles files(folder.staging(), scene.resolved, request.command,
                            report::frames_written(scene.output));
  if (from) report::for_each_frame(*from, [&](const Frame& frame) { files.frame(frame); });
  auto keeper = keeper_of(scene, request, folder, from);
  scene::Observer observer;
  observer.interrupted = &stop_requested;
  if (keeper) observer.checkpoints = keeper->checkpoints();
  observer.on_frame = [&](const Frame& frame) {
    files.frame(frame);
    if (keeper) keeper->frame(frame);
  };
  scene::Outcome outcome;
  {
    ProgressLine line;
    ProgressFile file(folder.staging() / progress_file);
    observer.on_progress = [&](const scene::Progress& progress) {
      if (!quiet) line.show(progress);
      file.show(progress);
    };
    outcome = scene::run(scene, observer);
    if (request.with_error || !request.accuracy.empty())
      outcome.error = scene::estimate_error(scene, outcome, observer);
  }
  outcome.cost.wall += request.wall, outcome.cost.cpu += request.cpu;
  note_accuracy(request, outcome);
  notes = files.finish(outcome);
  if (request.crate) add_crate(scene, request, outcome, folder.staging(), notes);
  if (keeper && !keeper->trouble().empty()) notes.push_back(keeper->trouble());
  return outcome;
}

/// Of the interrupted run the checkpoint alone stays, for `tremie resume`.
int leave_finished_result(const report::RunFolder& folder, Screen screen) {
  if (screen == Screen::one_json_object) print_json_of(folder.staging());
  std::error_code error;
  const bool goes_on = std::filesystem::exists(folder.checkpoint() / "state", error);
  const std::string target = folder.target().string();
  say(stderr, "interrupted: {} keeps its earlier result{}\n", target,
      goes_on ? "; tremie resume " + target + " goes on" : "");
  return interrupted;
}

}  // namespace

/// The relative accuracy that was asked for: "1 %".
double accuracy_of(const std::string& text) {
  std::istringstream in(text);
  double percent = 0.0;
  std::string unit;
  const bool understood = (in >> percent >> unit) && unit == "%" && in.eof();
  if (!understood || !(percent >= 0.01 && percent <= 50.0))
    throw scene::InputError(fmt::format(
        "--accuracy: \"{}\" is not understood; it takes a percentage of 0.01 % to 50 %: \"1 %\"", text));
  return 0.01 * percent;
}

void say_notes(const scene::Scene& scene, Screen screen) {
  if (screen == Screen::nothing) return;
  std::FILE* const stream = screen == Screen::one_json_object ? stderr : stdout;
  for (const auto& note : scene.notes) say(stream, "{:<15} {}\n", "note", note);
  std::fflush(stream);
}

int run_and_publish(const scene::Scene& scene, const report::RunRequest& request, Screen screen,
                    report::RunFolder& folder, const std::optional<report::Checkpoint>& from) {
  std::vector<std::string> notes;
  const auto outcome = run_and_write(scene, request, screen != Screen::everything, folder, from, notes);
  if (outcome.status == Status::interrupted && folder.holds_finished_result())
    return leave_finished_result(folder, screen);
  if (outcome.status == Status::completed)
    report::keep_for_longer(folder.checkpoint(), folder.staging() / report::for_longer);
  folder.publish();
  if (outcome.status != Status::interrupted) report::remove_checkpoint(folder.target() / "checkpoint");
  print_reasons(outcome);
  if (screen == Screen::one_json_object) print_result_as_json(folder.target(), notes);
  if (screen == Screen::everything) {
    print_outcome(scene, outcome);
    const int width = outcome.has_points ? 15 : 20;  // as wide as the words before its lines
    for (const auto& note : notes) say("{:<{}} {}\n", "note", width, note);
    say("{:<{}} {}\n", "written to", width, folder.target().string());
    if (outcome.status == Status::interrupted && scene.output.checkpoint_interval)
      say("to go on        tremie resume {}\n", folder.target().string());
  }
  return exit_code_of(outcome);
}

}  // namespace tremie::cli
