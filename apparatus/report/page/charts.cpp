#include "apparatus/report/page/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/page/page.hpp"

namespace tremie::report {
namespace {

constexpr double width = 480, height = 330, left = 66, right = 14, bottom = 52;
constexpr std::size_t most_points = 600;  ///< of a curve: more than the chart has dots
constexpr std::array colours{"#0067a5", "#c25400", "#00785a", "#9a4f8a"};

struct Axis {
  double low = 1e300, high = -1e300;
  bool log = false;
  double from = 0.0, to = 1.0;  ///< on the paper

  void include(double v) {
    if (!std::isfinite(v) || (log && v <= 0.0)) return;
    low = std::min(low, v), high = std::max(high, v);
  }
  double at(double v) const {
    const double share = log ? std::log(v / low) / std::log(high / low) : (v - low) / (high - low);
    return from + share * (to - from);
  }
  bool shows(double v) const { return std::isfinite(v) && !(log && v <= 0.0); }
};

/// A little room above and below; never below 0 for values that are not.
void widen(Axis& axis, bool from_zero) {
  if (axis.low > axis.high) axis.low = 0.0, axis.high = 1.0;
  if (axis.log) {
    axis.low /= 1.15, axis.high *= 1.15;
    return;
  }
  const bool positive = axis.low >= 0.0;
  if (from_zero && positive) axis.low = 0.0;
  double room = 0.06 * (axis.high - axis.low);
  if (!(room > 1e-9 * std::abs(axis.high))) room = std::max(0.05 * std::abs(axis.high), 1e-6);
  axis.high += room;
  axis.low = positive ? std::max(0.0, axis.low - room) : axis.low - room;
}

std::string number_text(double v, double step) {
  if (std::abs(v) < 1e-9 * step) return "0";
  const double size = std::abs(v);
  if (size >= 1e5) return fmt::format("{:.2g}", v);
  if (size < 1e-3) {
    const double power = std::floor(std::log10(size) + 1e-9);
    return fmt::format("{:.2g}e{:.0f}", v / std::pow(10.0, power), power);
  }
  const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6);
  std::string text = fmt::format("{:.{}f}", v, digits);
  return text;
}

std::vector<double> ticks_of(const Axis& axis, int n) {
  if (!axis.log) return round_ticks(axis.low, axis.high, n);
  std::vector<double> ticks;
  const bool few = std::log10(axis.high / axis.low) < 1.5;
  for (int d = static_cast<int>(std::floor(std::log10(axis.low))); d <= std::log10(axis.high) + 1; ++d)
    for (const double m : few ? std::vector{1.0, 2.0, 5.0} : std::vector{1.0})
      if (const double v = m * std::pow(10.0, d); v >= axis.low && v <= axis.high) ticks.push_back(v);
  return ticks;
}

std::string text_at(double x, double y, const char* anchor, const std::string& text, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\"{}>{}</text>", x, y, anchor, more,
                     escaped(text));
}

