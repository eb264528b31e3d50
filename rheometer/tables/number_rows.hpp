#pragma once

// Tables of reference data: numbers between commas under a header, after lines that begin with #.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "rheometer/tables/number_text.hpp"

namespace tremie {

/// The rows under `header`, which names their fields; an empty field is not-a-number. Throws std::invalid_argument, with
/// name and line, where a row has other fields or is not `valid`.
inline std::vector<std::vector<double>> number_rows(
    const std::string& csv, const std::string& name, std::string_view header,
    const std::function<bool(const std::vector<double>&)>& valid) {
  const std::string_view first = header.substr(0, header.find(','));
  const auto commas = std::count(header.begin(), header.end(), ',');
  std::vector<std::vector<double>> rows;
  std::istringstream in(csv);
  std::string line, field;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#' || line.starts_with(first)) continue;
    bool read = std::count(line.begin(), line.end(), ',') == commas;
    std::vector<double> row;
    for (std::istringstream fields(line + ","); std::getline(fields, field, ',');) {
      row.push_back(parse_number(field).value_or(std::numeric_limits<double>::quiet_NaN()));
      read = read && (field.empty() || !std::isnan(row.back()));
    }
    if (!read || !valid(row))
      throw std::invalid_argument(name + ":" + std::to_string(number) + ": expected " + std::string(header));
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace tremie
