#include "rheometer/fits/vane_ends.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace tremie {

namespace {

using Row = std::map<double, double>;  // container_over_radius -> factor

/// height_over_radius -> row.
std::map<double, Row> table_of(const std::string& csv, const std::string& name) {
  std::istringstream in(csv);
  std::string line;
  std::map<double, Row> table;
  for (int number = 1; std::getline(in, line); ++number) {
    if (line.empty() || line.front() == '#' || line.starts_with("height_over_radius")) continue;
    double h = 0.0, c = 0.0, f = 0.0;
    char first = 0, second = 0;
    std::istringstream fields(line);
    if (!(fields >> h >> first >> c >> second >> f) || first != ',' || second != ',' || !(f >= 1.0))
      throw std::invalid_argument(name + ":" + std::to_string(number) +
                                  ": expected height_over_radius,container_over_radius,end_factor");
    table[h][c] = f;
  }
  return table;
}

/// Linear between the neighbours of x; empty outside.
template <class Map, class Value>
std::optional<double> between(const Map& map, double x, Value value) {
  auto above = map.lower_bound(x);
  if (above == map.end()) return std::nullopt;
  if (above->first == x) return value(above->second);
  if (above == map.begin()) return std::nullopt;
  const auto below = std::prev(above);
  const std::optional<double> a = value(below->second), b = value(above->second);
  if (!a || !b) return std::nullopt;
  const double share = (x - below->first) / (above->first - below->first);
  return *a + share * (*b - *a);
}

}  // namespace

double textbook_end_factor(const Instrument& in) {
  return 1.0 + 2.0 * in.vane_radius / (3.0 * in.vane_height);
}

double end_factor_from_table(const std::string& csv, const std::string& name, const Instrument& in) {
  const auto table = table_of(csv, name);
  const double h = in.vane_height / in.vane_radius, c = in.container_radius / in.vane_radius;
  const auto factor = between(
      table, h, [&](const Row& row) { return between(row, c, [](double f) { return std::optional(f); }); });
  if (factor) return *factor;
  const std::string range = table.empty() ? "it is empty"
                                          : "it holds heights from " + std::to_string(table.begin()->first) +
                                                " to " + std::to_string(table.rbegin()->first) + " radii";
  throw std::invalid_argument(name + ": no end factor for a vane of " + std::to_string(h) +
                              " radii in a container of " + std::to_string(c) + " radii; " + range);
}

}  // namespace tremie
