#pragma once

#include <filesystem>
#include <system_error>

namespace tremie::cli {

/// The file of this program.
inline std::filesystem::path own_file() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

/// Becomes tremie-study, with the same arguments; returns an exit code where that cannot be. A build without
/// SUNDIALS or Ceres has no tremie-study, and says what to install.
int hand_over(char** argv);

}  // namespace tremie::cli
