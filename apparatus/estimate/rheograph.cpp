#include "apparatus/estimate/rheograph.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace tremie::estimate {
namespace {

constexpr double left = 5.0, right = 250.0, low = 10.0, high = 600.0;  ///< Pa s, Pa
constexpr std::array spreads{0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.75};
constexpr std::array times{0.5, 1.0, 2.0, 3.0, 5.0, 10.0, 20.0};
/// Slump flows that the sources of the paper accept for tremie concrete [m].
constexpr double least_accepted = 0.45, most_accepted = 0.65;

const char* const blue = "#0072b2";
const char* const orange = "#d55e00";

/// Where `wanted` lies between two values, on the logarithm of x.
double crossing(double x0, double x1, double y0, double y1, double wanted) {
  return x0 * std::pow(x1 / x0, (wanted - y0) / (y1 - y0));
}

std::string data(const char* name, const Line& line) {
  std::string text = fmt::format("${} << EOD\n", name);
  for (const auto& [mu, tau_0] : line) text += fmt::format("{:.5g} {:.5g}\n", mu, tau_0);
  return text + "EOD\n";
}

/// The point of a line inside of the frame that is nearest to a viscosity, or else to a yield stress.
std::optional<std::pair<double, double>> label_place(const Line& line, std::optional<double> mu,
                                                     double tau_0) {
  std::optional<std::pair<double, double>> best;
  double least = INFINITY;
  for (const auto& [x, y] : line) {
    if (x < 1.03 * left || x > 0.95 * right || y < 1.1 * low || y > 0.93 * high) continue;
    const double off = std::abs(mu ? std::log(x / *mu) : std::log(y / tau_0));
    if (off < least) best = {x, y}, least = off;
  }
  return best;
}

std::string label(const std::string& text, std::pair<double, double> at, const char* colour) {
  return fmt::format("set label '{}' at {:.5g},{:.5g} center front boxed textcolor rgb '{}' font ',11'\n",
                     text, at.first, at.second, colour);
}

/// Both edges of the shaded range, the upper one backwards. Where the lower one ends, no mix of the table is fluid
/// enough to leave the range.
Line accepted_range(const SlumpTable& table) {
  Line edge = spread_contour(table, most_accepted);
  if (edge.empty() || edge.back().first < table.mu.back())
    edge.emplace_back(table.mu.back(), table.tau_0.front());
  const Line upper = spread_contour(table, least_accepted);
  edge.insert(edge.end(), upper.rbegin(), upper.rend());
  return edge;
}

std::string head(const SlumpTable& table, const std::string& file) {
  const bool svg = file.ends_with(".svg");
  std::string text = svg ? "set terminal svg size 980,720 font 'sans,13' background rgb 'white'\n"
                         : "set terminal pdfcairo size 29.7cm,21cm font 'sans,13'\n";
  std::string quoted;
  for (const char c : file) quoted.append(c == '\'' ? 2 : 1, c);
  text += fmt::format("set output '{}'\nset logscale xy\nset xrange [{}:{}]\nset yrange [{}:{}]\n", quoted,
                      left, right, low, high);
  text +=
      "set style textbox opaque noborder fillcolor rgb 'white' margins 0.5,0.3\n"
      "set xlabel 'plastic viscosity μ in Pa·s'\nset ylabel 'yield stress τ_0 in Pa'\n"
      "set xtics (5,10,20,30,50,100,200)\nset ytics (10,20,30,50,100,200,300,500)\n"
      "set grid linecolor rgb '#e6e6e6'\nset key inside top right vertical Left reverse samplen 2 spacing "
      "1.15\n";
  return text + fmt::format(
                    "set title 'Slump flow and t_{{500}} of fresh concrete, {:.0f} kg/m^3: exact Bingham, "
                    "no slip, cone lifted at 15 cm/s'\n",
                    table.density);
}

std::string title_of(bool first, const char* text) {
  return first ? fmt::format("title '{}'", text) : std::string("notitle");
}

void add_contours(const SlumpTable& table, std::string& blocks, std::string& plots) {
  for (std::size_t i = 0; i < spreads.size(); ++i) {
    const Line line = spread_contour(table, spreads[i]);
    const std::string name = fmt::format("s{}", i);
    blocks += data(name.c_str(), line);
    if (const auto at = label_place(line, 170.0, 0.0))
      blocks += label(fmt::format("{:.0f} mm", 1e3 * spreads[i]), *at, blue);
    plots += fmt::format(", ${} using 1:2 with lines linewidth 2 linecolor rgb '{}' {}", name, blue,
                         title_of(i == 0, "slump flow"));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Line line = t500_contour(table, times[i]);
    const std::string name = fmt::format("t{}", i);
    blocks += data(name.c_str(), line);
    if (const auto at = label_place(line, {}, 25.0))
      blocks += label(fmt::format("{:g} s", times[i]), *at, orange);
    plots += fmt::format(", ${} using 1:2 with lines linewidth 2 dashtype 2 linecolor rgb '{}' {}", name,
                         orange, title_of(i == 0, "t_{500}"));
  }
}

void add_mixes(const std::vector<NamedMix>& mixes, std::string& blocks, std::string& plots) {
  if (mixes.empty()) return;
  Line points;
  for (const NamedMix& mix : mixes) {
    points.emplace_back(mix.mu, mix.tau_0);
    blocks += fmt::format("set label '{}' at {:.5g},{:.5g} left front offset 0.9,0.5 font ',13'\n", mix.name,
                          mix.mu, mix.tau_0);
  }
  blocks += data("mixes", points);
  plots +=
      ", $mixes using 1:2 with points pointtype 7 pointsize 1.1 linecolor rgb 'black' title 'Mixes A to C'";
}

void add_estimate(const Estimate& e, std::string& blocks, std::string& plots) {
  if (!e.tau_0 || !e.mu) return;
  blocks += fmt::format("$estimate << EOD\n{:.5g} {:.5g} {:.5g} {:.5g} {:.5g} {:.5g}\nEOD\n", e.mu->value,
                        e.tau_0->value, e.mu->low, e.mu->high, e.tau_0->low, e.tau_0->high);
  plots +=
      ", $estimate using 1:2:3:4:5:6 with xyerrorbars linewidth 2.5 pointtype 5 pointsize 0.8 linecolor rgb "
      "'#009e73' title 'measured, with 95 %'";
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

std::string rheograph_script(const SlumpTable& table, const std::vector<NamedMix>& mixes,
                             const std::optional<Estimate>& estimate, const std::string& file) {
  std::string blocks = data("accepted", accepted_range(table));
  std::string plots =
      "plot $accepted using 1:2 with filledcurves closed fillcolor rgb '#dceaf4' title '450 to 650 mm: "
      "accepted for "
      "tremie concrete'";
  add_contours(table, blocks, plots);
  add_mixes(mixes, blocks, plots);
  if (estimate) add_estimate(*estimate, blocks, plots);
  return head(table, file) + blocks + plots + "\n";
}

}  // namespace tremie::estimate
