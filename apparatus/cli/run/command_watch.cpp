// tremie watch DIR: shows a run that another process is at work on.

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/process/stop_signals.hpp"
#include "apparatus/cli/run/run_and_write.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::cli {
namespace {

namespace fs = std::filesystem;

/// Prints the whole lines that have come since `read`, and moves it on.
void print_new_lines(const fs::path& file, std::streamoff& read) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(read);
  for (std::string line; std::getline(stream, line) && !stream.eof();) {
    say("{}\n", line);
    read += static_cast<std::streamoff>(line.size()) + 1;
  }
  std::fflush(stdout);
}

int watch(const std::string& folder) {
  const fs::path staging = report::find_work(folder), progress = staging / progress_file;
  if (staging.empty())
    throw scene::InputError(fmt::format("{}: no run is at work on it at this moment", folder));
  say("frames so far   {}\n", (staging / "frames.pvd").string());
  stop_on_interrupt();
  std::streamoff read = 0;
  while (!stop_requested && report::find_work(folder) == staging) {
    print_new_lines(progress, read);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  if (stop_requested) return interrupted;
  say("the run has ended; what it left lies in {}\n", folder);
  return done;
}

}  // namespace

void add_command_watch(CLI::App& app, int& exit_code) {
  auto folder = std::make_shared<std::string>();
  Command command(app, "watch", "Follow the run of another process until it ends");
  command.required("folder", *folder, "Folder of the run's result (tremie run --out)");
  command.example("tremie watch runs/slump, beside tremie run slump.toml");
  command.run([folder, &exit_code] { exit_code = watch(*folder); });
}

}  // namespace tremie::cli
