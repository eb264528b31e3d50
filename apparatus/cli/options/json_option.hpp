#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/cli/options/command.hpp"

namespace tremie::cli {

/// --json: one JSON object on the standard output and nothing else there; messages go to the standard error.
void add_json_option(Command& command, bool& json);

/// --crate: ro-crate-metadata.json beside the result (report/folder/crate.hpp).
void add_crate_option(Command& command, bool& crate);

/// summary.json of a folder, on the standard output.
void print_json_of(const std::filesystem::path& folder);
/// summary.json of a result's folder, on the standard output; notes and the folder on the standard error.
void print_result_as_json(const std::filesystem::path& folder, const std::vector<std::string>& notes = {});

}  // namespace tremie::cli
