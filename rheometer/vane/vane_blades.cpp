#include "rheometer/vane/vane_blades.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/tables/number_rows.hpp"
#include "rheometer/vane/table.hpp"

namespace tremie {

BladeTable blade_table(const std::string& csv, const std::string& name) {
  BladeTable table;
  for (const auto& row : number_rows(csv, name, "container_over_radius,bingham_number,blade_factor",
                                     [](const auto& r) { return r[0] > 1.0 && r[1] >= 0.0 && r[2] > 0.0; }))
    table[detail::rounded(row[0])][std::log1p(row[1])] = row[2];
  if (table.empty()) throw std::invalid_argument(name + ": holds no row");
  return table;
}

double blade_factor(const BladeTable& table, const Instrument& in, double bingham_number) {
  const double container = detail::rounded(in.container_radius / in.vane_radius);
  const auto factor = detail::between(table, container, [&](const std::map<double, double>& curve) {
    const double x = std::clamp(std::log1p(bingham_number), curve.begin()->first, curve.rbegin()->first);
    return detail::between(curve, x, [](double f) { return std::optional(f); });
  });
  if (factor) return *factor;
  std::ostringstream what;
  what << "no factor of the blades for a container of " << container << " vane radii; the table holds "
       << table.begin()->first << " to " << table.rbegin()->first;
  throw std::invalid_argument(what.str());
}

double largest_bingham_number(const BladeTable& table, const Instrument& in) {
  const double container = detail::rounded(in.container_radius / in.vane_radius);
  const auto last = [](const auto& entry) { return std::expm1(entry.second.rbegin()->first); };
  const auto above = table.lower_bound(container);
  if (above == table.end()) return last(*table.rbegin());
  return above == table.begin() ? last(*above) : std::min(last(*above), last(*std::prev(above)));
}

double torque_of_cylinder(const BladeTable& table, const Instrument& in, double mu, double omega,
                          double torque) {
  const auto cylinder = [&](double bingham) {
    return reiner_riwlin({.tau_0 = bingham * mu * omega, .mu = mu}, omega, in).torque;
  };
  const auto too_much = [&](double bingham) {
    return cylinder(bingham) * blade_factor(table, in, bingham) > torque;
  };
  double low = 0.0, high = 1.0;
  if (too_much(low)) return torque / blade_factor(table, in, 0.0);
  while (!too_much(high) && high < 1e9) low = high, high *= 4.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (too_much(middle) ? high : low) = middle;
  }
  return torque / blade_factor(table, in, low);
}

}  // namespace tremie
