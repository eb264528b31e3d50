#include <algorithm>

#include "rheometer/tables/table.hpp"

namespace tremie {

namespace {

void append_utf8(std::string& out, unsigned code) {
  const auto put = [&](unsigned byte) { out += static_cast<char>(byte); };
  if (code < 0x80) {
    put(code);
  } else if (code < 0x800) {
    put(0xC0 | (code >> 6));
    put(0x80 | (code & 0x3F));
  } else {
    put(0xE0 | (code >> 12));
    put(0x80 | ((code >> 6) & 0x3F));
    put(0x80 | (code & 0x3F));
  }
}

/// Characters outside of the basic plane, which no record needs, become two question marks.
std::string from_utf16(std::string_view bytes, bool little) {
  std::string out;
  out.reserve(bytes.size() / 2);
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    const unsigned first = static_cast<unsigned char>(bytes[i]),
                   second = static_cast<unsigned char>(bytes[i + 1]);
    const unsigned code = little ? first | (second << 8) : second | (first << 8);
    if (code == 0xFEFF) continue;
    append_utf8(out, code >= 0xD800 && code < 0xE000 ? unsigned{'?'} : code);
  }
  return out;
}

/// Bytes of the UTF-8 character at the front; 0 where there is none.
std::size_t utf8_length(std::string_view text) {
  const unsigned c = static_cast<unsigned char>(text.front());
  const std::size_t length = c < 0x80                ? 1
                             : c >= 0xC2 && c < 0xE0 ? 2
                             : c >= 0xE0 && c < 0xF0 ? 3
                             : c >= 0xF0 && c < 0xF5 ? 4
                                                     : 0;
  if (length > text.size()) return 0;
  for (std::size_t k = 1; k < length; ++k)
    if ((static_cast<unsigned char>(text[k]) & 0xC0) != 0x80) return 0;
  return length;
}

/// Characters of UTF-8 as they stand, other bytes as Latin-1 has them: a file may hold both.
std::string from_bytes(std::string_view bytes) {
  std::string out;
  out.reserve(bytes.size());
  while (!bytes.empty()) {
    const std::size_t length = utf8_length(bytes);
    if (length > 0)
      out += bytes.substr(0, length);
    else
      append_utf8(out, static_cast<unsigned char>(bytes.front()));
    bytes.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

/// Which of the two bytes of a character is zero in nearly all of the text, as in UTF-16 without a mark: 0, 1; 2 for none.
int zero_byte_of_two(std::string_view bytes) {
  std::size_t zeros[2] = {0, 0};
  const std::string_view start = bytes.substr(0, 4000);
  for (std::size_t i = 0; i < start.size(); ++i) zeros[i % 2] += start[i] == '\0';
  for (const int k : {0, 1})
    if (5 * zeros[k] > 2 * start.size() && zeros[1 - k] == 0) return k;
  return 2;
}

}  // namespace

std::string decoded_text(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("PK\x03\x04") || bytes.starts_with("\xD0\xCF\x11\xE0"))
    throw RecordError(
        name +
        ":1:1: is a workbook; open it, choose the sheet of the record, and save it as CSV (File, "
        "Save as, \"CSV UTF-8\" or \"Text CSV\")");
  if (bytes.starts_with("\xFF\xFE")) return from_utf16(bytes.substr(2), true);
  if (bytes.starts_with("\xFE\xFF")) return from_utf16(bytes.substr(2), false);
  if (const int zero = zero_byte_of_two(bytes); zero < 2) return from_utf16(bytes, zero == 1);
  if (bytes.substr(0, 100000).find('\0') != std::string_view::npos)
    throw RecordError(name +
                      ":1:1: is no text (it holds zero bytes); a record is a text file of columns, like CSV");
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  return from_bytes(bytes);
}

}  // namespace tremie