std::string grid_and_axes(const LineChart& chart, const Axis& x, const Axis& y) {
  std::string text;
  const auto line = [&](const char* css, const char* colour, double x1, double y1, double x2, double y2) {
    text += fmt::format(
        "<line class=\"{}\" stroke=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", css,
        colour, x1, y1, x2, y2);
  };
  const auto step_of = [](const std::vector<double>& t) { return t.size() > 1 ? t[1] - t[0] : 1.0; };
  const auto xs = ticks_of(x, 6), ys = ticks_of(y, 5);
  for (const double v : ys) {
    line("grid", "#d5dade", x.from, y.at(v), x.to, y.at(v));
    text += text_at(x.from - 6, y.at(v) + 5, "end", number_text(v, y.log ? v : step_of(ys)));
  }
  for (const double v : xs) {
    line("axis", "#56616b", x.at(v), y.from, x.at(v), y.from + 4);
    text += text_at(x.at(v), y.from + 19, "middle", number_text(v, x.log ? v : step_of(xs)));
  }
  line("axis", "#56616b", x.from, y.from, x.to, y.from);
  text += text_at(0.5 * (x.from + x.to), height - 10, "middle", chart.x_label);
  return text +
         fmt::format("<text transform=\"translate(15 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                     0.5 * (y.from + y.to), escaped(chart.y_label));
}

std::string path_of(const Curve& curve, const Axis& x, const Axis& y) {
  const std::size_t n = std::min(curve.x.size(), curve.y.size()), stride = n / most_points + 1;
  std::string text;
  bool pen = false;
  for (std::size_t i = 0; i < n; i = i + 1 < n ? std::min(i + stride, n - 1) : n) {
    const bool shown = x.shows(curve.x[i]) && y.shows(curve.y[i]);
    if (shown) text += fmt::format("{}{:.1f} {:.1f}", pen ? "L" : "M", x.at(curve.x[i]), y.at(curve.y[i]));
    pen = shown;
  }
  return text;
}

std::string dots_of(const Curve& curve, std::size_t colour, const Axis& x, const Axis& y) {
  const std::size_t n = std::min(curve.x.size(), curve.y.size()), stride = n / most_points + 1;
  std::string text;
  for (std::size_t i = 0; i < n; i += stride)
    if (x.shows(curve.x[i]) && y.shows(curve.y[i]))
      text += fmt::format("<circle class=\"f{}\" fill=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", colour,
                          colours[colour], x.at(curve.x[i]), y.at(curve.y[i]), n < 100 ? 3.5 : 1.6);
  return text;
}

std::string curve_svg(const Curve& curve, std::size_t i, const Axis& x, const Axis& y) {
  const std::size_t colour = i % colours.size();
  if (curve.mark == Mark::points) return dots_of(curve, colour, x, y);
  const bool dashed = curve.mark == Mark::dashed || i >= colours.size();
  return fmt::format(
      "<path class=\"l{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.2\" stroke-linejoin=\"round\"{} "
      "d=\"{}\"/>",
      colour, colours[colour], dashed ? " stroke-dasharray=\"7 4\"" : "", path_of(curve, x, y));
}

std::string level_svg(const Level& level, const Axis& x, const Axis& y) {
  std::string text;
  if (level.tolerance > 0.0)
    text += fmt::format(
        "<rect class=\"band\" fill=\"#e6e9ec\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
        "height=\"{:.1f}\"/>",
        x.from, y.at(level.value + level.tolerance), x.to - x.from,
        y.at(level.value - level.tolerance) - y.at(level.value + level.tolerance));
  return text + fmt::format(
                    "<line class=\"level\" stroke=\"#1c2126\" stroke-width=\"1.4\" stroke-dasharray=\"2 4\" "
                    "x1=\"{0:.1f}\" "
                    "x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>",
                    x.from, x.to, y.at(level.value));
}

std::string band_svg(const Band& band, const Axis& x, const Axis& y) {
  std::string points;
  const std::size_t n = std::min({band.x.size(), band.low.size(), band.high.size()});
  const auto add = [&](double a, double b) {
    if (x.shows(a) && y.shows(b)) points += fmt::format("{:.1f},{:.1f} ", x.at(a), y.at(b));
  };
  for (std::size_t i = 0; i < n; ++i) add(band.x[i], band.high[i]);
  for (std::size_t i = n; i-- > 0;) add(band.x[i], band.low[i]);
  return "<polygon class=\"band\" fill=\"#e6e9ec\" points=\"" + points + "\"/>";
}

std::string bar_svg(const EndBar& bar, const Axis& x, const Axis& y) {
  const double at = x.at(bar.x), low = y.at(bar.y - bar.half), high = y.at(bar.y + bar.half);
  return fmt::format(
      "<path class=\"level\" fill=\"none\" stroke=\"#1c2126\" stroke-width=\"2\" d=\"M{0:.1f} "
      "{1:.1f}H{2:.1f}M{3:.1f} "
      "{1:.1f}V{4:.1f}M{0:.1f} {4:.1f}H{2:.1f}\"/>",
      at - 5, low, at + 5, at, high);
}

std::string patches_svg(const LineChart& chart, const Axis& x, const Axis& y) {
  std::string text;
  for (const Patch& p : chart.patches)
    text += fmt::format(
        "<rect class=\"f0\" fill=\"{}\" fill-opacity=\"{:.2f}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
        "height=\"{:.1f}\"/>",
        colours[0], p.share, x.at(p.x0), y.at(p.y1), x.at(p.x1) - x.at(p.x0) + 0.2,
        y.at(p.y0) - y.at(p.y1) + 0.2);
  return text;
}

/// A title that is too long for its place is set smaller and further to the left.
std::string title_svg(const std::string& title) {
  constexpr double letter = 0.6, size = 15.0;  // width of a letter over the size of the font
  const double wanted = letter * size * static_cast<double>(title.size());
  const double from = wanted > width - left - right ? 8.0 : left;
  const double fits = std::min(size, size * (width - from - 4.0) / std::max(wanted, 1.0));
  return text_at(from, 16, "start", title,
                 fmt::format(" font-weight=\"600\" font-size=\"{:.1f}\"", fits).c_str());
}

/// The legend stands above the curves, a line an entry, so that it never covers one.
struct Entry {
  std::string label;
  int colour;  ///< of a curve; -1: a level, -2: a band
  Mark mark;
};

std::vector<Entry> entries_of(const LineChart& chart) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < chart.curves.size(); ++i)
    if (!chart.curves[i].label.empty())
      entries.push_back(
          {chart.curves[i].label, static_cast<int>(i % colours.size()),
           i >= colours.size() && chart.curves[i].mark == Mark::line ? Mark::dashed : chart.curves[i].mark});
  for (const Level& level : chart.levels)
    entries.push_back({level.tolerance > 0.0
                           ? fmt::format("{}, {:.4g} ± {:.3g}", level.label, level.value, level.tolerance)
                           : fmt::format("{}, {:.4g}", level.label, level.value),
                       -1, Mark::line});
  for (const Band& band : chart.bands)
    if (!band.label.empty()) entries.push_back({band.label, -2, Mark::line});
  return entries;
}

