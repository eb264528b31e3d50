#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tremie::report {

/// Full path of a program on $PATH; empty where there is none.
std::filesystem::path find_program(const std::string& name);

/// Runs a program without a shell, in `folder`, its output thrown away. Its exit code, or nothing where it
/// could not be started, was killed, or took longer than `limit` seconds.
std::optional<int> run_program(const std::filesystem::path& program,
                               const std::vector<std::string>& arguments, const std::filesystem::path& folder,
                               double limit = 60.0);

}  // namespace tremie::report
