#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <string>

namespace tremie::test {

struct Result {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

/// Runs a shell command in a folder.
inline Result shell(const std::string& command, const std::filesystem::path& folder) {
  const std::string whole = "cd '" + folder.string() + "' && { " + command + "; } 2>&1";
  FILE* pipe = popen(whole.c_str(), "r");
  Result result;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
    result.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  result.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return result;
}

}  // namespace tremie::test
