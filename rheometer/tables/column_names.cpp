#include "rheometer/tables/column_names.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/number_text.hpp"

namespace tremie::detail {

namespace {

/// What separates a name from its unit: "speed, rpm", "torque / Nm", "Tau in Pa", "time_s".
std::string_view without_link(std::string_view rest) {
  rest = trimmed(rest);
  for (const std::string_view link : {"in ", "en ", ",", "/", ":", "-"})
    if (rest.starts_with(link) && !rest.starts_with("/s") && !rest.starts_with("/min"))
      return trimmed(rest.substr(link.size()));
  return rest;
}

/// The contents of the last pair of brackets, where the text ends with it.
std::string_view last_bracket(std::string_view text) {
  text = trimmed(text);
  if (text.empty() || (text.back() != ')' && text.back() != ']')) return {};
  const std::size_t open = text.find_last_of(text.back() == ')' ? '(' : '[');
  return open == text.npos ? std::string_view{} : text.substr(open + 1, text.size() - open - 2);
}

bool goes_on(std::string_view rest) {
  return !rest.empty() &&
         (std::isalnum(static_cast<unsigned char>(rest.front())) || (rest.front() & 0x80) != 0);
}

/// A name may carry the unit that it implies behind '=': "rpm=rpm".
struct Name {
  std::string_view text, unit;
};

Name name_and_unit(std::string_view row) {
  const std::size_t equals = row.find('=');
  if (equals == row.npos) return {row, {}};
  return {row.substr(0, equals), row.substr(equals + 1)};
}

/// Blanks as single ones, underscores as blanks, the wide brackets of Chinese and Japanese as ours.
std::string spaced(std::string_view text) {
  std::string s;
  for (text = trimmed(text); !text.empty(); text.remove_prefix(1)) {
    const bool opens = text.starts_with("\uFF08"), closes = text.starts_with("\uFF09");
    if (opens || closes) text.remove_prefix(2);
    const char c = opens ? '(' : closes ? ')' : text.front();
    const bool blank = c == '_' || c == ' ' || c == '\n' || c == '\r' || c == '\t';
    if (!blank || (!s.empty() && s.back() != ' ')) s += blank ? ' ' : c;
  }
  return s;
}

/// The header as this name with a unit, without one, or with one that is unknown.
std::optional<NamedColumn> by_name(std::string_view header, std::string_view folded, const Name& name,
                                   const ColumnQuantity& quantity) {
  if (!folded.starts_with(name.text) || goes_on(folded.substr(name.text.size()))) return std::nullopt;
  const bool letter = name.text.size() <= 2 || (name.text.size() <= 4 && (name.text.front() & 0x80) != 0);
  const std::string_view rest = trimmed(header.substr(name.text.size()));
  NamedColumn column;
  column.unit = rest.empty() ? std::string(name.unit) : std::string(without_link(rest));
  if (column.unit.empty()) return letter ? std::nullopt : std::optional(column);
  if (factor_of(quantity, column.unit)) return column;
  if (const std::string_view last = last_bracket(rest); factor_of(quantity, last) && !letter) {
    column.unit = last;
    return column;
  }
  const bool bracketed = rest.front() == '(' || rest.front() == '[';
  column.unknown_unit = true;
  return letter || !bracketed ? std::nullopt : std::optional(column);
}

}  // namespace

std::string normal_unit(std::string_view text) {
  static const std::pair<std::string_view, std::string_view> spellings[] = {
      {"\u00B7", ""},  {"\u22C5", ""},    {"\u2022", ""},  {"\u2219", ""},  {"\u00D7", ""},
      {"\u00B5", "u"}, {"\u03BC", "u"},   {"per", "/"},    {"PER", "/"},    {"\u207B", "-"},
      {"\u2212", "-"}, {"\u2013", "-"},   {"\u00B9", "1"}, {"\u00B2", "2"}, {"\u00B0", "deg"},
      {"\u00A0", ""},  {"MPa", "megapa"}, {"MN", "megan"}};
  std::string s;
  while (!text.empty()) {
    const auto match = std::find_if(std::begin(spellings), std::end(spellings),
                                    [&](const auto& spelling) { return text.starts_with(spelling.first); });
    if (match != std::end(spellings)) {
      s += match->second;
      text.remove_prefix(match->first.size());
      continue;
    }
    if (std::string_view(" _()[].*^'\t\r\n").find(text.front()) == std::string_view::npos)
      s += static_cast<char>(std::tolower(static_cast<unsigned char>(text.front())));
    text.remove_prefix(1);
  }
  for (std::size_t i = s.size(); i-- > 0;)  // "N-m" as "nm", "s-1" as it is
    if (s[i] == '-' && (i + 1 == s.size() || !std::isdigit(static_cast<unsigned char>(s[i + 1]))))
      s.erase(i, 1);
  return s;
}

std::optional<double> factor_of(const ColumnQuantity& quantity, std::string_view unit) {
  const std::string normal = normal_unit(unit);
  for (const auto& [known, factor] : quantity.units)
    if (normal == known && !normal.empty()) return factor;
  return std::nullopt;
}

std::optional<NamedColumn> named_column(std::string_view header,
                                        const std::vector<ColumnQuantity>& quantities) {
  const std::string text = spaced(header), folded = lower(text);
  const bool underscored = header.find('_') != header.npos;
  std::optional<NamedColumn> found;
  std::size_t longest = 0;
  for (std::size_t q = 0; q < quantities.size(); ++q)
    for (std::size_t i = 0; i <= quantities[q].names.size(); ++i) {
      const std::string own = spaced(quantities[q].name);
      const Name name = i == 0 ? Name{own, {}} : name_and_unit(quantities[q].names[i - 1]);
      if (name.text.size() < longest) continue;
      auto column = by_name(text, folded, name, quantities[q]);
      if (!column && underscored && folded.starts_with(own + ' ') && i == 0)
        column = NamedColumn{0, 0, text.substr(own.size() + 1), true};
      if (!column || (found && name.text.size() == longest && found->unknown_unit <= column->unknown_unit))
        continue;
      column->quantity = q, column->rank = i;
      found = column;
      longest = name.text.size();
    }
  return found;
}

bool is_of_oscillation(std::string_view header) {
  static const std::string_view names[] = {"storage modulus",
                                           "loss modulus",
                                           "shear modulus (elastic",
                                           "shear modulus (viscous",
                                           "speichermodul",
                                           "verlustmodul",
                                           "module de conservation",
                                           "module de perte",
                                           "module de stockage",
                                           "módulo de almacenamiento",
                                           "módulo de pérdida",
                                           "g'",
                                           "g\"",
                                           "g\u2032",
                                           "g\u2033"};
  const std::string text = lower(spaced(header));
  return std::any_of(std::begin(names), std::end(names),
                     [&](std::string_view name) { return text.starts_with(name); });
}

std::vector<GivenColumn> given_columns(const std::string& text,
                                       const std::vector<ColumnQuantity>& quantities) {
  std::vector<GivenColumn> given;
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find_first_of(";\n", start), text.size());
    const std::string_view one = trimmed(std::string_view(text).substr(start, end - start));
    start = end + 1;
    if (one.empty()) continue;
    const std::size_t equals = one.find('=');
    const std::string quantity = lower(trimmed(one.substr(0, std::min(equals, one.size()))));
    std::string names;
    GivenColumn g{quantities.size(), 0, {}, {}, {}};
    for (std::size_t q = 0; q < quantities.size(); ++q) {
      names += (names.empty() ? "" : ", ") + std::string(quantities[q].name);
      if (spaced(quantities[q].name) == spaced(quantity)) g.quantity = q;
    }
    std::string_view what = equals == one.npos ? std::string_view{} : trimmed(one.substr(equals + 1));
    if (g.quantity == quantities.size() || what.empty())
      throw std::invalid_argument("\"" + std::string(one) +
                                  "\": write QUANTITY=COLUMN, as \"torque=3\" or \"torque=Moment [mN m]\"; "
                                  "quantities are " +
                                  names);
    const std::string_view unit = last_bracket(what);
    const std::string_view before =
        unit.empty() ? what : trimmed(what.substr(0, what.size() - unit.size() - 2));
    const std::optional<double> number = parse_number(before);
    if (number &&
        !(*number >= 1.0 && *number <= 1000.0 && *number == static_cast<double>(static_cast<int>(*number))))
      throw std::invalid_argument("\"" + std::string(one) + "\": columns are counted from 1");
    if (number) g.number = static_cast<std::size_t>(*number);
    g.exact = std::string(number ? std::string_view{} : unit.empty() ? what : before);
    g.name = lower(g.exact);
    g.unit = std::string(unit);
    if (!unit.empty() && !factor_of(quantities[g.quantity], unit))
      throw std::invalid_argument("\"" + std::string(one) + "\": unknown unit '" + std::string(unit) +
                                  "'; allowed: " + std::string(quantities[g.quantity].allowed));
    given.push_back(g);
  }
  return given;
}

bool is_given(const GivenColumn& g, std::string_view header, const ColumnQuantity& quantity) {
  if (g.number != 0) return false;
  const std::string folded = lower(spaced(header)), name = spaced(g.name);
  if (folded == name) return true;
  if (folded.starts_with(name) && !goes_on(std::string_view(folded).substr(name.size()))) return true;
  const std::string_view unit = last_bracket(header);
  return !unit.empty() && factor_of(quantity, g.name) && normal_unit(unit) == normal_unit(g.name);
}

}  // namespace tremie::detail
