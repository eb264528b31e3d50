#include "rheometer/tables/table.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "rheometer/tables/column_names.hpp"
#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/groups.hpp"
#include "rheometer/tables/headers.hpp"
#include "rheometer/tables/number_column.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

using detail::all_empty, detail::carries_nothing, detail::clock_seconds, detail::count_numbers,
    detail::factor_of, detail::fields_of, detail::given_columns, detail::Header, detail::Headers,
    detail::is_of_oscillation, detail::is_placeholder, detail::lines_of, detail::looks_like_a_number,
    detail::lower, detail::measures_a_modulus, detail::NamedColumn, detail::normal_unit, detail::NumberCell,
    detail::numbers_of, detail::row_fields, detail::TextLine, detail::trimmed;

std::string at_position(const std::string& name, long line, std::size_t column, const std::string& what) {
  return name + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + what;
}

namespace {

[[noreturn]] void fail(const std::string& name, long line, std::size_t column, const std::string& what) {
  throw RecordError(at_position(name, line, column, what));
}

/// Of a file whose tables have different columns: the kind of table that is read, or one table.
struct Kept {
  std::optional<std::size_t> kind = {};  ///< quantities that its tables have, a bit each
  std::size_t table = 0;                 ///< from 1; 0: all of the kind

  bool chosen() const { return kind || table > 0; }
};

class Reader {
  static constexpr std::size_t most_grouped = 20000;  ///< rows of a table in which groups are looked for

 public:
  Reader(std::string_view text, const std::string& name, const std::vector<ColumnQuantity>& quantities,
         const ReadOptions& options, const ColumnSets& sets, const Kept& kept = {})
      : name_(name),
        quantities_(quantities),
        options_(options),
        sets_(sets),
        kept_(kept),
        lines_(lines_of(text)),
        headers_{lines_, quantities, sets, given_columns(options.columns, quantities)} {
    table_.column.resize(quantities.size());
    table_.position.assign(quantities.size(), 0);
    cells_.resize(quantities.size());
    factors_.resize(quantities.size());
  }

  /// Which tables count where they have different columns: the one that is asked for, or those of the kind with the most rows;
  /// a torque without a speed only where there is nothing else. Empty where all are of one kind.
  Kept kept() const {
    if (kinds_.size() < 2) return {};
    if (options_.table > 0) return {.table = options_.table};
    const auto rank = [](const auto& kind) {
      constexpr std::size_t rates = (1u << q_speed) | (1u << q_shear_rate);
      return std::pair((kind.first & rates) != 0, kind.second);
    };
    return {.kind = std::max_element(kinds_.begin(), kinds_.end(), [&](const auto& a, const auto& b) {
                      return rank(a) < rank(b);
                    })->first};
  }

