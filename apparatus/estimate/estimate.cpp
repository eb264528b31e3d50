#include "apparatus/estimate/estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/estimate/closed_forms.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::estimate {
namespace {

constexpr std::size_t side = 240;     ///< quadrature points in each direction
constexpr double edge_weight = 0.05;  ///< of the outermost hundredth of the table: the answer lies beyond it
constexpr double far_off = 3.0;       ///< standard errors of the best fit: the table has no such mix
constexpr double least_density = 1800.0, most_density = 3000.0;  ///< what the table's scaling was tried for

struct Axis {
  double low, high;
  double at(double share) const { return low * std::pow(high / low, share); }
};

struct Grid {
  Axis tau_0, mu;
};

/// Of a viscosity that is known the axis has one value.
Grid grid_of(const SlumpTable& table, const Measured& m) {
  const double scale = m.density / table.density;
  const Axis mu{scale * table.mu.front(), scale * table.mu.back()};
  return {{scale * table.tau_0.front(), scale * table.tau_0.back()}, m.mu ? Axis{*m.mu, *m.mu} : mu};
}

/// Minus twice the logarithm of the likelihood, its constant left out.
double misfit(const SlumpTable& table, const Measured& m, double tau_0, double mu) {
  const TableReading reading = interpolate(table, tau_0, mu, m.density);
  double sum = 0.0;
  if (m.spread)
    sum += std::pow(
        (*m.spread - reading.spread) / std::hypot(m.spread_error, table_spread_error * reading.spread), 2);
  if (m.slump)
    sum += std::pow(
        (*m.slump - reading.slump) / std::hypot(m.slump_error, table_slump_error * table.mould.height), 2);
  if (!m.t500) return sum;
  if (!reading.t500) return INFINITY;
  const double t500_error = std::hypot(m.t500_error, table_t500_error * *reading.t500);
  return sum + std::pow((*m.t500 - *reading.t500) / t500_error, 2) +
         2.0 * std::log(t500_error / m.t500_error);
}

/// Weights over shares of one axis.
double quantile(const std::vector<double>& weights, double q) {
  double sum = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    if (sum + weights[i] >= q)
      return (static_cast<double>(i) + (q - sum) / weights[i]) / static_cast<double>(weights.size());
    sum += weights[i];
  }
  return 1.0;
}

struct Marginals {
  std::vector<double> tau_0 = std::vector<double>(side, 0.0), mu = std::vector<double>(side, 0.0);
  double least = INFINITY;                 ///< misfit of the best point
  double best_tau_0 = 0.0, best_mu = 0.0;  ///< shares
};

Marginals marginals_of(const SlumpTable& table, const Measured& m, const Grid& grid) {
  Marginals out;
  std::vector<double> misfits(side * side);
  const auto share = [](std::size_t i) { return (static_cast<double>(i) + 0.5) / side; };
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      const double f = misfit(table, m, grid.tau_0.at(share(i)), grid.mu.at(share(j)));
      misfits[i * side + j] = f;
      if (f < out.least) {
        out.least = f;
        out.best_tau_0 = share(i);
        out.best_mu = share(j);
      }
    }
  if (!std::isfinite(out.least)) return out;
  double sum = 0.0;
  for (std::size_t i = 0; i < side; ++i)
    for (std::size_t j = 0; j < side; ++j) {
      const double w = std::exp(-0.5 * (misfits[i * side + j] - out.least));
      out.tau_0[i] += w;
      out.mu[j] += w;
      sum += w;
    }
  for (double& w : out.tau_0) w /= sum;
  for (double& w : out.mu) w /= sum;
  return out;
}

/// Ever finer grids about the best point.
void refine(const SlumpTable& table, const Measured& m, const Grid& grid, Marginals& at) {
  for (double step = 0.5 / side; step > 1e-6; step *= 0.5)
    for (int i = -2; i <= 2; ++i)
      for (int j = -2; j <= 2; ++j) {
        const double x = std::clamp(at.best_tau_0 + i * step, 0.0, 1.0);
        const double y = std::clamp(at.best_mu + j * step, 0.0, 1.0);
        const double f = misfit(table, m, grid.tau_0.at(x), grid.mu.at(y));
        if (f < at.least) {
          at.least = f;
          at.best_tau_0 = x;
          at.best_mu = y;
        }
      }
}

Interval interval_of(const std::vector<double>& weights, const Axis& axis, std::optional<double> best) {
  const double value = axis.at(best ? *best : quantile(weights, 0.5));
  // A best point at the table's edge may lie beyond the quantiles.
  return {value, std::min(value, axis.at(quantile(weights, 0.025))),
          std::max(value, axis.at(quantile(weights, 0.975)))};
}

/// `best`: share of the best point.
bool beyond(const std::vector<double>& weights, double best) {
  if (best < 1e-3 || best > 1.0 - 1e-3) return true;
  const std::size_t outermost = std::max<std::size_t>(1, side / 100);
  double low = 0.0, high = 0.0;
  for (std::size_t i = 0; i < outermost; ++i) {
    low += weights[i];
    high += weights[side - 1 - i];
  }
  return std::max(low, high) > edge_weight;
}

/// Whether yield stresses that the spread allows lie where the table has no t500: next to its entries that do not reach
/// 500 mm. The interval would end there, whatever the concrete.
bool cut_off(const SlumpTable& table, const Measured& m, const Grid& grid, const Marginals& at) {
  if (!m.spread) return false;
  const double mu = grid.mu.at(at.best_mu),
               error = std::hypot(m.spread_error, table_spread_error * *m.spread);
  for (std::size_t i = 0; i < side; ++i) {
    const double tau_0 = grid.tau_0.at((static_cast<double>(i) + 0.5) / side);
    const TableReading reading = interpolate(table, tau_0, mu, m.density);
    if (!reading.t500 && std::abs(reading.spread - *m.spread) < error) return true;
  }
  return false;
}

