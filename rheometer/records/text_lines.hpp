#pragma once

// Lines and fields of a text table. Private to rheometer/records.

#include <cctype>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tremie::detail {

/// One line after another, without its line end; numbered from 1.
struct LineReader {
  std::string_view text;
  long number = 0;

  std::optional<std::string_view> next() {
    if (text.empty()) return std::nullopt;
    const std::size_t end = text.find_first_of("\r\n");
    const std::string_view line = text.substr(0, end);
    if (end == std::string_view::npos) {
      text = {};
    } else {
      const bool crlf = text[end] == '\r' && end + 1 < text.size() && text[end + 1] == '\n';
      text.remove_prefix(end + (crlf ? 2 : 1));
    }
    ++number;
    return line;
  }
};

/// Without the blanks, tabs and quotes around it.
inline std::string_view trimmed(std::string_view s) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '"'; };
  while (!s.empty() && blank(s.front())) s.remove_prefix(1);
  while (!s.empty() && blank(s.back())) s.remove_suffix(1);
  return s;
}

/// Where the fields of a line begin and end; the buffer is kept between lines.
inline void split(std::string_view line, char separator, std::vector<std::string_view>& fields) {
  fields.clear();
  for (std::size_t start = 0;;) {
    const std::size_t end = line.find(separator, start);
    fields.push_back(line.substr(start, end == std::string_view::npos ? end : end - start));
    if (end == std::string_view::npos) return;
    start = end + 1;
  }
}

inline std::string lower(std::string_view text) {
  std::string s(text);
  for (char& c : s) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

}  // namespace tremie::detail
