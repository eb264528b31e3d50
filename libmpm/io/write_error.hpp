#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace tremie::io {

/// A file could not be written: the disk is full, or the folder went away.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws WriteError that names the file and, as far as it can be told, why.
[[noreturn]] void fail_to_write(const std::filesystem::path& file);

/// Writes a whole file and makes sure that it reached the file system. Throws WriteError.
void write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace tremie::io
