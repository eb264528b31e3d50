#pragma once

// Numbers in text, by a point and in no language's habits.

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>
#include <version>

namespace tremie {

/// Reads the number that leads a text; the count of its characters, 0 where there is none that can be held.
inline std::size_t read_number(std::string_view text, double& number) {
#ifdef __cpp_lib_to_chars
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc{} ? static_cast<std::size_t>(end - text.data()) : 0;
#else  // libc++ before version 20 reads whole numbers alone
  const std::string_view digits = text.substr(text.starts_with('-') ? 1 : 0);
  if (digits.empty() || digits.starts_with("0x") || digits.starts_with("0X")) return 0;
  if (std::string_view(" \t+-").find(digits.front()) != std::string_view::npos) return 0;
  const std::string copy(text);
  char* end = nullptr;
  errno = 0;
  number = std::strtod(copy.c_str(), &end);
  return errno == ERANGE ? 0 : static_cast<std::size_t>(end - copy.c_str());
#endif
}

/// The number that a whole text is; empty where it is anything else.
inline std::optional<double> parse_number(std::string_view text) {
  double number = 0.0;
  const std::size_t read = read_number(text, number);
  return read > 0 && read == text.size() ? std::optional(number) : std::nullopt;
}

}  // namespace tremie
