#include "rheometer/tables/headers.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include "rheometer/tables/number_column.hpp"

namespace tremie::detail {

namespace {

/// Names of columns that tell samples and runs apart, as far as they stand at the beginning of a header.
bool tells_a_group(std::string_view header) {
  static const std::string_view names[] = {"sample",       "specimen",
                                           "mix",          "material",
                                           "fluid",        "mud",
                                           "concrete",     "paste",
                                           "batch",        "lot",
                                           "age",          "formulation",
                                           "series",       "group",
                                           "ramp",         "run",
                                           "branch",       "direction",
                                           "cycle",        "replica",
                                           "replicate",    "repeat",
                                           "repetition",   "test",
                                           "id",           "operator",
                                           "day",          "probe",
                                           "mischung",     "rezeptur",
                                           "alter",        "charge",
                                           "messung",      "rampe",
                                           "versuch",      "essai",
                                           "m\u00E9lange", "\u00E9chantillon",
                                           "echantillon",  "muestra",
                                           "mezcla",       "campione",
                                           "pr\u00F3bka"};
  const std::string text = lower(header);
  return std::any_of(std::begin(names), std::end(names), [&](std::string_view name) {
    return text.starts_with(name) &&
           (text.size() == name.size() || std::isalpha(static_cast<unsigned char>(text[name.size()])) == 0);
  });
}

/// "[1/s]", "(cm)": a unit in one of the fields.
bool has_a_unit(const std::vector<std::string>& fields) {
  return std::any_of(fields.begin(), fields.end(), [](const std::string& f) {
    return f.size() > 2 && (f.back() == ']' || f.back() == ')') && f.find_first_of("[(") != f.npos;
  });
}

}  // namespace

bool carries_nothing(std::string_view line) {
  const std::string_view s = trimmed(line);
  return s.empty() || s.front() == '#';
}

/// The columns that the fields name, or that the user gives.
Header Headers::columns_of(std::vector<std::string> fields, std::size_t at, char separator) const {
  Header h{.at = at, .separator = separator, .fields = std::move(fields), .column = {}, .index = {}};
  h.column.resize(quantities.size()), h.index.resize(quantities.size());
  for (std::size_t i = 0; i < h.fields.size(); ++i) {
    auto named = named_column(h.fields[i], quantities);
    for (const GivenColumn& g : given) {
      if (named && named->quantity == g.quantity) named.reset();
      const bool exactly =
          !g.exact.empty() && std::find(h.fields.begin(), h.fields.end(), g.exact) != h.fields.end();
      if (g.number != i + 1 &&
          !(exactly ? h.fields[i] == g.exact : is_given(g, h.fields[i], quantities[g.quantity])))
        continue;
      const std::string unit = !g.unit.empty() ? g.unit : unit_within(h.fields[i], g.quantity);
      named = NamedColumn{g.quantity, 0, unit, false};
      h.plain = false;
      break;
    }
    if (named) take(h, *named, i);
    if (is_of_oscillation(h.fields[i])) h.moduli.push_back(i);
    if (!named && tells_a_group(h.fields[i])) h.groups.push_back(i);
  }
  if ((!sets.empty()) && (h.has(q_shear_stress) || !h.has(q_shear_rate)))
    h.column[q_viscosity].reset();  // it is of use with a shear rate, where there is no stress
  for (const auto& c : h.column) h.named += c.has_value();
  return h;
}

std::string Headers::unit_within(const std::string& field, std::size_t q) const {
  if (const auto named = named_column(field, quantities)) return named->unknown_unit ? "" : named->unit;
  for (const char open : {'[', '('})
    if (const std::size_t at = field.find(open);
        at != field.npos && factor_of(quantities[q], field.substr(at)))
      return field.substr(at);
  return {};
}

void Headers::take(Header& h, const NamedColumn& named, std::size_t i) const {
  auto& column = h.column[named.quantity];
  const std::string_view own = quantities[named.quantity].name;
  if (column && own == "viscosity") return;
  if (column) {
    const bool better = column->unknown_unit > named.unknown_unit ||
                        (column->unknown_unit == named.unknown_unit && named.rank < column->rank);
    if (!better && (named.unknown_unit > column->unknown_unit || named.rank > column->rank)) return;
    if (!better) {
      h.doubled = i, h.doubled_quantity = named.quantity;
      return;
    }
  }
  column = named;
  h.index[named.quantity] = i;
  if (own == "viscosity") return;  // says nothing of a table that does not need it
  h.plain = h.plain && !named.unit.empty() && lower(h.fields[i]).starts_with(own.substr(0, 5));
}

/// A header names two quantities or more; the first separator by which a line does is taken.
std::optional<Header> Headers::header_at(std::size_t at) const {
  std::string_view line = lines[at].text;
  if (trimmed(line).starts_with('#')) line = trimmed(line).substr(1);
  if (line.find_first_not_of("0123456789.,;-+ \t") == line.npos) return std::nullopt;
  const bool wide = line.find("  ") != line.npos;
  for (const char separator : {'\t', ';', ',', '|', wide ? wide_blanks : ' ', ' '}) {
    if (separator != wide_blanks && line.find(separator) == line.npos) continue;
    Header h = columns_of(fields_of(line, separator), at, separator);
    const bool blanks = separator == ' ' || separator == wide_blanks;  // between the words of a sentence too
    if (h.named < 2 || (blanks && !all_have_units(h))) continue;
    if (separator == wide_blanks) h.separator = ' ';
    h.plain = h.plain && !(h.has(0) && h.has(1));
    return h;
  }
  return std::nullopt;
}

bool Headers::all_have_units(const Header& h) const {
  std::size_t with_unit = 0;
  for (const auto& c : h.column) with_unit += c && !c->unit.empty() && !c->unknown_unit;
  return with_unit == h.named || h.named == h.fields.size();
}

bool Headers::has_a_set(const Header& h) const {
  return std::any_of(sets.begin(), sets.end(), [&](const auto& set) {
    return std::all_of(set.begin(), set.end(), [&](std::size_t q) { return h.has(q); });
  });
}

/// Whether one of the five lines below has a number in the field.
bool Headers::has_numbers(const Header& h, std::size_t field) const {
  for (std::size_t i = h.at + 1; i <= h.at + 5 && i < lines.size(); ++i) {
    const auto fields = fields_of(lines[i].text, h.separator);
    if (field < fields.size() && looks_like_a_number(fields[field])) return true;
  }
  return false;
}

/// Whether one of the five lines below has a number in a column of the header.
bool Headers::has_rows(const Header& h) const {
  for (std::size_t q = 0; q < quantities.size(); ++q)
    if (h.has(q) && has_numbers(h, h.index[q])) return true;
  return false;
}

/// The first line that names a set of columns above rows of numbers; else the first that names two quantities.
std::optional<Header> Headers::first_header() const {
  std::optional<Header> first;
  for (const bool comments : {false, true}) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string_view line = trimmed(lines[i].text);
      if (line.empty() || (line.front() == '#') != comments) continue;
      const auto h = header_at(i);
      if (!h) continue;
      if ((sets.empty() || has_a_set(*h)) && has_rows(*h)) return h;
      if (!first) first = h;
    }
    if (first) return first;
  }
  return numbered_header();
}

