// tremie resume DIR: goes on with a run that was interrupted or killed, or with a finished one to a later end.

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <memory>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/brief_spin.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/run/longer_test.hpp"
#include "apparatus/cli/run/run_and_write.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_folder.hpp"

namespace tremie::cli {
namespace {

namespace fs = std::filesystem;

struct ResumeOptions {
  std::string folder, until;
  bool quiet = false, json = false;
};

/// The scene that lies beside a checkpoint is the one that it was written for.
void check_scene_beside(const report::Checkpoint& checkpoint) {
  const fs::path file = checkpoint.folder.parent_path() / "scene.toml";
  std::error_code error;
  if (!fs::exists(file, error)) return;
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (text != checkpoint.request.resolved)
    throw scene::InputError(fmt::format("{}: the checkpoint beside it is of another scene", file.string()));
}

/// Reads and checks all before anything is touched.
report::Checkpoint checked(const std::string& folder, bool longer) {
  std::error_code error;
  const bool unfinished = !report::find_checkpoint(folder).empty();
  if (!unfinished && !fs::exists(folder, error))
    throw scene::InputError(
        fmt::format("{}: there is no such folder, and no checkpoint of a run to it", folder));
  if (longer && unfinished)
    throw scene::InputError(fmt::format(
        "{0}: holds an unfinished run, and --until is for finished ones: `tremie resume {0}` first", folder));
  const fs::path at = report::find_checkpoint(folder, longer);
  if (at.empty() && longer) refuse_longer_test(folder);
  if (at.empty())
    throw scene::InputError(fmt::format(
        "{}: holds no unfinished run (a run keeps its first checkpoint after output.checkpoint_interval)",
        folder));
  try {
    auto checkpoint = report::read_checkpoint(at);
    check_scene_beside(checkpoint);
    return checkpoint;
  } catch (const scene::InputError&) {
    report::refuse_where_another_goes_on(folder, at, longer);
    throw;
  }
}

int resume(const ResumeOptions& options) {
  const bool longer = !options.until.empty();
  auto checkpoint = checked(options.folder, longer);
  const report::RunRequest request =
      longer ? longer_test(checkpoint.request, options.until) : checkpoint.request;
  auto scene = scene::read_text(request.resolved, request.name);
  scene.resolved = request.resolved;
  spin_briefly(request.threads);
  scene::set_threads(scene, request.threads);
  report::RunFolder folder(options.folder, report::Resumed{.longer = longer});
  if (longer) report::ask_for_longer(report::read_checkpoint(folder.checkpoint()), request);
  checkpoint = report::read_checkpoint(folder.checkpoint());  // none may have gone on meanwhile
  stop_on_interrupt();
  return run_and_publish(scene, request, screen_of(options.quiet, options.json), folder, checkpoint);
}

}  // namespace

void add_command_resume(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ResumeOptions>();
  Command command(app, "resume", "Continue a run that was interrupted or killed, or a finished one");
  command.required("folder", options->folder, "Folder of the run's result (tremie run --out)");
  command.option("--until", options->until,
                 "Go on with a finished run until this time (test.duration), \"300 s\"");
  add_json_option(command, options->json);
  command.flag("--quiet", options->quiet, "Print nothing but errors");
  command.run([options, &exit_code] { exit_code = resume(*options); });
}

}  // namespace tremie::cli
