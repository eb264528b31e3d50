#include "apparatus/report/page/charts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/page/page.hpp"

namespace tremie::report {
namespace {

constexpr double left = 70, right = 14, bottom = 52, title_height = 22, entry_height = 18;
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
    const double room = std::max(1.15, std::pow(axis.high / axis.low, 0.04));
    axis.low /= room, axis.high *= room;
    return;
  }
  const bool positive = axis.low >= 0.0;
  if (from_zero && positive) axis.low = 0.0;
  double room = 0.06 * (axis.high - axis.low);
  if (!(room > 1e-9 * std::abs(axis.high))) room = std::max(0.05 * std::abs(axis.high), 1e-6);
  axis.high += room;
  axis.low = positive ? std::max(0.0, axis.low - room) : axis.low - room;
}

/// `step`: from one tick to the next; 0 on a logarithmic axis.
std::string number_text(double v, double step) {
  const double size = std::abs(v);
  if (size < 1e-9 * step) return "0";
  if (size >= 1e5 || size < 1e-3) {
    const double power = std::floor(std::log10(size) + 1e-9);
    return fmt::format("{:.2g}e{:.0f}", v / std::pow(10.0, power), power);
  }
  if (step == 0.0) return fmt::format("{:.4g}", v);
  return fmt::format("{:.{}f}", v, std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 6));
}

