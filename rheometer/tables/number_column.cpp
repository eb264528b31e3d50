#include "rheometer/tables/number_column.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/number_text.hpp"
#include "rheometer/tables/table.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie::detail {

namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Blanks of all widths as ' ', apostrophes as '\'', the minus sign as '-'.
std::string plain_marks(std::string_view text) {
  static const std::pair<std::string_view, char> spellings[] = {
      {"\u00A0", ' '}, {"\u202F", ' '}, {"\u2009", ' '}, {"\u2019", '\''}, {"\u2212", '-'}};
  std::string s;
  while (!text.empty()) {
    const auto match = std::find_if(std::begin(spellings), std::end(spellings),
                                    [&](const auto& spelling) { return text.starts_with(spelling.first); });
    const bool found = match != std::end(spellings);
    s += found ? match->second : text.front();
    text.remove_prefix(found ? match->first.size() : 1);
  }
  return s;
}

/// The digits of a whole number in groups of three behind one separator; empty where they are not.
std::string without_groups(std::string_view whole, char decimal) {
  const std::size_t first = whole.find_first_not_of("0123456789");
  if (first == std::string_view::npos) return std::string(whole);
  const char separator = whole[first];
  if (separator == decimal || std::string_view(",. '").find(separator) == std::string_view::npos) return {};
  if (first == 0 || first > 3 || whole.front() == '0') return {};
  std::string digits(whole.substr(0, first));
  for (whole.remove_prefix(first); !whole.empty(); whole.remove_prefix(4)) {
    if (whole.size() < 4 || whole[0] != separator) return {};
    const std::string_view group = whole.substr(1, 3);
    if (!std::all_of(group.begin(), group.end(), is_digit)) return {};
    digits += group;
  }
  return digits;
}

std::optional<double> number_by(std::string_view text, char decimal) {
  std::string number;
  if (text.starts_with('-') || text.starts_with('+')) {
    if (text.front() == '-') number = "-";
    text.remove_prefix(1);
  }
  const std::size_t e = text.find_first_of("eEdD");
  std::string_view mantissa = text.substr(0, e),
                   exponent = e == text.npos ? std::string_view{} : text.substr(e + 1);
  if (e != text.npos && exponent.empty()) return std::nullopt;
  if (exponent.starts_with('+')) exponent.remove_prefix(1);
  const std::size_t point = mantissa.find(decimal);
  const std::string_view whole = mantissa.substr(0, point),
                         fraction = point == mantissa.npos ? std::string_view{} : mantissa.substr(point + 1);
  const std::string digits = without_groups(whole, decimal);
  if ((digits.empty() && !whole.empty()) || (whole.empty() && fraction.empty())) return std::nullopt;
  if (e != text.npos && digits.size() != whole.size()) return std::nullopt;
  if (!std::all_of(fraction.begin(), fraction.end(), is_digit)) return std::nullopt;
  number += digits.empty() ? "0" : digits;
  if (!fraction.empty()) (number += '.') += fraction;
  if (e != text.npos) (number += 'e') += exponent;
  const std::optional<double> value = parse_number(number);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// What the texts of a column tell about its decimal mark.
struct Evidence {
  const NumberCell *point = nullptr, *comma = nullptr, *ambiguous = nullptr;

  void add(const NumberCell& cell) {
    const NumberReadings r = readings_of(cell.text);
    if (r.point_alone() && !point) point = &cell;
    if (r.comma_alone() && !comma) comma = &cell;
    if (r.ambiguous() && !ambiguous) ambiguous = &cell;
  }
};

/// A whole number of four digits or more: thousands are not separated where it stands.
bool has_long_whole_part(const NumberCell& cell) {
  std::string_view s = cell.text;
  if (s.starts_with('-') || s.starts_with('+')) s.remove_prefix(1);
  return s.size() >= 4 && s.front() != '0' && std::all_of(s.begin(), s.end(), is_digit);
}

[[noreturn]] void refuse(const std::string& name, const NumberCell& cell, const std::string& what) {
  throw RecordError(at_position(name, cell.line, cell.column, what));
}

std::string shown(const NumberCell& cell) { return "'" + cell.text.substr(0, 40) + "'"; }

std::string on_line(const NumberCell& cell) {
  return shown(cell) + " on line " + std::to_string(cell.line) + ", column " + std::to_string(cell.column);
}

[[noreturn]] void refuse_ambiguous(const std::string& name, const NumberCell& cell, const std::string& why) {
  const NumberReadings r = readings_of(cell.text);
  refuse(name, cell,
         shown(cell) + text_of(" can be %.10g or %.10g, ", *r.by_comma, *r.by_point) + why +
             "; say which with --decimal point or --decimal comma");
}

/// Whether the column's decimal mark is the comma.
bool has_decimal_comma(const std::vector<NumberCell>& column, const Evidence& own, const Evidence& columns,
                       const Evidence& others, const std::string& name) {
  if (own.point && own.comma)
    refuse(name, own.point->line > own.comma->line ? *own.point : *own.comma,
           on_line(*own.point) + " has a decimal point, " + on_line(*own.comma) +
               " a decimal comma: a column has one form; correct the wrong one");
  if (own.point || own.comma) return own.comma != nullptr;
  if (!own.ambiguous) return false;
  if (std::any_of(column.begin(), column.end(), has_long_whole_part))
    return own.ambiguous->text.find(',') != std::string::npos;
  const NumberCell* point = columns.point ? columns.point : columns.comma ? nullptr : others.point;
  const NumberCell* comma = columns.comma ? columns.comma : columns.point ? nullptr : others.comma;
  if (own.ambiguous->text.find(',') == std::string::npos) {
    if (columns.comma)
      refuse_ambiguous(name, *own.ambiguous, "as " + on_line(*columns.comma) + " has a decimal comma");
    return false;
  }
  if ((point != nullptr) == (comma != nullptr))
    refuse_ambiguous(name, *own.ambiguous, "and nothing in the file tells which");
  return comma != nullptr;
}

}  // namespace

