#pragma once

#include <optional>
#include <string>

#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/checkpoint_files.hpp"
#include "apparatus/report/run_folder.hpp"

namespace tremie::cli {

/// The relative accuracy that was asked for: "1 %". Throws scene::InputError.
double accuracy_of(const std::string& text);

/// In the folder that a run writes into while it goes on: a line for every reading that `tremie watch` shows.
inline constexpr const char* progress_file = "progress.txt";

/// What goes to the screen beside errors.
enum class Screen { nothing, one_json_object, everything };
inline Screen screen_of(bool quiet, bool json) {
  return json ? Screen::one_json_object : quiet ? Screen::nothing : Screen::everything;
}

/// What the reader noticed of a scene that it takes as it stands.
void say_notes(const scene::Scene& scene, Screen screen);

/// Runs a scene from its start, or from a checkpoint in folder.checkpoint(); fills the folder, puts it in its place,
/// and says what came out. Returns an exit code.
int run_and_publish(const scene::Scene& scene, const report::RunRequest& request, Screen screen,
                    report::RunFolder& folder, const std::optional<report::Checkpoint>& from = {});

}  // namespace tremie::cli
