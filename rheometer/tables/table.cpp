#include "rheometer/tables/table.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/tables/column_names.hpp"
#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/number_column.hpp"
#include "rheometer/tables/row_fields.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

using detail::clock_seconds, detail::factor_of, detail::fields_of, detail::given_columns, detail::GivenColumn,
    detail::is_given, detail::is_of_oscillation, detail::lines_of, detail::looks_like_a_number, detail::lower,
    detail::named_column, detail::NamedColumn, detail::normal_unit, detail::NumberCell, detail::numbers_of,
    detail::TextLine, detail::all_empty, detail::count_numbers, detail::is_placeholder,
    detail::measures_a_modulus, detail::row_fields, detail::trimmed, detail::wide_blanks;

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

/// Where each quantity stands in a table.
struct Header {
  std::size_t at = 0;  ///< index of the line
  char separator = ',';
  std::vector<std::string> fields;
  std::vector<std::optional<NamedColumn>> column;  ///< of each quantity
  std::vector<std::size_t> index;                  ///< of the field, from 0
  std::size_t named = 0;                           ///< how many are there
  bool plain = true;                               ///< English names with units, which leave nothing to tell
  std::optional<std::size_t> doubled = {};  ///< field of a second column of a quantity, as good as the first
  std::vector<std::size_t> moduli = {};     ///< fields that only an oscillation fills

  bool has(std::size_t q) const { return column[q].has_value(); }
};

class Reader {
 public:
  Reader(std::string_view text, const std::string& name, const std::vector<ColumnQuantity>& quantities,
         const ReadOptions& options, const ColumnSets& sets)
      : name_(name), quantities_(quantities), options_(options), sets_(sets), lines_(lines_of(text)) {
    given_ = given_columns(options.columns, quantities);
    table_.column.resize(quantities.size());
    table_.position.assign(quantities.size(), 0);
    cells_.resize(quantities.size());
    factors_.resize(quantities.size());
  }

  NumberTable operator()() {
    require_text();
    std::optional<Header> header = first_header();
    if (!header) return without_header();
    table_.header_line = lines_[header->at].number;
    table_.of_oscillation = !header->moduli.empty();
    for (const std::string& field : header->fields) table_.header.push_back(field);
    strict_ = is_first_text(header->at) && header->plain;
    while (header) header = read_table(*header);
    if (table_.position == std::vector<std::size_t>(quantities_.size(), 0)) return table_;
    convert();
    if (table_.line.empty() && oscillating_ > 0)
      fail(
          name_, table_.header_line, 1,
          "the rows are those of an oscillation (they have a storage or loss modulus); a rotation is needed: "
          "a flow curve, a start-up or a decay");
    if (!strict_ || oscillating_ + other_rows_ > 0) tell_counts();
    return table_;
  }

 private:
  void require_text() const {
    for (const TextLine& l : lines_)
      if (!trimmed(l.text).empty() && (trimmed(l.text).front() != '#' || names_columns(l.text))) return;
    fail(name_, 1, 1, "the file is empty; a header and rows are needed");
  }

  bool names_columns(std::string_view line) const {
    return std::any_of(quantities_.begin(), quantities_.end(), [&](const ColumnQuantity& q) {
      return lower(line).find(q.name.substr(0, 5)) != std::string::npos;
    });
  }

  bool is_first_text(std::size_t at) const {
    return std::all_of(lines_.begin(), lines_.begin() + static_cast<std::ptrdiff_t>(at),
                       [](const TextLine& l) { return carries_nothing(l.text); });
  }

  bool is_torque_table() const { return !sets_.empty(); }

  // --- headers

  /// The columns that the fields name, or that the user gives.
  Header columns_of(std::vector<std::string> fields, std::size_t at, char separator) const {
    Header h{at, separator, std::move(fields), {}, {}, 0, true, {}, {}};
    h.column.resize(quantities_.size()), h.index.resize(quantities_.size());
    for (std::size_t i = 0; i < h.fields.size(); ++i) {
      auto named = named_column(h.fields[i], quantities_);
      for (const GivenColumn& g : given_) {
        if (named && named->quantity == g.quantity) named.reset();
        if (g.number != i + 1 && !is_given(g, h.fields[i], quantities_[g.quantity])) continue;
        const std::string unit = !g.unit.empty() ? g.unit : unit_within(h.fields[i], g.quantity);
        named = NamedColumn{g.quantity, 0, unit, false};
        h.plain = false;
        break;
      }
      if (named) take(h, *named, i);
      if (is_of_oscillation(h.fields[i])) h.moduli.push_back(i);
    }
    if (is_torque_table() && (h.has(q_shear_stress) || !h.has(q_shear_rate)))
      h.column[q_viscosity].reset();  // it is of use with a shear rate, where there is no stress
    for (const auto& c : h.column) h.named += c.has_value();
    return h;
  }