std::string legend(const std::vector<Entry>& entries, double top) {
  std::string text;
  double y = top;
  for (const Entry& e : entries) {
    const std::string css = e.colour >= 0 ? fmt::format("l{}", e.colour) : "level";
    const char* colour = e.colour >= 0 ? colours[static_cast<std::size_t>(e.colour)] : "#1c2126";
    if (e.colour == -2)
      text += fmt::format(
          "<rect class=\"band\" fill=\"#e6e9ec\" x=\"{}\" y=\"{:.1f}\" width=\"26\" height=\"11\"/>", left,
          y - 10);
    else if (e.mark == Mark::points)
      text += fmt::format("<circle class=\"f{}\" fill=\"{}\" cx=\"{}\" cy=\"{:.1f}\" r=\"3.5\"/>", e.colour,
                          colour, left + 13, y - 5);
    else
      text += fmt::format(
          "<line class=\"{}\" stroke=\"{}\" stroke-width=\"2.2\"{} x1=\"{}\" x2=\"{}\" y1=\"{:.1f}\" "
          "y2=\"{:.1f}\"/>",
          css, colour,
          e.colour < 0             ? " stroke-dasharray=\"2 4\""
          : e.mark == Mark::dashed ? " stroke-dasharray=\"7 4\""
                                   : "",
          left, left + 26, y - 5, y - 5);
    text += text_at(left + 33, y, "start", e.label);
    y += 18;
  }
  return text;
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int n) {
  const double raw = (high - low) / n, power = std::pow(10.0, std::floor(std::log10(raw))),
               lead = raw / power;
  const double step = power * (lead <= 1.0 ? 1.0 : lead <= 2.0 ? 2.0 : lead <= 5.0 ? 5.0 : 10.0);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step);
  return ticks;
}

bool can_be_drawn(const LineChart& chart) {
  return std::any_of(chart.curves.begin(), chart.curves.end(), [](const Curve& curve) {
    return std::count_if(curve.y.begin(), curve.y.end(), [](double v) { return std::isfinite(v); }) >= 2;
  });
}

std::string chart_svg(const LineChart& chart) {
  const auto entries = entries_of(chart);
  const double title = 22, top = title + 18 * static_cast<double>(entries.size()) + 12;
  Axis x{.log = chart.log_x, .from = left, .to = width - right};
  Axis y{.log = chart.log_y, .from = height - bottom, .to = top};
  for (const Curve& curve : chart.curves) {
    for (const double v : curve.x) x.include(v);
    for (const double v : curve.y) y.include(v);
  }
  for (const Band& band : chart.bands)
    for (const auto* side : {&band.low, &band.high})
      for (const double v : *side) y.include(v);
  for (const Patch& p : chart.patches) x.include(p.x0), x.include(p.x1), y.include(p.y0), y.include(p.y1);
  for (const Level& level : chart.levels)
    y.include(level.value - level.tolerance), y.include(level.value + level.tolerance);
  for (const EndBar& bar : chart.bars) y.include(bar.y - bar.half), y.include(bar.y + bar.half);
  if (!(x.high > x.low)) widen(x, false);
  widen(y, chart.y_from_zero);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" role=\"img\" aria-label=\"{2}\" "
      "font-family=\"sans-serif\" font-size=\"15\" fill=\"#1c2126\">",
      width, height, escaped(chart.title));
  text += title_svg(chart.title) + legend(entries, title + 18);
  for (const Band& band : chart.bands) text += band_svg(band, x, y);
  for (const Level& level : chart.levels) text += level_svg(level, x, y);
  text += grid_and_axes(chart, x, y) + patches_svg(chart, x, y);
  for (std::size_t i = 0; i < chart.curves.size(); ++i) text += curve_svg(chart.curves[i], i, x, y);
  for (const EndBar& bar : chart.bars) text += bar_svg(bar, x, y);
  return text + "</svg>\n";
}

}  // namespace tremie::report
