#include "rheometer/vane/vane_ends.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "rheometer/tables/number_rows.hpp"
#include "rheometer/vane/table.hpp"

namespace tremie {

using detail::between, detail::rounded;

namespace {

using Curve = std::map<double, double>;  // ln(1 + Bingham number) -> factor
using Row = std::map<double, Curve>;     // container_over_radius -> curve

/// Radius over height -> row: the ends' share of the torque is in proportion to it.
std::map<double, Row> table_of(const std::string& csv, const std::string& name) {
  std::map<double, Row> table;
  for (const auto& row :
       number_rows(csv, name, "height_over_radius,container_over_radius,bingham_number,end_factor",
                   [](const auto& r) { return r[0] > 0.0 && r[2] >= 0.0 && r[3] >= 1.0; }))
    table[rounded(1.0 / row[0])][rounded(row[1])][std::log1p(row[2])] = row[3];
  return table;
}

}  // namespace

double textbook_end_factor(const Instrument& in) {
  return 1.0 + 2.0 * in.vane_radius / (3.0 * in.vane_height);
}

double largest_bingham_number(const std::string& csv, const std::string& name) {
  const auto table = table_of(csv, name);
  return table.empty() ? 0.0 : std::expm1(table.begin()->second.begin()->second.rbegin()->first);
}

double end_factor_from_table(const std::string& csv, const std::string& name, const Instrument& in,
                             double bingham_number) {
  const auto table = table_of(csv, name);
  if (table.empty()) throw std::invalid_argument(name + ": holds no row");
  const double h = in.vane_height / in.vane_radius, c = rounded(in.container_radius / in.vane_radius);
  const auto at_bingham = [&](const Curve& curve) {
    const double at = std::min(std::log1p(std::max(0.0, bingham_number)), curve.rbegin()->first);
    return between(curve, at, [](double f) { return std::optional(f); });
  };
  const auto factor =
      between(table, rounded(1.0 / h), [&](const Row& row) { return between(row, c, at_bingham); });
  if (factor) return *factor;
  const Row& row = table.begin()->second;
  std::ostringstream what;
  what << name << ": no end factor for a vane of " << h << " radii in a container of " << c
       << " radii; it holds heights from " << 1.0 / table.rbegin()->first << " to "
       << 1.0 / table.begin()->first << " radii, containers from " << row.begin()->first << " to "
       << row.rbegin()->first << " radii";
  throw std::invalid_argument(what.str());
}

}  // namespace tremie