/// "this spread and this t500"
std::string words_of(const Measured& m) {
  std::string words;
  for (const auto& [given, name] : {std::pair{m.spread, "spread"}, {m.slump, "slump"}, {m.t500, "t500"}})
    if (given) words += (words.empty() ? "this " : " and this ") + std::string(name);
  return words;
}

/// "a spread of 980 mm lies outside of the table, 210 to 930 mm", or nothing.
std::string outside(const char* name, const std::optional<double>& measured,
                    const std::vector<double>& values) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  if (!measured || (*measured >= *low && *measured <= *high)) return {};
  return fmt::format("a {} of {:.0f} mm lies outside of the table, {:.0f} to {:.0f} mm", name,
                     1e3 * *measured, 1e3 * std::max(0.0, *low), 1e3 * *high);
}

std::string outside(const SlumpTable& table, const Measured& m) {
  const std::string spread = outside("spread", m.spread, table.spread);
  return spread.empty() ? outside("slump", m.slump, table.slump) : spread;
}

std::string told(double value) { return scene::rounded(value, 3); }

void check(const SlumpTable& table, const Measured& m, const Grid& grid, const Marginals& at,
           MixEstimate& e) {
  if (const std::string reason = outside(table, m); !reason.empty())
    e.reasons.push_back(reason);
  else if (at.least > far_off * far_off)
    e.reasons.push_back(
        fmt::format("no mix of the table, {} to {} Pa and {} to {} Pa.s, has {}: the nearest is {:.1f} "
                    "standard errors off",
                    told(grid.tau_0.low), told(grid.tau_0.high), told(grid.mu.low), told(grid.mu.high),
                    words_of(m), std::sqrt(at.least)));
  else if (beyond(at.tau_0, at.best_tau_0))
    e.reasons.push_back(fmt::format("the yield stress may lie outside of the table, {} to {} Pa",
                                    told(grid.tau_0.low), told(grid.tau_0.high)));
  else if (m.t500 && !m.mu && beyond(at.mu, at.best_mu))
    e.reasons.push_back(fmt::format("the viscosity may lie outside of the table, {} to {} Pa.s",
                                    told(grid.mu.low), told(grid.mu.high)));
  if (const Axis mu = grid_of(table, {.density = m.density}).mu; m.mu && (*m.mu < mu.low || *m.mu > mu.high))
    e.reasons.push_back(fmt::format("a viscosity of {} Pa.s lies outside of the table, {} to {} Pa.s",
                                    told(*m.mu), told(mu.low), told(mu.high)));
  if (m.density < least_density || m.density > most_density)
    e.reasons.push_back(
        fmt::format("a density of {:.0f} kg/m3 lies outside of what the table serves, {:.0f} to {:.0f} kg/m3",
                    m.density, least_density, most_density));
}

}  // namespace

/// Where t500 is of no use the spread alone tells, and it is said.
static MixEstimate without_t500(const SlumpTable& table, Measured m) {
  m.t500.reset();
  MixEstimate e = estimate(table, m);
  e.reasons.push_back(fmt::format(
      "t500 of a spread of {:.0f} mm depends on its last millimetres, and the table ends there: it "
      "was left out",
      1e3 * *m.spread));
  return e;
}

MixEstimate estimate(const SlumpTable& table, const Measured& m) {
  MixEstimate e;
  if (m.spread) {
    e.tau_0_thin_layer = thin_layer_yield_stress(*m.spread, m.density, table.mould.volume);
    e.tau_0_plug = plug_yield_stress(*m.spread, m.density, table.mould.volume);
  }
  const Grid grid = grid_of(table, m);
  Marginals at = marginals_of(table, m, grid);
  const bool one_mix = m.t500 || m.mu;
  if (one_mix && std::isfinite(at.least)) refine(table, m, grid, at);
  if (m.t500 && at.least < far_off * far_off && cut_off(table, m, grid, at)) return without_t500(table, m);
  check(table, m, grid, at, e);
  if (!outside(table, m).empty()) return e;
  if (!std::isfinite(at.least)) {
    e.reasons.push_back("no mix of the table reaches 500 mm and has this spread");
    return e;
  }
  e.tau_0 = interval_of(at.tau_0, grid.tau_0, one_mix ? std::optional(at.best_tau_0) : std::nullopt);
  if (m.mu)
    e.mu = Interval{*m.mu, *m.mu, *m.mu};
  else if (m.t500)
    e.mu = interval_of(at.mu, grid.mu, at.best_mu);
  return e;
}

void check_readings(const Measured& m, const Mould& mould) {
  if (!m.spread && !m.slump)
    throw scene::InputError("spread: is missing, and so is slump; one of them is needed");
  if (m.spread && *m.spread <= mould.foot)
    throw scene::InputError(
        fmt::format("spread: must be more than the cone's {:.0f} mm at its bottom", 1e3 * mould.foot));
  if (m.slump && *m.slump >= mould.height)
    throw scene::InputError(
        fmt::format("slump: must be less than the cone's height, {:.0f} mm", 1e3 * mould.height));
  if (m.t500 && mould.name != Mould{}.name)
    throw scene::InputError("t500: is read with the Abrams cone alone");
  constexpr double reached = 0.5, errors = 3.0;
  if (m.t500 && m.spread && *m.spread + errors * m.spread_error < reached)
    throw scene::InputError(
        fmt::format("t500: concrete that stops at {:.0f} mm never reaches 500 mm", 1e3 * *m.spread));
}

}  // namespace tremie::estimate
