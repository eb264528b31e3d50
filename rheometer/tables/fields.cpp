#include "rheometer/tables/fields.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <tuple>

#include "rheometer/tables/number_column.hpp"

namespace tremie::detail {

namespace {

constexpr std::string_view no_break_space = "\u00A0";
constexpr int most_lines_of_a_field = 4;

bool ends_a_field(char c) { return c == ',' || c == ';' || c == '\t' || c == '|'; }

/// Whether a quote that begins a field stays open to the end of the text.
bool leaves_a_quote_open(std::string_view text) {
  bool open = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '"') continue;
    if (open)
      open = false;
    else
      open = i == 0 || ends_a_field(text[i - 1]) || text[i - 1] == '"';
  }
  return open;
}

/// Where the line that begins at `start` ends, and where the next one begins.
std::pair<std::size_t, std::size_t> end_of_line(std::string_view text, std::size_t start) {
  const std::size_t end = std::min(text.find_first_of("\r\n", start), text.size());
  const bool crlf = end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n';
  return {end, std::min(text.size(), end + (crlf ? 2 : 1))};
}

/// The field that begins with a quote at `at`, which moves behind the closing one; as it stands where none closes it.
std::string quoted_field(std::string_view line, std::size_t& at) {
  std::string field;
  for (std::size_t i = at + 1; i < line.size(); ++i) {
    if (line[i] != '"') {
      field += line[i];
    } else if (i + 1 < line.size() && line[i + 1] == '"') {
      field += line[i++];
    } else {
      at = i + 1;
      return field;
    }
  }
  return {};
}

std::vector<std::string> between_blanks(std::string_view line, std::size_t fewest) {
  std::vector<std::string> fields;
  for (line = trimmed(line); !line.empty();) {
    std::size_t end = 0, blanks = 0;
    for (; end < line.size(); ++end) {
      blanks = std::min(line.find_first_not_of(' ', end), line.size()) - end;
      if (blanks >= fewest) break;
    }
    fields.emplace_back(trimmed(line.substr(0, end)));
    line.remove_prefix(std::min(line.size(), end + blanks));
  }
  return fields;
}

}  // namespace

std::string_view trimmed(std::string_view s) {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
  for (bool again = true; again;) {
    again = true;
    if (!s.empty() && blank(s.front()))
      s.remove_prefix(1);
    else if (!s.empty() && blank(s.back()))
      s.remove_suffix(1);
    else if (s.starts_with(no_break_space))
      s.remove_prefix(no_break_space.size());
    else if (s.ends_with(no_break_space))
      s.remove_suffix(no_break_space.size());
    else
      again = false;
  }
  return s;
}

std::string lower(std::string_view text) {
  std::string s(text);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto c = static_cast<unsigned char>(s[i]),
               before = static_cast<unsigned char>(i > 0 ? s[i - 1] : 0);
    if (before == 0xC3 && c >= 0x80 && c <= 0x9E && c != 0x97)
      s[i] = static_cast<char>(c + 0x20);
    else if (c < 0x80)
      s[i] = static_cast<char>(std::tolower(c));
  }
  return s;
}

std::vector<TextLine> lines_of(std::string_view text) {
  std::vector<TextLine> lines;
  long number = 1;
  for (std::size_t start = 0; start < text.size(); ++number) {
    auto [end, next] = end_of_line(text, start);
    long more = 0;
    if (leaves_a_quote_open(text.substr(start, end - start)))
      for (auto [e, n] = std::pair(end, next); more == 0 && n < text.size() && e - end < 400;) {
        std::tie(e, n) = end_of_line(text, n);
        const std::string_view joined = text.substr(start, e - start);
        if (leaves_a_quote_open(joined)) {
          if (std::count(joined.begin(), joined.end(), '\n') > most_lines_of_a_field) break;
          continue;
        }
        more = std::max<long>(1, static_cast<long>(std::count(joined.begin(), joined.end(), '\n')));
        end = e, next = n;
      }
    lines.push_back({number, text.substr(start, end - start)});
    number += more;
    start = next;
  }
  return lines;
}

std::vector<std::string> fields_of(std::string_view line, char separator) {
  if (separator == ' ') return between_blanks(line, 1);
  if (separator == wide_blanks) return between_blanks(line, 2);
  std::vector<std::string> fields;
  for (std::size_t at = 0;;) {
    const std::size_t first = std::min(line.find_first_not_of(' ', at), line.size());
    std::string quoted;
    if (first < line.size() && line[first] == '"') {
      std::size_t behind = first;
      quoted = quoted_field(line, behind);
      if (behind > first) at = behind;
    }
    const std::size_t end = std::min(line.find(separator, at), line.size());
    const std::string_view rest = line.substr(at, end - at);  // behind a quote's end nothing should stand
    fields.emplace_back(trimmed(quoted.empty() ? rest : std::string_view(quoted += rest)));
    if (end == line.size()) return fields;
    at = end + 1;
  }
}

std::vector<std::string> row_fields(std::string_view line, char separator,
                                    const std::vector<std::string>& header) {
  auto fields = fields_of(line, separator);
  const bool labelled = header.size() > 1 && header.front().ends_with(':');
  if (labelled && fields.size() < header.size() && looks_like_a_number(fields.front()))
    fields.insert(fields.begin(), std::string());
  return fields;
}

bool all_empty(const std::vector<std::string>& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const std::string& f) { return f.empty(); });
}

std::size_t count_numbers(const std::vector<std::string>& fields) {
  return static_cast<std::size_t>(std::count_if(fields.begin(), fields.end(), looks_like_a_number));
}

bool is_placeholder(const std::string& field) {
  static const std::string_view known[] = {"",  "-",       "--", "---",  "n/a",  "#n/a", "nan", "n.a.",
                                           "*", "invalid", "na", "null", "over", "***",  "-.-"};
  const std::string text = lower(field);
  return std::find(std::begin(known), std::end(known), text) != std::end(known);
}

bool is_a_statistic(const std::string& field) {
  static const std::string_view known[] = {"mean",
                                           "average",
                                           "avg",
                                           "sd",
                                           "std",
                                           "stdev",
                                           "std dev",
                                           "std. dev",
                                           "min",
                                           "max",
                                           "minimum",
                                           "maximum",
                                           "median",
                                           "range",
                                           "cv",
                                           "cov",
                                           "sum",
                                           "mw",
                                           "mittelwert",
                                           "mittel",
                                           "standardabw.",
                                           "summe",
                                           "moyenne",
                                           "\u00E9cart-type",
                                           "media",
                                           "standard deviation",
                                           "standardabweichung",
                                           "variance",
                                           "rsd",
                                           "count"};
  std::string text = lower(field);
  while (!text.empty() && (text.back() == ':' || text.back() == '.' || text.back() == ' ')) text.pop_back();
  return std::find(std::begin(known), std::end(known), text) != std::end(known);
}

bool measures_a_modulus(const std::vector<std::string>& fields, const std::vector<std::size_t>& moduli) {
  return std::any_of(moduli.begin(), moduli.end(), [&](std::size_t i) {
    return i < fields.size() && looks_like_a_number(fields[i]) &&
           fields[i].find_first_of("123456789") != std::string::npos;
  });
}

}  // namespace tremie::detail
