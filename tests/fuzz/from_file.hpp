#pragma once

// What reads a file by its name is fuzzed through a file.

#include <cstdint>
#include <filesystem>
#include <fstream>

/// Calls read(file) on a file that holds the bytes. It lies in the folder in which the target runs.
template <class Read>
void from_file(const std::uint8_t* data, std::size_t size, Read&& read) {
  const std::filesystem::path file = "fuzzed.toml";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  read(file);
}