  std::string unit_within(const std::string& field, std::size_t q) const {
    if (const auto named = named_column(field, quantities_)) return named->unknown_unit ? "" : named->unit;
    for (const char open : {'[', '('})
      if (const std::size_t at = field.find(open);
          at != field.npos && factor_of(quantities_[q], field.substr(at)))
        return field.substr(at);
    return {};
  }

  void take(Header& h, const NamedColumn& named, std::size_t i) const {
    auto& column = h.column[named.quantity];
    const std::string_view own = quantities_[named.quantity].name;
    if (column && own == "viscosity") return;
    if (column) {
      const bool better = column->unknown_unit > named.unknown_unit ||
                          (column->unknown_unit == named.unknown_unit && named.rank < column->rank);
      if (!better && (named.unknown_unit > column->unknown_unit || named.rank > column->rank)) return;
      if (!better) {
        h.doubled = i;
        return;
      }
    }
    column = named;
    h.index[named.quantity] = i;
    if (own == "viscosity") return;  // says nothing of a table that does not need it
    h.plain = h.plain && !named.unit.empty() && lower(h.fields[i]).starts_with(own.substr(0, 5));
  }

  /// A header names two quantities or more; the first separator by which a line does is taken.
  std::optional<Header> header_at(std::size_t at) const {
    std::string_view line = lines_[at].text;
    if (trimmed(line).starts_with('#')) line = trimmed(line).substr(1);
    if (line.find_first_not_of("0123456789.,;-+ \t") == line.npos) return std::nullopt;
    const bool wide = line.find("  ") != line.npos;
    for (const char separator : {'\t', ';', ',', '|', wide ? wide_blanks : ' ', ' '}) {
      if (separator != wide_blanks && line.find(separator) == line.npos) continue;
      Header h = columns_of(fields_of(line, separator), at, separator);
      const bool blanks =
          separator == ' ' || separator == wide_blanks;  // between the words of a sentence too
      if (h.named < 2 || (blanks && !all_have_units(h))) continue;
      if (separator == wide_blanks) h.separator = ' ';
      h.plain = h.plain && !(h.has(0) && h.has(1));
      return h;
    }
    return std::nullopt;
  }

  bool all_have_units(const Header& h) const {
    std::size_t with_unit = 0;
    for (const auto& c : h.column) with_unit += c && !c->unit.empty() && !c->unknown_unit;
    return with_unit == h.named || h.named == h.fields.size();
  }

  [[noreturn]] void fail_doubled(const Header& h) const {
    const auto named = named_column(h.fields[*h.doubled], quantities_);
    const std::string quantity(quantities_[named ? named->quantity : 0].name);
    fail(name_, lines_[h.at].number, *h.doubled + 1,
         "'" + h.fields[*h.doubled] + "' is a second column of " + quantity + "; say which with --column " +
             quantity + "=" + std::to_string(*h.doubled + 1));
  }

  bool has_a_set(const Header& h) const {
    return std::any_of(sets_.begin(), sets_.end(), [&](const auto& set) {
      return std::all_of(set.begin(), set.end(), [&](std::size_t q) { return h.has(q); });
    });
  }

  /// Whether one of the five lines below has a number in the field.
  bool has_numbers(const Header& h, std::size_t field) const {
    for (std::size_t i = h.at + 1; i <= h.at + 5 && i < lines_.size(); ++i) {
      const auto fields = fields_of(lines_[i].text, h.separator);
      if (field < fields.size() && looks_like_a_number(fields[field])) return true;
    }
    return false;
  }