/// Powers of ten: with 2 and 5 between them over few, and not each of them over many.
std::vector<double> ticks_of(const Axis& axis, int n) {
  if (!axis.log) return round_ticks(axis.low, axis.high, n);
  const double decades = std::log10(axis.high / axis.low);
  const int every = 1 + static_cast<int>(decades / 7.0);
  std::vector<double> ticks;
  for (int d = static_cast<int>(std::floor(std::log10(axis.low))); d <= std::log10(axis.high) + 1; ++d)
    for (const double m : decades < 2.5 ? std::vector{1.0, 2.0, 5.0} : std::vector{1.0})
      if (const double v = m * std::pow(10.0, d); d % every == 0 && v >= axis.low && v <= axis.high)
        ticks.push_back(v);
  return ticks.size() > 1 ? ticks : round_ticks(axis.low, axis.high, n);
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
    text += text_at(x.from - 6, y.at(v) + 5, "end", number_text(v, y.log ? 0.0 : step_of(ys)));
  }
  for (const double v : xs) {
    line("axis", "#56616b", x.at(v), y.from, x.at(v), y.from + 4);
    text += text_at(x.at(v), y.from + 19, "middle", number_text(v, x.log ? 0.0 : step_of(xs)));
  }
  line("axis", "#56616b", x.from, y.from, x.to, y.from);
  text += text_at(0.5 * (x.from + x.to), y.from + bottom - 10, "middle", chart.x_label);
  return text +
         fmt::format("<text transform=\"translate(13 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
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

/// Colour and look of the i-th curve: the second round through the palette is dashed, with hollow points.
struct Look {
  std::size_t colour = 0;
  bool line = false, dashed = false, points = false, hollow = false;
};

Look look_of(const Curve& curve, std::size_t i) {
  const bool second = curve.colour < 0 && i >= colours.size(), points = curve.mark == Mark::points;
  return {.colour = (curve.colour < 0 ? i : static_cast<std::size_t>(curve.colour)) % colours.size(),
          .line = !points,
          .dashed = curve.mark == Mark::dashed || second,
          .points = points || curve.mark == Mark::line_and_points,
          .hollow = second};
}

std::string dot_svg(const Look& look, double x, double y, double radius) {
  return look.hollow ? fmt::format(
                           "<circle class=\"l{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.5\" "
                           "cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>",
                           look.colour, colours[look.colour], x, y, radius)
                     : fmt::format("<circle class=\"f{}\" fill=\"{}\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>",
                                   look.colour, colours[look.colour], x, y, radius);
}

std::string dots_of(const Curve& curve, const Look& look, const Axis& x, const Axis& y) {
  const std::size_t n = std::min(curve.x.size(), curve.y.size()), stride = n / most_points + 1;
  std::string text;
  for (std::size_t i = 0; i < n; i += stride)
    if (x.shows(curve.x[i]) && y.shows(curve.y[i]))
      text += dot_svg(look, x.at(curve.x[i]), y.at(curve.y[i]), n < 100 ? 3.5 : 1.6);
  return text;
}

/// An error bar between two values of y.
std::string bar_svg(const char* css, const char* colour, double at, double low, double high) {
  return fmt::format(
      "<path class=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\" d=\"M{:.1f} {:.1f}H{:.1f}M{:.1f} "
      "{:.1f}V{:.1f}M{:.1f} {:.1f}H{:.1f}\"/>",
      css, colour, at - 5, low, at + 5, at, low, high, at - 5, high, at + 5);
}

std::string curve_svg(const Curve& curve, std::size_t i, const Axis& x, const Axis& y) {
  const Look look = look_of(curve, i);
  std::string text;
  if (look.line)
    text += fmt::format(
        "<path class=\"l{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2.2\" stroke-linejoin=\"round\"{} "
        "d=\"{}\"/>",
        look.colour, colours[look.colour], look.dashed ? " stroke-dasharray=\"7 4\"" : "",
        path_of(curve, x, y));
  for (std::size_t k = 0; k < std::min(curve.low.size(), curve.high.size()); ++k)
    text += bar_svg(fmt::format("l{}", look.colour).c_str(), colours[look.colour], x.at(curve.x[k]),
                    y.at(curve.low[k]), y.at(curve.high[k]));
  return look.points ? text + dots_of(curve, look, x, y) : text;
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
                    "x1=\"{0:.1f}\" x2=\"{1:.1f}\" y1=\"{2:.1f}\" y2=\"{2:.1f}\"/>",
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

std::string range_svg(const Range& range, const Axis& x, const Axis& y) {
  const double from = x.at(std::max(range.low, x.low)), to = x.at(std::min(range.high, x.high));
  return fmt::format(
      "<rect class=\"f1\" fill=\"{}\" fill-opacity=\"0.12\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
      "height=\"{:.1f}\"/>",
      colours[1], from, y.to, std::max(0.0, to - from), y.from - y.to);
}

/// On a white edge, so that lines do not run through it.
std::string note_svg(const Note& note, const Axis& x, const Axis& y) {
  return text_at(
      x.at(note.x), y.at(note.y) + 4, "middle", note.text,
      fmt::format(" font-size=\"12\" fill=\"{}\" stroke=\"#fff\" stroke-width=\"3\" paint-order=\"stroke\"",
                  colours[static_cast<std::size_t>(note.colour) % colours.size()])
          .c_str());
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
std::string title_svg(const std::string& title, double width) {
  constexpr double letter = 0.6, size = 15.0;  // width of a letter over the size of the font
  const double wanted = letter * size * static_cast<double>(title.size());
  const double from = wanted > width - left - right ? 8.0 : left;
  const double fits = std::min(size, size * (width - from - 4.0) / std::max(wanted, 1.0));
  return text_at(from, 16, "start", title,
                 fmt::format(" font-weight=\"600\" font-size=\"{:.1f}\"", fits).c_str());
}

/// The legend stands above the curves, a line an entry, so that it never covers one. `sign` is drawn at y = 0.
struct Entry {
  std::string label, sign;
};

std::string line_sign(const std::string& css, const char* colour, double stroke, const char* dashes) {
  return fmt::format(
      "<line class=\"{}\" stroke=\"{}\" stroke-width=\"{}\"{} x1=\"{}\" x2=\"{}\" y1=\"-5\" y2=\"-5\"/>", css,
      colour, stroke, dashes, left, left + 26);
}

std::string box_sign(const char* css, const char* fill) {
  return fmt::format("<rect class=\"{}\" fill={} x=\"{}\" y=\"-10\" width=\"26\" height=\"11\"/>", css, fill,
                     left);
}

std::string curve_sign(const Look& look) {
  std::string text;
  if (look.line)
    text = line_sign(fmt::format("l{}", look.colour), colours[look.colour], 2.2,
                     look.dashed ? " stroke-dasharray=\"7 4\"" : "");
  return look.points ? text + dot_svg(look, left + 13, -5, 3.5) : text;
}

std::vector<Entry> entries_of(const LineChart& chart) {
  std::vector<Entry> entries;
  for (std::size_t i = 0; i < chart.curves.size(); ++i)
    if (const Curve& curve = chart.curves[i]; !curve.label.empty())
      entries.push_back({curve.label, curve_sign(look_of(curve, i))});
  for (const Level& level : chart.levels)
    entries.push_back({level.tolerance > 0.0
                           ? fmt::format("{}, {:.4g} ± {:.3g}", level.label, level.value, level.tolerance)
                           : fmt::format("{}, {:.4g}", level.label, level.value),
                       line_sign("level", "#1c2126", 1.4, " stroke-dasharray=\"2 4\"")});
  for (const Band& band : chart.bands)
    if (!band.label.empty()) entries.push_back({band.label, box_sign("band", "\"#e6e9ec\"")});
  for (const Range& range : chart.ranges)
    entries.push_back({range.label, box_sign("f1", "\"#c25400\" fill-opacity=\"0.12\"")});
  return entries;
}

std::string legend(const std::vector<Entry>& entries) {
  std::string text;
  double y = title_height + entry_height;
  for (const Entry& e : entries) {
    text += fmt::format("<g transform=\"translate(0 {:.1f})\">{}</g>", y, e.sign) +
            text_at(left + 33, y, "start", e.label);
    y += entry_height;
  }
  return text;
}

/// A long legend makes the chart higher, and leaves the curves their place.
double height_of(const LineChart& chart, std::size_t entries) {
  return chart.height + entry_height * static_cast<double>(entries > 4 ? entries - 4 : 0);
}

void include_all(const LineChart& chart, Axis& x, Axis& y) {
  const auto add = [](const std::vector<double>& values, Axis& axis) {
    for (const double v : values) axis.include(v);
  };
  for (const Curve& curve : chart.curves)
    add(curve.x, x), add(curve.y, y), add(curve.low, y), add(curve.high, y);
  for (const Band& band : chart.bands) add(band.low, y), add(band.high, y);
  for (const Patch& p : chart.patches) add({p.x0, p.x1}, x), add({p.y0, p.y1}, y);
  for (const Level& level : chart.levels)
    add({level.value - level.tolerance, level.value + level.tolerance}, y);
  for (const EndBar& bar : chart.bars) add({bar.y - bar.half, bar.y + bar.half}, y);
}

/// All of a chart, from (0, 0) to (its width, `height`).
std::string panel(const LineChart& chart, const std::vector<Entry>& entries, double height) {
  const double top = title_height + entry_height * static_cast<double>(entries.size()) + 12;
  Axis x{.log = chart.log_x, .from = left, .to = chart.width - right};
  Axis y{.log = chart.log_y, .from = height - bottom, .to = top};
  include_all(chart, x, y);
  if (chart.log_x || !(x.high > x.low)) widen(x, false);
  widen(y, chart.y_from_zero);
  std::string text = title_svg(chart.title, chart.width) + legend(entries);
  for (const Band& band : chart.bands) text += band_svg(band, x, y);
  for (const Range& range : chart.ranges) text += range_svg(range, x, y);
  for (const Level& level : chart.levels) text += level_svg(level, x, y);
  text += grid_and_axes(chart, x, y) + patches_svg(chart, x, y);
  for (std::size_t i = 0; i < chart.curves.size(); ++i) text += curve_svg(chart.curves[i], i, x, y);
  for (const EndBar& bar : chart.bars)
    text += bar_svg("level", "#1c2126", x.at(bar.x), y.at(bar.y - bar.half), y.at(bar.y + bar.half));
  for (const Note& note : chart.notes) text += note_svg(note, x, y);
  return text;
}

}  // namespace

std::string svg_element(const std::string& title, double width, double height, const std::string& size,
                        const std::string& content) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\"{} role=\"img\" aria-label=\"{}\" "
      "font-family=\"sans-serif\" font-size=\"15\" fill=\"#1c2126\">{}</svg>\n",
      width, height, size, escaped(title), content);
}

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
  const double height = height_of(chart, entries.size());
  return svg_element(chart.title, chart.width, height, "", panel(chart, entries, height));
}

std::string svg_file(const std::vector<LineChart>& charts, std::size_t columns) {
  constexpr double scale = 1.25;  // of a chart that no page makes wider or narrower
  std::string content, title;
  double y = 6.0, width = 0.0, row_height = 0.0;
  for (std::size_t i = 0; i < charts.size(); ++i) {
    const auto entries = entries_of(charts[i]);
    const double height = height_of(charts[i], entries.size()),
                 x = static_cast<double>(i % columns) * charts[i].width;
    content += fmt::format("<g transform=\"translate({:.1f} {:.1f})\">{}</g>", x, y,
                           panel(charts[i], entries, height));
    title += (title.empty() ? "" : "; ") + charts[i].title;
    width = std::max(width, x + charts[i].width), row_height = std::max(row_height, height + 12.0);
    if ((i + 1) % columns == 0 || i + 1 == charts.size()) y += row_height, row_height = 0.0;
  }
  return svg_element(title, width, y,
                     fmt::format(" width=\"{:.0f}\" height=\"{:.0f}\"", scale * width, scale * y),
                     fmt::format("<rect fill=\"#fff\" width=\"{}\" height=\"{}\"/>{}", width, y, content));
}

}  // namespace tremie::report
