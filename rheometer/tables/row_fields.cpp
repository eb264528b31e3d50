#include "rheometer/tables/row_fields.hpp"

#include <algorithm>
#include <iterator>

#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/number_column.hpp"

namespace tremie::detail {

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
  static const std::string_view known[] = {"",     "-",   "--",   "---", "n/a",
                                           "#n/a", "nan", "n.a.", "*",   "invalid"};
  const std::string text = lower(field);
  return std::find(std::begin(known), std::end(known), text) != std::end(known);
}

bool measures_a_modulus(const std::vector<std::string>& fields, const std::vector<std::size_t>& moduli) {
  return std::any_of(moduli.begin(), moduli.end(), [&](std::size_t i) {
    return i < fields.size() && looks_like_a_number(fields[i]) &&
           fields[i].find_first_of("123456789") != std::string::npos;
  });
}

}  // namespace tremie::detail