  NumberTable operator()() {
    require_text();
    std::optional<Header> header = headers_.first_header();
    if (!header) return without_header();
    strict_ = is_first_text(header->at) && header->plain && !kept_.chosen();
    while (header) header = read_table(*header);
    if (kinds_.size() > 1) return table_;
    if (table_.position == std::vector<std::size_t>(quantities_.size(), 0)) return table_;
    convert();
    if (ages_ > 0 && ages_ == with_rows_) drop_ages();
    if (table_.line.empty() && oscillating_ > 0)
      fail(
          name_, table_.header_line, 1,
          "the rows are those of an oscillation (they have a storage or loss modulus); a rotation is needed: "
          "a flow curve, a start-up or a decay");
    if (!strict_ || left_out_ + oscillating_ + other_rows_ + statistics_ > 0 || tables_.size() > 1)
      tell_counts();
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

  [[noreturn]] void fail_doubled(const Header& h) const {
    const std::string quantity(quantities_[h.doubled_quantity].name);
    fail(name_, lines_[h.at].number, *h.doubled + 1,
         "'" + h.fields[*h.doubled] + "' is a second column of " + quantity + "; say which with --column " +
             quantity + "=" + std::to_string(*h.doubled + 1));
  }

  NumberTable without_header() {
    std::size_t at = 0;
    while (carries_nothing(lines_[at].text) && at + 1 < lines_.size()) ++at;
    Header h;
    for (std::size_t i = lines_.size(); i-- > 0;)  // the first line with one quantity, for the message
      for (const char separator : {'\t', ';', ','})
        if (Header one = headers_.columns_of(fields_of(lines_[i].text, separator), i, separator);
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

  double unit_factor(const Header& h, std::size_t q) const {
    const NamedColumn& c = *h.column[q];
    const std::string what = c.unit.empty() ? "the column has no unit in '" : "unknown unit in '";
    const long line = lines_[h.at].number;
    const auto factor = factor_of(quantities_[q], c.unit);
    if (!factor)
      fail(name_, line, h.index[q] + 1,
           what + h.fields[h.index[q]] + "'; allowed: " + std::string(quantities_[q].allowed) +
               "; or say it: --column \"" + headers_.columns_without_units(h) + "\"");
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

  std::size_t kind_of(const Header& h) const {
    std::size_t kind = 0;
    for (std::size_t q = 0; q < quantities_.size(); ++q) kind |= std::size_t{h.has(q)} << q;
    return kind;
  }

  /// Reads the rows below the header; the header of the next table, if there is one.
  std::optional<Header> read_table(Header h) {
    if (h.doubled && (!sets_.empty() || h.named >= 2) && headers_.has_numbers(h, *h.doubled)) fail_doubled(h);
    headers_.keep_a_set(h);
    const std::size_t begin = headers_.find_units(h), kind = kind_of(h), number = ++headed_;
    const bool kept = kept_.table > 0 ? number == kept_.table : !kept_.kind || kind == *kept_.kind;
    if (table_.header.empty() && kept) {
      table_.header_line = lines_[h.at].number;
      table_.header = h.fields;
      table_.of_oscillation = !h.moduli.empty();
    }
    if (h.has(0) && !factor_of(quantities_[0], h.column[0]->unit) && begin < lines_.size() &&
        quantities_[0].name == "time")
      if (auto first = fields_of(lines_[begin].text, h.separator); read_clock(h, first))
        h.column[0]->unit = "s";
    std::vector<double> factor(quantities_.size());
    const std::size_t first_row = table_.line.size();
    for (std::size_t q = 0; q < quantities_.size(); ++q)
      if (h.has(q) && kept) factor[q] = unit_factor(h, q);
    std::optional<Header> next;
    std::vector<std::size_t> gaps;  // rows in front of which a line of empty fields stands
    behind_a_gap_ = false;
    row_texts_.clear(), title_.clear();
    std::size_t last_gap = 0;  // the row behind the last blank line
    bool other = !kept;        // below a header of columns that are not asked for
    for (std::size_t i = begin; i < lines_.size() && !next; ++i) {
      if (carries_nothing(lines_[i].text)) {
        behind_a_gap_ = true;
        continue;
      }
      if (other) {
        next = headers_.next_header(i);
        other_rows_ += !next && count_numbers(fields_of(lines_[i].text, h.separator)) > 1;
        continue;
      }
      auto fields = row_fields(lines_[i].text, h.separator, h.fields);
      if (table_.line.size() > first_row && fields.size() > 1 && all_empty(fields))
        gaps.push_back(table_.line.size());
      read_clock(h, fields);
      if (takes_row(h, fields, lines_[i].number)) {
        if (behind_a_gap_) last_gap = table_.line.size();
        put_row(h, fields, factor, lines_[i].number);
        behind_a_gap_ = false;
      } else {
        next = headers_.header_at(i);
        if (next && !behind_a_gap_ && next->fields == h.fields) {  // a header repeated within the table
          next.reset();
          continue;
        }
        if (const std::string title = lone_text(fields); !title.empty()) title_ = title;
        next = headers_.next_header(i);
        other = !next && headers_.heads_other_columns(h, fields, i, behind_a_gap_);
        behind_a_gap_ = true;
      }
    }
    if (!kept) return next;
    if (const std::size_t behind = table_.line.size() - last_gap;
        last_gap > first_row && behind < detail::fewest_of_group)
      table_.understood.push_back("the last " + std::to_string(behind) +
                                  " rows stand behind a blank line and count as readings");
    if (table_.line.size() > first_row) {
      ++with_rows_;
      tell_tables(h, first_row, gaps);
      if (is_torque_table()) kinds_[kind] += table_.line.size() - first_row;
    }
    if (first_row == 0)
      for (std::size_t q = 0; q < quantities_.size(); ++q)
        if (h.has(q)) table_.position[q] = h.index[q] + 1;
    return next;
  }

  /// "Sample A;;": the one text of a line without numbers.
  static std::string lone_text(const std::vector<std::string>& fields) {
    std::string text;
    for (const std::string& f : fields) {
      if (f.empty()) continue;
      if (!text.empty() || looks_like_a_number(f)) return {};
      text = f;
    }
    return text;
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
    if (is_torque_table() && detail::is_a_statistic(fields.front())) {
      ++statistics_;
      return false;
    }
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
    if (is_torque_table() && row_texts_.size() < most_grouped) {
      row_texts_.push_back(fields);
      row_texts_.back().resize(h.fields.size());
      row_texts_.back().push_back(title_);
    }
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

  void drop_ages() {
    table_.understood.push_back("column " + std::to_string(table_.position[q_time]) +
                                " is no clock of the test: it stays the same over rows of different speeds");
    table_.column[q_time].clear();
    table_.position[q_time] = 0;
  }

  // --- what was understood

  /// The rows from `first_row` on as the search for groups wants them. A time that stays the same over rows of different speeds
  /// is no clock: it is the age of a sample.
  detail::GroupedRows grouped_rows(const Header& h, std::size_t first_row) {
    detail::GroupedRows table{std::move(row_texts_), h.groups, {}, {}, {}};
    row_texts_.clear();
    const auto numbers = [&](std::size_t q) {
      std::vector<double> values;
      for (std::size_t i = first_row; i < table_.line.size(); ++i) {
        const auto read = detail::readings_of(cells_[q][cells_[q].size() - table_.line.size() + i].text);
        values.push_back(read.by_point.value_or(read.by_comma.value_or(0.0)));
      }
      return values;
    };
    for (const std::size_t q : {q_shear_rate, q_speed})
      if (h.has(q)) table.abscissa = numbers(q);
    for (std::size_t i = 0; i <= h.fields.size(); ++i) {  // behind the last one stands the title of the rows
      bool quantity = false;
      for (std::size_t q = 0; q < quantities_.size(); ++q)
        quantity = quantity || (h.has(q) && h.index[q] == i);
      if (!quantity && std::find(h.groups.begin(), h.groups.end(), i) == h.groups.end())
        table.others.push_back(i);
    }
    if (h.has(q_time)) table.clock = numbers(q_time);
    return table;
  }

  detail::Groups find_groups(const Header& h, std::size_t first_row) {
    if (!is_torque_table() || row_texts_.size() != table_.line.size() - first_row) return {};
    detail::GroupedRows rows = grouped_rows(h, first_row);
    if (h.has(q_time) && !rows.abscissa.empty()) {
      detail::GroupedRows by_time = rows;
      by_time.clock.clear(), by_time.named.clear(), by_time.others = {h.index[q_time]};
      if (auto ages = detail::groups_of(by_time); !ages.starts.empty()) {
        ++ages_;
        return ages;
      }
    }
    detail::Groups groups = detail::groups_of(rows);
    table_.grouped = table_.grouped || !groups.starts.empty();
    if (!groups.mixed.empty())
      table_.understood.push_back("column " + std::to_string(groups.column + 1) + " '" +
                                  (groups.column < h.fields.size() ? h.fields[groups.column] : "title") +
                                  "' changes (" + groups.mixed + "); its rows are read as one record");
    return groups;
  }

  /// Rows under one header are one table, or several: with lines of empty fields between three rows or more, or of groups.
  void tell_tables(const Header& h, std::size_t first_row, std::vector<std::size_t> gaps) {
    const std::size_t rows = table_.line.size();
    std::size_t start = first_row;
    const detail::Groups groups = find_groups(h, first_row);
    for (const std::size_t row : groups.starts) gaps.push_back(first_row + row);
    std::sort(gaps.begin(), gaps.end());
    const auto tell = [&](std::size_t end) {
      table_.starts.push_back(start);
      const std::string label = groups.starts.empty() ? "" : groups.label[start - first_row];
      tables_.push_back("lines " + std::to_string(table_.line[start]) + " to " +
                        std::to_string(table_.line[end - 1]) + (label.empty() ? "" : " (" + label + ")"));
      start = end;
    };
    for (const std::size_t gap : gaps)
      if (gap >= start + detail::fewest_of_group && rows >= gap + detail::fewest_of_group) tell(gap);
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
    table_.left_out = left_out_;
    if (left_out_ > 0) text += "; " + std::to_string(left_out_) + " rows without a value left out";
    if (other_rows_ > 0)
      text += "; " + std::to_string(other_rows_) + " rows of tables with other columns left out" +
              (kept_.chosen() ? " (--table reads another)" : "");
    if (statistics_ > 0) text += "; " + std::to_string(statistics_) + " rows of statistics left out";
    if (oscillating_ > 0) text += "; " + std::to_string(oscillating_) + " rows of an oscillation left out";
    table_.understood.push_back(text);
  }

  const std::string& name_;
  const std::vector<ColumnQuantity>& quantities_;
  const ReadOptions& options_;
  const ColumnSets& sets_;
  const Kept kept_;
  std::vector<TextLine> lines_;
  Headers headers_;
  std::vector<std::vector<NumberCell>> cells_;
  std::vector<std::vector<double>> factors_;
  std::vector<NumberCell> others_;
  std::vector<std::vector<std::string>> row_texts_;  ///< of the table that is read
  std::string title_;                                ///< a lone text above the rows that follow
  std::size_t ages_ = 0;                             ///< tables whose time is the age of a sample
  std::map<std::size_t, std::size_t> kinds_;         ///< rows of each kind of table
  std::size_t headed_ = 0, with_rows_ = 0;           ///< tables so far, and those with rows
  std::vector<std::string> tables_;
  std::size_t left_out_ = 0, oscillating_ = 0, other_rows_ = 0, statistics_ = 0;
  bool strict_ = false;
  bool behind_a_gap_ = false;  ///< the line before the one that is read is blank, or text behind a blank one
  NumberTable table_;
};

}  // namespace

NumberTable parse_number_table(std::string_view text, const std::string& name,
                               const std::vector<ColumnQuantity>& quantities, const ReadOptions& options,
                               const ColumnSets& sets) {
  const std::string decoded = decoded_text(text, name);
  Reader all(decoded, name, quantities, options, sets);
  NumberTable table = all();
  const Kept kept = all.kept();
  if (!kept.chosen()) return table;
  table = Reader(decoded, name, quantities, options, sets, kept)();
  table.chosen = kept.table > 0;
  return table;
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
