#pragma once

#include <filesystem>
#include <system_error>

namespace tremie::cli {

/// The file of this program.
inline std::filesystem::path own_file() {
  std::error_code error;
  return std::filesystem::read_symlink("/proc/self/exe", error);
}

}  // namespace tremie::cli