  /// Whether one of the five lines below has a number in a column of the header.
  bool has_rows(const Header& h) const {
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q) && has_numbers(h, h.index[q])) return true;
    return false;
  }

  /// The first line that names a set of columns above rows of numbers; else the first that names two quantities.
  std::optional<Header> first_header() const {
    std::optional<Header> first;
    for (const bool comments : {false, true}) {
      for (std::size_t i = 0; i < lines_.size(); ++i) {
        const std::string_view line = trimmed(lines_[i].text);
        if (line.empty() || (line.front() == '#') != comments) continue;
        const auto h = header_at(i);
        if (!h) continue;
        if ((sets_.empty() || has_a_set(*h)) && has_rows(*h)) return h;
        if (!first) first = h;
      }
      if (first) return first;
    }
    return numbered_header();
  }

  /// Columns that the user gives by numbers and units need no header.
  std::optional<Header> numbered_header() const {
    std::size_t most = 0;
    for (const GivenColumn& g : given_) {
      if (g.number == 0 || g.unit.empty()) return std::nullopt;
      most = std::max(most, g.number);
    }
    for (std::size_t i = 0; most > 0 && i < lines_.size(); ++i) {
      if (carries_nothing(lines_[i].text)) continue;
      for (const char separator : {'\t', ';', ',', '|', ' '}) {
        const auto fields = fields_of(lines_[i].text, separator);
        if (fields.size() < most) continue;
        if (!std::all_of(given_.begin(), given_.end(),
                         [&](const GivenColumn& g) { return looks_like_a_number(fields[g.number - 1]); }))
          continue;
        Header h = columns_of(std::vector<std::string>(fields.size()), i, separator);
        h.plain = false;
        return h;
      }
    }
    return std::nullopt;
  }

  NumberTable without_header() {
    std::size_t at = 0;
    while (carries_nothing(lines_[at].text) && at + 1 < lines_.size()) ++at;
    Header h;
    for (std::size_t i = lines_.size(); i-- > 0;)  // the first line with one quantity, for the message
      for (const char separator : {'\t', ';', ','})
        if (Header one = columns_of(fields_of(lines_[i].text, separator), i, separator);
            one.named > 0 && (i != h.at || h.named == 0 || one.fields.size() > h.fields.size()))
          h = one, at = i;
    if (h.named == 0)
      h.fields = fields_of(lines_[at].text, lines_[at].text.find('\t') != std::string::npos  ? '\t'
                                            : lines_[at].text.find(';') != std::string::npos ? ';'
                                                                                             : ',');
    table_.header_line = lines_[at].number;
    table_.header = h.fields;
    table_.of_oscillation = std::any_of(h.fields.begin(), h.fields.end(), is_of_oscillation);
    for (std::size_t q = 0; q < h.column.size(); ++q)
      if (h.has(q)) table_.position[q] = h.index[q] + 1;
    return table_;
  }

  /// The first of the sets that the header has; the quantities outside of it are no columns.
  void keep_a_set(Header& h) const {
    for (const auto& set : sets_) {
      if (!std::all_of(set.begin(), set.end(), [&](std::size_t q) { return h.has(q); })) continue;
      for (std::size_t q = 0; q < quantities_.size(); ++q)
        if (std::find(set.begin(), set.end(), q) == set.end()) h.column[q].reset();
      return;
    }
  }

  /// Units in one of the three lines below the header; the line behind the last one that has some.
  std::size_t find_units(Header& h) const {
    std::size_t behind = h.at + 1;
    if (h.fields.empty() ||
        std::all_of(h.fields.begin(), h.fields.end(), [](const auto& f) { return f.empty(); }))
      return h.at;  // a table without a header begins with its first row
    for (std::size_t i = h.at + 1; i <= h.at + 3 && i < lines_.size(); ++i) {
      const auto fields = fields_of(lines_[i].text, h.separator);
      bool units = false;
      for (std::size_t q = 0; q < quantities_.size(); ++q) {
        if (!h.has(q) || h.index[q] >= fields.size()) continue;
        const std::string& text = fields[h.index[q]];
        if (looks_like_a_number(text)) return behind;
        if (!factor_of(quantities_[q], text)) continue;
        units = true;
        if (h.column[q]->unit.empty()) h.column[q]->unit = text;
      }
      if (units) behind = i + 1;
    }
    return behind;
  }

  /// "shear_rate=1 [unit]; shear_stress=2 [unit]": what is missing, for the user to fill in.
  std::string columns_without_units(const Header& h) const {
    std::string text;
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q) && !factor_of(quantities_[q], h.column[q]->unit))
        text += (text.empty() ? "" : "; ") + std::string(quantities_[q].name) + "=" +
                std::to_string(h.index[q] + 1) + " [unit]";
    return text;
  }

  double unit_factor(const Header& h, std::size_t q) const {
    const NamedColumn& c = *h.column[q];
    const std::string what = c.unit.empty() ? "the column has no unit in '" : "unknown unit in '";
    const long line = lines_[h.at].number;
    const auto factor = factor_of(quantities_[q], c.unit);
    if (!factor)
      fail(name_, line, h.index[q] + 1,
           what + h.fields[h.index[q]] + "'; allowed: " + std::string(quantities_[q].allowed) +
               "; or say it: --column \"" + columns_without_units(h) + "\"");
    if (!std::isnan(*factor)) return *factor;
    const std::string unit = normal_unit(c.unit);
    const bool percent = unit == "%" || unit == "/cent" || unit == "pct";
    const auto& spring = percent ? options_.full_scale_torque : options_.torque_per_degree;
    if (!spring)
      fail(name_, line, h.index[q] + 1,
           "'" + h.fields[h.index[q]] + "' has " +
               (percent ? "shares of the spring's full torque: give that torque, --full-scale-torque "
                          "\"0.7187 mN.m\" "
                          "(Brookfield LV 0.06737, RV 0.7187, HA 1.4374, HB 5.7496 mN.m)"
                        : "degrees of a dial: give the instrument, --geometry fann_r1b1, or its spring, "
                          "--torque-per-degree \"0.036379 mN.m\""));
    if (options_.shear_first)
      fail(name_, line, h.index[q] + 1,
           "'" + h.fields[h.index[q]] +
               "' is the reading of an instrument with a spring, not of ICAR's vane: give its geometry, "
               "--geometry \"cylinders, R_i, R_o, height\" or \"constants, Pa/(N.m), 1/s by rad/s\"");
    return *spring * (percent ? 0.01 : 1.0);
  }

  // --- rows

  /// Reads the rows below the header; the header of the next table, if there is one.
  std::optional<Header> read_table(Header h) {
    if (h.doubled && (!sets_.empty() || h.named >= 2) && has_numbers(h, *h.doubled)) fail_doubled(h);
    keep_a_set(h);
    const std::size_t begin = find_units(h);
    if (h.has(0) && h.column[0]->unit.empty() && begin < lines_.size() && quantities_[0].name == "time")
      if (auto first = fields_of(lines_[begin].text, h.separator); read_clock(h, first))
        h.column[0]->unit = "s";
    std::vector<double> factor(quantities_.size());
    const std::size_t first_row = table_.line.size();
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q)) factor[q] = unit_factor(h, q);
    std::optional<Header> next;
    std::vector<std::size_t> gaps;  // rows in front of which a line of empty fields stands
    behind_a_gap_ = false;
    bool other = false;  // below a header of columns that are not asked for
    for (std::size_t i = begin; i < lines_.size() && !next; ++i) {
      if (carries_nothing(lines_[i].text)) {
        behind_a_gap_ = true;
        continue;
      }
      if (other) {
        next = next_header(i);
        other_rows_ += !next && count_numbers(fields_of(lines_[i].text, h.separator)) > 1;
        continue;
      }
      auto fields = row_fields(lines_[i].text, h.separator, h.fields);
      if (table_.line.size() > first_row && fields.size() > 1 && all_empty(fields))
        gaps.push_back(table_.line.size());
      read_clock(h, fields);
      if (takes_row(h, fields, lines_[i].number)) {
        put_row(h, fields, factor, lines_[i].number);
        behind_a_gap_ = false;
      } else {
        next = header_at(i);
        if (next && !behind_a_gap_ && next->fields == h.fields) {  // a header repeated within the table
          next.reset();
          continue;
        }
        next = next_header(i);
        other = !next && behind_a_gap_ && heads_other_columns(h, fields, i);
        behind_a_gap_ = true;
      }
    }
    if (table_.line.size() > first_row) tell_tables(h, first_row, gaps);
    if (first_row == 0)
      for (std::size_t q = 0; q < quantities_.size(); ++q)
        if (h.has(q)) table_.position[q] = h.index[q] + 1;
    return next;
  }

  /// The header of a further table, if the line is one.
  std::optional<Header> next_header(std::size_t at) const {
    auto next = header_at(at);
    if (next && !((sets_.empty() || has_a_set(*next)) && has_rows(*next))) next.reset();
    return next;
  }

  /// Whether a line behind a gap begins a table of other columns, as a step of an oscillation does: it has texts alone,
  /// half as many as the header or more, no units in the header's columns, and rows of numbers below.
  bool heads_other_columns(const Header& h, const std::vector<std::string>& fields, std::size_t at) const {
    const auto texts = static_cast<std::size_t>(
        std::count_if(fields.begin(), fields.end(), [](const std::string& f) { return !f.empty(); }));
    if (!is_torque_table() || texts < 3 || 2 * texts < h.fields.size() || count_numbers(fields) > 0)
      return false;
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q) && h.index[q] < fields.size() && factor_of(quantities_[q], fields[h.index[q]]))
        return false;
    for (std::size_t i = at + 1; i <= at + 3 && i < lines_.size(); ++i)
      if (count_numbers(fields_of(lines_[i].text, h.separator)) > 1) return true;
    return false;
  }

  /// A clock's time as its seconds; whether it is one.
  bool read_clock(const Header& h, std::vector<std::string>& fields) const {
    if (!h.has(0) || quantities_[0].name != "time" || h.index[0] >= fields.size()) return false;
    const std::optional<double> seconds = clock_seconds(fields[h.index[0]]);
    if (seconds) fields[h.index[0]] = text_of("%.10g", *seconds);
    return seconds.has_value();
  }

  /// Whether the line is a row of the table; a text in place of one number, or a column too many, is refused.
  bool takes_row(const Header& h, const std::vector<std::string>& fields, long line) {
    std::size_t numbers = 0, empty = 0, texts = 0, text_at = 0, empty_at = 0;
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
      if (!h.has(q)) continue;
      const std::size_t i = h.index[q];
      if (i >= fields.size() || is_placeholder(fields[i]))
        ++empty, empty_at = i;
      else if (looks_like_a_number(fields[i]))
        ++numbers;
      else
        ++texts, text_at = i;
    }
    if (numbers == 0) return false;
    if (is_torque_table() && measures_a_modulus(fields, h.moduli)) {
      ++oscillating_;
      return false;
    }
    const bool starts_with_text = !fields.front().empty() && !looks_like_a_number(fields.front());
    if (texts > 0 && behind_a_gap_ && starts_with_text)
      return false;  // "Yield stress, 54, Pa" below the table
    if (!fields.front().empty() && fields.front().back() == ':')
      return false;  // "Interval and data points: 2 20"
    const std::size_t width = h.fields.size();
    const bool more =
        fields.size() > width && std::any_of(fields.begin() + static_cast<std::ptrdiff_t>(width),
                                             fields.end(), [](const std::string& f) { return !f.empty(); });
    if (more || (strict_ && fields.size() < width))
      fail(name_, line, std::min(width, fields.size()),
           "the row has " + std::to_string(fields.size()) + " columns where the header has " +
               std::to_string(width) +
               (h.separator == ',' && more
                    ? "; a decimal comma needs quotes around its number, or semicolons or tabs "
                      "between the columns"
                    : ""));
    if (texts > 0) fail(name_, line, text_at + 1, "'" + fields[text_at].substr(0, 40) + "' is not a number");
    if (empty > 0 && strict_) {
      const std::string text = empty_at < fields.size() ? fields[empty_at] : "";
      fail(name_, line, empty_at + 1,
           text.empty() ? "no value; a number is needed here" : "'" + text + "' is not a number");
    }
    left_out_ += empty > 0;
    return empty == 0;
  }

  void put_row(const Header& h, const std::vector<std::string>& fields, const std::vector<double>& factor,
               long line) {
    for (std::size_t i = 0; i < fields.size(); ++i) {
      std::size_t q = 0;
      while (q < quantities_.size() && !(h.has(q) && h.index[q] == i)) ++q;
      if (q < quantities_.size()) {
        cells_[q].push_back({fields[i], line, i + 1});
        factors_[q].push_back(factor[q]);
      } else if (others_.size() < 1000 && looks_like_a_number(fields[i])) {
        others_.push_back({fields[i], line, i + 1});
      }
    }
    table_.line.push_back(line);
  }

  void convert() {
    const auto numbers = numbers_of(cells_, others_, options_.decimal, name_);
    for (std::size_t q = 0; q < quantities_.size(); ++q) {
      if (numbers[q].size() != table_.line.size()) {  // not in all tables
        if (!numbers[q].empty())
          fail(name_, table_.header_line, table_.position[q],
               "the tables of the file have different columns: one of " + std::string(quantities_[q].name) +
                   " is not in all; keep one kind of table");
        continue;
      }
      for (std::size_t i = 0; i < numbers[q].size(); ++i)
        table_.column[q].push_back(factors_[q][i] * numbers[q][i]);
    }
  }

  // --- what was understood

  /// Rows under one header are one table, or several with lines of empty fields between three rows or more.
  void tell_tables(const Header& h, std::size_t first_row, const std::vector<std::size_t>& gaps) {
    constexpr std::size_t fewest = 3;
    const std::size_t rows = table_.line.size();
    std::size_t start = first_row;
    const auto tell = [&](std::size_t end) {
      table_.starts.push_back(start);
      tables_.push_back("lines " + std::to_string(table_.line[start]) + " to " +
                        std::to_string(table_.line[end - 1]));
      start = end;
    };
    for (const std::size_t gap : gaps)
      if (gap >= start + fewest && rows >= gap + fewest) tell(gap);
    tell(rows);
    if (strict_ || first_row > 0) return;
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q))
        table_.understood.push_back("column " + std::to_string(h.index[q] + 1) + " '" + h.fields[h.index[q]] +
                                    "' is the " + std::string(quantities_[q].name) + ", unit " +
                                    h.column[q]->unit);
  }

  void tell_counts() {
    std::string text = std::to_string(table_.line.size()) + " rows";
    if (tables_.size() > 1) {
      text += " in " + std::to_string(tables_.size()) + " tables";
      for (std::size_t i = 0; i < tables_.size() && i < 8; ++i) text += (i == 0 ? ": " : "; ") + tables_[i];
      if (tables_.size() > 8) text += "; ...";
    } else if (!tables_.empty()) {
      text += ", " + tables_.front();
    }
    if (left_out_ > 0) text += "; " + std::to_string(left_out_) + " rows without a value left out";
    if (other_rows_ > 0)
      text += "; " + std::to_string(other_rows_) + " rows of tables with other columns left out";
    if (oscillating_ > 0) text += "; " + std::to_string(oscillating_) + " rows of an oscillation left out";
    table_.understood.push_back(text);
  }

  const std::string& name_;
  const std::vector<ColumnQuantity>& quantities_;
  const ReadOptions& options_;
  const ColumnSets& sets_;
  std::vector<TextLine> lines_;
  std::vector<GivenColumn> given_;
  std::vector<std::vector<NumberCell>> cells_;
  std::vector<std::vector<double>> factors_;
  std::vector<NumberCell> others_;
  std::vector<std::string> tables_;
  std::size_t left_out_ = 0, oscillating_ = 0, other_rows_ = 0;
  bool strict_ = false;
  bool behind_a_gap_ = false;  ///< the line before the one that is read is blank, or text behind a blank one
  NumberTable table_;
};

}  // namespace

NumberTable parse_number_table(std::string_view text, const std::string& name,
                               const std::vector<ColumnQuantity>& quantities, const ReadOptions& options,
                               const ColumnSets& sets) {
  const std::string decoded = decoded_text(text, name);
  return Reader(decoded, name, quantities, options, sets)();
}

NumberTable parse_torque_table(std::string_view text, const std::string& name, const ReadOptions& options) {
  static const ColumnSets torque_first{{q_time, q_speed, q_torque},
                                       {q_speed, q_torque},
                                       {q_time, q_shear_rate, q_shear_stress},
                                       {q_shear_rate, q_shear_stress},
                                       {q_time, q_shear_rate, q_viscosity},
                                       {q_shear_rate, q_viscosity},
                                       {q_time, q_torque}},
      shear_first{{q_time, q_shear_rate, q_shear_stress},
                  {q_shear_rate, q_shear_stress},
                  {q_time, q_shear_rate, q_viscosity},
                  {q_shear_rate, q_viscosity},
                  {q_time, q_speed, q_torque},
                  {q_speed, q_torque},
                  {q_time, q_torque}};
  return parse_number_table(text, name, torque_quantities(), options,
                            options.shear_first ? shear_first : torque_first);
}

}  // namespace tremie
