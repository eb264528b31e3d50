#pragma once

#include <optional>
#include <string>

#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/checkpoint_files.hpp"
#include "apparatus/report/run_folder.hpp"

namespace tremie::cli {

/// The relative accuracy that was asked for: "1 %". Throws scene::InputError.
double accuracy_of(const std::string& text);

/// Runs a scene from its start, or from a checkpoint in folder.checkpoint(); fills the folder, puts it in its place,
/// and says what came out. Returns an exit code.
int run_and_publish(const scene::Scene& scene, const report::RunRequest& request, bool quiet,
                    report::RunFolder& folder, const std::optional<report::Checkpoint>& from = {});

}  // namespace tremie::cli
