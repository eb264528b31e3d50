#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"

namespace tremie::report {
namespace {

constexpr double width = 480, left = 14, right = 60, bar = 13, group_gap = 12;
constexpr const char* colours[] = {"#0067a5", "#c25400", "#00785a", "#9a4f8a"};

std::string text_at(double x, double y, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\"{}>{}</text>", x, y, more, escaped(text));
}

std::string one_bar(double value, double error, std::size_t colour, double y) {
  const double scale = width - left - right;
  const auto x = [&](double v) { return left + scale * std::clamp(v, 0.0, 1.0); };
  std::string text = fmt::format(
      "<rect class=\"f{0}\" fill=\"{1}\" x=\"{2:.1f}\" y=\"{3:.1f}\" width=\"{4:.1f}\" height=\"{5:.1f}\"/>",
      colour, colours[colour], left, y, x(value) - left, bar - 2);
  if (error > 0.0)
    text += fmt::format(
        "<path class=\"level\" fill=\"none\" stroke=\"#1c2126\" stroke-width=\"1.6\" d=\"M{:.1f} "
        "{:.1f}H{:.1f}\"/>",
        x(value - error), y + 0.5 * bar - 1, x(value + error));
  return text + text_at(x(value + std::max(error, 0.0)) + 5, y + bar - 2,
                        fmt::format("{:.0f} %", 100.0 * value), " font-size=\"12\"");
}

}  // namespace

std::string bars_svg(const BarChart& chart) {
  std::string text = text_at(left, 16, chart.title, " font-weight=\"600\"");
  double y = 26;
  for (std::size_t s = 0; s < chart.series.size(); ++s, y += 18)
    text +=
        fmt::format("<rect class=\"f{0}\" fill=\"{1}\" x=\"{2}\" y=\"{3:.1f}\" width=\"14\" height=\"10\"/>",
                    s % 4, colours[s % 4], left, y) +
        text_at(left + 20, y + 10, chart.series[s], " font-size=\"13\"");
  y += 8;
  for (std::size_t i = 0; i < chart.names.size(); ++i) {
    text += text_at(left, y + 12, chart.names[i], " font-size=\"14\"");
    y += 17;
    for (std::size_t s = 0; s < chart.series.size(); ++s, y += bar)
      text += one_bar(chart.values[i][s], chart.errors[i][s], s % 4, y);
    y += group_gap;
  }
  text += text_at(left, y + 10, chart.x_label, " font-size=\"13\" class=\"soft\"");
  return svg_element(chart.title, width, std::nearbyint(y + 20), "", text);
}

}  // namespace tremie::report
