#include "apparatus/estimate/rheograph.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/page/charts.hpp"

namespace tremie::estimate {
namespace {

constexpr std::array spreads{0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.75};
constexpr std::array times{0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0};
/// Slump flows that the sources of the paper accept for tremie concrete [m].
constexpr double least_accepted = 0.45, most_accepted = 0.65;

enum Colour { blue, orange, green, purple };  // of the charts' palette

/// Where `wanted` lies between two values, on the logarithm of x.
double crossing(double x0, double x1, double y0, double y1, double wanted) {
  return x0 * std::pow(x1 / x0, (wanted - y0) / (y1 - y0));
}

/// The point of a line that is nearest to a viscosity, or else to a yield stress.
std::pair<double, double> label_place(const Line& line, std::optional<double> mu, double tau_0) {
  const auto off = [&](const auto& p) {
    return std::abs(mu ? std::log(p.first / *mu) : std::log(p.second / tau_0));
  };
  return *std::min_element(line.begin(), line.end(),
                           [&](const auto& a, const auto& b) { return off(a) < off(b); });
}

/// Where a contour lies over a viscosity; the table's lowest yield stress where it has ended: no mix of the table is fluid
/// enough to leave the range.
double height_at(const Line& line, double mu, const SlumpTable& table) {
  const auto found = std::find_if(line.begin(), line.end(), [&](const auto& p) { return p.first == mu; });
  return found == line.end() ? table.tau_0.front() : found->second;
}

report::Band accepted_range(const SlumpTable& table) {
  const Line low = spread_contour(table, most_accepted), high = spread_contour(table, least_accepted);
  report::Band band{"450 to 650 mm: accepted for tremie concrete", table.mu, {}, {}};
  for (const double mu : table.mu) {
    band.low.push_back(height_at(low, mu, table));
    band.high.push_back(height_at(high, mu, table));
  }
  return band;
}

/// `words` stands at `at`; `label` is in the legend.
void add_contour(const Line& line, const std::string& words, std::pair<double, double> at, const char* label,
                 Colour colour, report::LineChart& chart) {
  report::Curve curve{
      .label = label, .mark = colour == blue ? report::Mark::line : report::Mark::dashed, .colour = colour};
  for (const auto& [mu, tau_0] : line) curve.x.push_back(mu), curve.y.push_back(tau_0);
  chart.curves.push_back(std::move(curve));
  chart.notes.push_back({words, at.first, at.second, colour});
}

void add_contours(const SlumpTable& table, report::LineChart& chart) {
  for (const double spread : spreads)
    if (const Line line = spread_contour(table, spread); !line.empty())
      add_contour(line, fmt::format("{:.0f} mm", 1e3 * spread), label_place(line, 150.0, 0.0),
                  spread == spreads.front() ? "slump flow" : "", blue, chart);
  for (const double t500 : times)
    if (const Line line = t500_contour(table, t500); !line.empty())
      add_contour(line, fmt::format("{:g} s", t500), label_place(line, {}, 20.0),
                  t500 == times.front() ? "t500" : "", orange, chart);
}

void add_mixes(const std::vector<NamedMix>& mixes, report::LineChart& chart) {
  report::Curve points{.label = "published mixes", .mark = report::Mark::points, .colour = green};
  for (const NamedMix& mix : mixes) {
    points.x.push_back(mix.mu), points.y.push_back(mix.tau_0);
    chart.notes.push_back({mix.name, mix.mu, 1.15 * mix.tau_0, green});
  }
  if (!mixes.empty()) chart.curves.push_back(std::move(points));
}

/// A point with the interval of either parameter.
void add_estimate(const MixEstimate& e, report::LineChart& chart) {
  if (!e.tau_0 || !e.mu) return;
  chart.curves.push_back({"measured, with 95 %",
                          {e.mu->value},
                          {e.tau_0->value},
                          report::Mark::points,
                          {e.tau_0->low},
                          {e.tau_0->high},
                          purple});
  chart.curves.push_back(
      {.label = "", .x = {e.mu->low, e.mu->high}, .y = {e.tau_0->value, e.tau_0->value}, .colour = purple});
}

}  // namespace

Line spread_contour(const SlumpTable& table, double spread) {
  Line line;
  const std::size_t n = table.mu.size();
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i + 1 < table.tau_0.size(); ++i) {
      const double here = table.spread[i * n + j], next = table.spread[(i + 1) * n + j];
      if (here < spread || next >= spread) continue;  // spreads fall as the yield stress grows
      line.emplace_back(table.mu[j], crossing(table.tau_0[i], table.tau_0[i + 1], here, next, spread));
      break;
    }
  return line;
}

Line t500_contour(const SlumpTable& table, double t500) {
  Line line;
  const std::size_t n = table.mu.size();
  for (std::size_t i = 0; i < table.tau_0.size(); ++i)
    for (std::size_t j = 0; j + 1 < n; ++j) {
      const double here = table.t500[i * n + j], next = table.t500[i * n + j + 1];
      if (!(here < t500 && next >= t500)) continue;  // not-a-number: 500 mm are not reached
      line.emplace_back(
          crossing(table.mu[j], table.mu[j + 1], std::log(here), std::log(next), std::log(t500)),
          table.tau_0[i]);
      break;
    }
  return line;
}

std::string rheograph_svg(const SlumpTable& table, const std::vector<NamedMix>& mixes,
                          const std::optional<MixEstimate>& estimate) {
  report::LineChart chart{.title = fmt::format("Slump flow and t500 of fresh concrete, {:.0f} kg/m³: exact "
                                               "Bingham, no slip, cone lifted at 15 cm/s",
                                               table.density),
                          .x_label = "plastic viscosity μ (Pa·s)",
                          .y_label = "yield stress τ₀ (Pa)",
                          .bands = {accepted_range(table)},
                          .log_x = true,
                          .log_y = true,
                          .width = 720,
                          .height = 560};
  add_contours(table, chart);
  add_mixes(mixes, chart);
  if (estimate) add_estimate(*estimate, chart);
  return report::svg_file({chart});
}

}  // namespace tremie::estimate
