#include "rheometer/records/instrument_export.hpp"

#include <algorithm>
#include <array>

#include "rheometer/records/table.hpp"
#include "rheometer/records/text_lines.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie {

using detail::LineReader, detail::lower, detail::split, detail::trimmed;

namespace {

enum Quantity : std::size_t { q_time, q_speed, q_torque };
constexpr std::array<const char*, 3> plain_name{"time", "speed", "torque"};

/// Names of the columns, lower case; the first word or two of a header decide.
const std::array<std::vector<std::string_view>, 3> known_names{
    {{"time", "zeit", "test time", "messzeit"},
     {"speed", "drehzahl", "rotational speed", "rotation speed", "rotational velocity", "velocity"},
     {"torque", "moment", "drehmoment"}}};

std::vector<std::string_view> lines_of(std::string_view text) {
  std::vector<std::string_view> lines;
  LineReader reader{text};
  while (const auto line = reader.next()) lines.push_back(*line);
  return lines;
}

std::vector<std::string_view> fields_of(std::string_view line, char separator) {
  std::vector<std::string_view> fields;
  split(line, separator, fields);
  for (std::string_view& field : fields) field = trimmed(field);
  return fields;
}

char separator_of(std::string_view line) {
  return line.find('\t') != line.npos ? '\t' : line.find(';') != line.npos ? ';' : ',';
}

/// The quantity that a header names, and what follows the name ("[mN m]").
struct Named {
  std::size_t quantity;
  std::string unit;
};

std::optional<Named> named(std::string_view header) {
  const std::string text = lower(header);
  for (std::size_t q = 0; q < 3; ++q)
    for (const std::string_view name : known_names[q]) {
      if (!text.starts_with(name)) continue;
      const std::string rest(trimmed(header.substr(name.size())));
      const bool unit = rest.empty() || std::string_view("[(_,").find(rest.front()) != std::string_view::npos;
      if (unit) return Named{q, rest};
    }
  return std::nullopt;
}

struct Header {
  std::size_t line = 0, units_line = 0;  ///< from 0
  char separator = ',';
  std::array<std::size_t, 3> column{};  ///< from 1; 0: not there
  std::array<std::string, 3> unit;
};

std::optional<Header> header_at(const std::vector<std::string_view>& lines, std::size_t at) {
  Header h;
  h.line = h.units_line = at;
  h.separator = separator_of(lines[at]);
  const auto fields = fields_of(lines[at], h.separator);
  for (std::size_t i = 0; i < fields.size(); ++i)
    if (const auto n = named(fields[i]); n && h.column[n->quantity] == 0) {
      h.column[n->quantity] = i + 1;
      h.unit[n->quantity] = n->unit;
    }
  if (h.column[q_torque] == 0 || (h.column[q_time] == 0 && h.column[q_speed] == 0)) return std::nullopt;
  return h;
}

/// Units in brackets in one of the three lines below the header.
void find_units(const std::vector<std::string_view>& lines, Header& h, const std::string& name) {
  for (std::size_t below = 1; below <= 3 && h.line + below < lines.size(); ++below) {
    const auto fields = fields_of(lines[h.line + below], h.separator);
    for (std::size_t q = 0; q < 3; ++q) {
      const std::size_t i = h.column[q];
      if (i == 0 || !h.unit[q].empty() || fields.size() < i || !fields[i - 1].starts_with('[')) continue;
      h.unit[q] = fields[i - 1];
      h.units_line = h.line + below;
    }
  }
  for (std::size_t q = 0; q < 3; ++q)
    if (h.column[q] != 0 && h.unit[q].empty())
      throw RecordError(at_position(name, static_cast<long>(h.line) + 1, h.column[q],
                                    std::string("the column of ") + plain_name[q] +
                                        " has no unit; write it into the header, like \"" + plain_name[q] +
                                        (q == q_time    ? " [s]\""
                                         : q == q_speed ? " [rpm]\""
                                                        : " [mN m]\"")));
}

/// "1.298,5" as "1298.5" where columns are not separated by commas.
std::string plain_number(std::string field, char separator) {
  if (separator == ',' || field.find(',') == std::string::npos) return field;
  std::erase(field, '.');
  std::replace(field.begin(), field.end(), ',', '.');
  return field;
}

}  // namespace

std::optional<PlainExport> plain_export(std::string_view text, const std::string& name) {
  const std::vector<std::string_view> lines = lines_of(text);
  std::optional<Header> found;
  for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 200) && !found; ++i)
    if (!lines[i].starts_with('#')) found = header_at(lines, i);
  if (!found) return std::nullopt;
  // Plain English columns without a speed beside a time need no help, and keep the messages of their reader.
  const auto fields = fields_of(lines[found->line], found->separator);
  const bool both = found->column[q_time] != 0 && found->column[q_speed] != 0;
  const bool first = std::all_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(found->line),
                                 [](std::string_view l) { return trimmed(l).empty() || l.starts_with('#'); });
  const std::size_t x = found->column[q_time] != 0 ? q_time : q_speed;
  if (first && !both && !found->unit[x].empty() && !found->unit[q_torque].empty() &&
      fields[found->column[q_torque] - 1].starts_with("torque"))
    return std::nullopt;
  find_units(lines, *found, name);

  PlainExport out;
  std::size_t rows = 0, empty = 0, repeated = 0;
  const auto put_row = [&](const std::vector<std::string>& cells) {
    std::string row;
    for (std::size_t q = 0; q < 3; ++q)
      if (found->column[q] != 0) row += (row.empty() ? "" : ";") + cells[q];
    out.text += row;
  };
  for (std::size_t i = 0; i < lines.size(); ++i, out.text += '\n') {
    if (i == found->line) {
      put_row({"time_" + found->unit[q_time], "speed_" + found->unit[q_speed],
               "torque_" + found->unit[q_torque]});
      continue;
    }
    if (i <= found->units_line) continue;
    const auto cells = fields_of(lines[i], found->separator);
    std::vector<std::string> values(3);
    bool complete = true;
    for (std::size_t q = 0; q < 3; ++q) {
      const std::size_t c = found->column[q];
      if (c == 0) continue;
      if (cells.size() >= c) values[q] = plain_number(std::string(cells[c - 1]), found->separator);
      complete = complete && !values[q].empty();
    }
    if (!complete) {
      empty += !trimmed(lines[i]).empty();
      continue;
    }
    const bool header = header_at(lines, i).has_value() || values[q_torque].starts_with('[');
    if (header) {
      ++repeated;
      continue;
    }
    put_row(values);
    ++rows;
  }
  for (std::size_t q = 0; q < 3; ++q)
    if (found->column[q] != 0)
      out.understood.push_back("column " + std::to_string(found->column[q]) + " '" +
                               std::string(fields[found->column[q] - 1]) + "' is the " + plain_name[q] +
                               ", unit " + found->unit[q]);
  out.understood.push_back(std::to_string(rows) + " rows below line " +
                           std::to_string(found->units_line + 1) + "; " + std::to_string(empty) +
                           " lines without a value left out, " + std::to_string(repeated) +
                           " repeated header lines");
  return out;
}

}  // namespace tremie