/// Columns that the user gives by numbers and units need no header.
std::optional<Header> Headers::numbered_header() const {
  std::size_t most = 0;
  for (const GivenColumn& g : given) {
    if (g.number == 0 || g.unit.empty()) return std::nullopt;
    most = std::max(most, g.number);
  }
  for (std::size_t i = 0; most > 0 && i < lines.size(); ++i) {
    if (carries_nothing(lines[i].text)) continue;
    for (const char separator : {'\t', ';', ',', '|', ' '}) {
      const auto fields = fields_of(lines[i].text, separator);
      if (fields.size() < most) continue;
      if (!std::all_of(given.begin(), given.end(),
                       [&](const GivenColumn& g) { return looks_like_a_number(fields[g.number - 1]); }))
        continue;
      Header h = columns_of(std::vector<std::string>(fields.size()), i, separator);
      h.plain = false;
      return h;
    }
  }
  return std::nullopt;
}

/// The first of the sets that the header has; the quantities outside of it are no columns.
void Headers::keep_a_set(Header& h) const {
  for (const auto& set : sets) {
    if (!std::all_of(set.begin(), set.end(), [&](std::size_t q) { return h.has(q); })) continue;
    for (std::size_t q = 0; q < quantities.size(); ++q)
      if (std::find(set.begin(), set.end(), q) == set.end()) h.column[q].reset();
    return;
  }
}

/// Units in one of the three lines below the header; the line behind the last one that has some.
std::size_t Headers::find_units(Header& h) const {
  std::size_t behind = h.at + 1;
  if (h.fields.empty() ||
      std::all_of(h.fields.begin(), h.fields.end(), [](const auto& f) { return f.empty(); }))
    return h.at;  // a table without a header begins with its first row
  for (std::size_t i = h.at + 1; i <= h.at + 3 && i < lines.size(); ++i) {
    const auto fields = fields_of(lines[i].text, h.separator);
    bool units = false;
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      if (!h.has(q) || h.index[q] >= fields.size()) continue;
      const std::string& text = fields[h.index[q]];
      if (looks_like_a_number(text)) return behind;
      if (!factor_of(quantities[q], text)) continue;
      units = true;
      if (h.column[q]->unit.empty()) h.column[q]->unit = text;
    }
    if (units) behind = i + 1;
  }
  return behind;
}

/// "shear_rate=1 [unit]; shear_stress=2 [unit]": what is missing, for the user to fill in.
std::string Headers::columns_without_units(const Header& h) const {
  std::string text;
  for (std::size_t q = 0; q < quantities.size(); ++q)
    if (h.has(q) && !factor_of(quantities[q], h.column[q]->unit))
      text += (text.empty() ? "" : "; ") + std::string(quantities[q].name) + "=" +
              std::to_string(h.index[q] + 1) + " [unit]";
  return text;
}

/// The header of a further table, if the line is one.
std::optional<Header> Headers::next_header(std::size_t at) const {
  auto next = header_at(at);
  if (next && !((sets.empty() || has_a_set(*next)) && has_rows(*next))) next.reset();
  return next;
}

bool Headers::heads_other_columns(const Header& h, const std::vector<std::string>& fields, std::size_t at,
                                  bool behind_a_gap) const {
  const auto texts = static_cast<std::size_t>(
      std::count_if(fields.begin(), fields.end(), [](const std::string& f) { return !f.empty(); }));
  if (sets.empty() || texts < 2 || count_numbers(fields) > 0) return false;
  if (!has_a_unit(fields) && (!behind_a_gap || 2 * texts < h.fields.size())) return false;
  for (std::size_t q = 0; q < quantities.size(); ++q)
    if (h.has(q) && h.index[q] < fields.size() && factor_of(quantities[q], fields[h.index[q]])) return false;
  for (std::size_t i = at + 1; i <= at + 3 && i < lines.size(); ++i) {
    const auto below = fields_of(lines[i].text, h.separator);
    if (count_numbers(below) > 1) return texts > 2 || has_a_unit(fields) || i == at + 1;
    if (has_a_unit(below)) return true;
  }
  return false;
}

}  // namespace tremie::detail