NumberReadings readings_of(std::string_view text) {
  const std::string plain = plain_marks(trimmed(text));
  return {number_by(plain, '.'), number_by(plain, ',')};
}

bool looks_like_a_number(std::string_view text) {
  const std::string plain = plain_marks(trimmed(text));
  return std::any_of(plain.begin(), plain.end(), is_digit) &&
         plain.find_first_not_of("0123456789+-., 'eEdD") == std::string::npos &&
         std::isalpha(static_cast<unsigned char>(plain.front())) == 0;
}

std::optional<double> clock_seconds(std::string_view text) {
  double seconds = 0.0;
  const std::string with_hours = "0:" + std::string(text);
  // "02:30.5" has minutes and seconds; "12:30" may have hours and minutes, and is no clock here
  const bool minutes =
      std::count(text.begin(), text.end(), ':') == 1 && text.find_first_of(".,") != text.npos;
  if (minutes) text = with_hours;
  for (const double unit : {3600.0, 60.0, 1.0}) {
    const std::size_t colon = text.find(':');
    if ((colon == text.npos) != (unit == 1.0) || text.empty() || !is_digit(text.front())) return std::nullopt;
    std::string part(text.substr(0, colon));
    if (unit == 1.0) std::replace(part.begin(), part.end(), ',', '.');
    const std::optional<double> value = parse_number(part);
    if (!value || !(*value >= 0.0) || (unit < 3600.0 && *value >= 60.0)) return std::nullopt;
    seconds += unit * *value;
    text.remove_prefix(std::min(text.size(), part.size() + 1));
  }
  return seconds;
}

std::vector<std::vector<double>> numbers_of(const std::vector<std::vector<NumberCell>>& columns,
                                            const std::vector<NumberCell>& others, const std::string& decimal,
                                            const std::string& name) {
  Evidence all, beside;
  std::vector<Evidence> own(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    for (const NumberCell& cell : columns[k]) {
      if (readings_of(cell.text).none()) refuse(name, cell, shown(cell) + " is not a number");
      own[k].add(cell), all.add(cell);
    }
  for (const NumberCell& cell : others) beside.add(cell);
  std::vector<std::vector<double>> numbers(columns.size());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const bool comma =
        decimal == "auto" ? has_decimal_comma(columns[k], own[k], all, beside, name) : decimal == "comma";
    for (const NumberCell& cell : columns[k]) {
      const NumberReadings r = readings_of(cell.text);
      const std::optional<double>& value = comma ? r.by_comma : r.by_point;
      if (!value) refuse(name, cell, shown(cell) + " has no decimal " + (comma ? "comma" : "point"));
      numbers[k].push_back(*value);
    }
  }
  return numbers;
}

}  // namespace tremie::detail
