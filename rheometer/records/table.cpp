#include "rheometer/records/table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "rheometer/records/number_text.hpp"
#include "rheometer/records/text_lines.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie {

using detail::LineReader, detail::lower, detail::split, detail::trimmed;

std::string at_position(const std::string& name, long line, std::size_t column, const std::string& what) {
  return name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + what;
}

namespace {

[[noreturn]] void fail(const std::string& name, long line, std::size_t column, const std::string& what) {
  throw RecordError(at_position(name, line, column, what));
}

bool carries_nothing(std::string_view line) {
  const std::string_view s = trimmed(line);
  return s.empty() || s.front() == '#';
}

/// Lower case, "per" as "/", micro as "u", without blanks, brackets, underscores and multiplication signs.
std::string normal_unit(std::string_view text) {
  static const std::pair<std::string_view, std::string_view> spellings[] = {
      {"\u00B7", ""},  {"\u22C5", ""}, {"\u00D7", ""}, {"\u00B5", "u"},
      {"\u03BC", "u"}, {"per", "/"},   {"PER", "/"}};
  std::string s;
  while (!text.empty()) {
    const auto match = std::find_if(std::begin(spellings), std::end(spellings),
                                    [&](const auto& spelling) { return text.starts_with(spelling.first); });
    if (match != std::end(spellings)) {
      s += match->second;
      text.remove_prefix(match->first.size());
      continue;
    }
    if (std::string_view(" _()[].*\t").find(text.front()) == std::string_view::npos)
      s += static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
    text.remove_prefix(1);
  }
  return s;
}

/// The header starts with the quantity's name as a word of its own: "torque_N_m", not "torques".
bool names(std::string_view header, std::string_view quantity) {
  return lower(header).starts_with(quantity) &&
         (header.size() == quantity.size() ||
          !std::isalnum(static_cast<unsigned char>(header[quantity.size()])));
}

struct Column {
  std::size_t index = 0;  ///< of the field
  double factor = 1.0;    ///< to SI
};

double factor_of(const ColumnQuantity& q, std::string_view header, const std::string& name, long line,
                 std::size_t position) {
  const std::string unit = normal_unit(header.substr(q.name.size()));
  for (const auto& [known, factor] : q.units)
    if (unit == known) return factor;
  const std::string what = unit.empty() ? "the column has no unit" : "unknown unit";
  fail(name, line, position, what + " in '" + std::string(header) + "'; allowed: " + std::string(q.allowed));
}

std::vector<std::optional<Column>> read_header(const std::vector<std::string_view>& fields,
                                               const std::string& name, long line,
                                               const std::vector<ColumnQuantity>& quantities) {
  std::vector<std::optional<Column>> found(quantities.size());
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string_view header = trimmed(fields[i]);
    for (std::size_t k = 0; k < quantities.size(); ++k) {
      if (!names(header, quantities[k].name)) continue;
      if (found[k]) fail(name, line, i + 1, "a second column of " + std::string(quantities[k].name));
      found[k] = Column{i, factor_of(quantities[k], header, name, line, i + 1)};
    }
  }
  return found;
}

double number(std::string_view field, bool decimal_comma, const std::string& name, long line,
              std::size_t position) {
  std::string_view s = trimmed(field);
  char buffer[64];
  if (decimal_comma && s.size() < sizeof buffer && s.find(',') != std::string_view::npos) {
    std::replace_copy(s.begin(), s.end(), buffer, ',', '.');
    s = {buffer, s.size()};
  }
  if (!s.empty() && s.front() == '+') s.remove_prefix(1);
  const std::optional<double> value = parse_number(s);
  if (!value || !std::isfinite(*value)) {
    const std::string shown(trimmed(field).substr(0, 40));
    fail(name, line, position,
         shown.empty() ? "no value; a number is needed here" : "'" + shown + "' is not a number");
  }
  return *value;
}

}  // namespace

NumberTable parse_number_table(std::string_view text, const std::string& name,
                               const std::vector<ColumnQuantity>& quantities) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF"))
    fail(name, 1, 1, "the file is in UTF-16; save it as UTF-8 or plain text");
  LineReader lines{text};
  std::optional<std::string_view> line;
  while ((line = lines.next()) && carries_nothing(*line)) {
  }
  if (!line) fail(name, std::max(1L, lines.number), 1, "the file is empty; a header and rows are needed");

  const char separator = line->find(';') != std::string_view::npos    ? ';'
                         : line->find('\t') != std::string_view::npos ? '\t'
                                                                      : ',';
  std::vector<std::string_view> fields;
  split(*line, separator, fields);
  const std::size_t width = fields.size();
  const auto columns = read_header(fields, name, lines.number, quantities);
  NumberTable table;
  table.header_line = lines.number;
  table.column.resize(quantities.size());
  for (const auto& column : columns) table.position.push_back(column ? column->index + 1 : 0);

  while ((line = lines.next())) {
    if (carries_nothing(*line)) continue;
    split(*line, separator, fields);
    if (fields.size() != width)
      fail(name, lines.number, std::min(width, fields.size()),
           "the row has " + std::to_string(fields.size()) + " columns where the header has " +
               std::to_string(width) +
               (separator == ',' ? "; a decimal comma needs semicolons or tabs between the columns" : ""));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      if (!columns[k]) continue;
      table.column[k].push_back(columns[k]->factor * number(fields[columns[k]->index], separator != ',', name,
                                                            lines.number, columns[k]->index + 1));
    }
    table.line.push_back(lines.number);
  }
  return table;
}

}  // namespace tremie
