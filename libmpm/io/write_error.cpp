#include "libmpm/io/write_error.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace tremie::io {

void fail_to_write(const std::filesystem::path& file) {
  const int number = errno;
  std::error_code error;
  const auto space = std::filesystem::space(file.parent_path(), error);
  const bool full = number == ENOSPC || (!error && space.available < 1024 * 1024);
  const std::string why = full          ? "the disk is full"
                          : number != 0 ? std::strerror(number)
                                        : "the write failed";
  throw WriteError(file.string() + ": cannot be written: " + why);
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (!stream) fail_to_write(file);
}

}  // namespace tremie::io
