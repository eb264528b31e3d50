#include "apparatus/report/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/process.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::report {
namespace {

constexpr std::size_t most_points = 2000;  ///< of a curve
constexpr std::array colours{"#0b5394", "#b45f06", "#38761d", "#741b47"};

/// A gnuplot string in single quotes.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + "'";
}

const scene::Column* find_column(const std::vector<scene::Column>& series, const std::string& name) {
  const auto found =
      std::find_if(series.begin(), series.end(), [&](const auto& c) { return c.name == name; });
  return found == series.end() ? nullptr : &*found;
}

/// The curve, thinned to what a chart can show.
std::string data_block(const std::vector<double>& x, const std::vector<double>& y, std::size_t i) {
  const std::size_t n = std::min(x.size(), y.size()), stride = n / most_points + 1;
  std::string text = fmt::format("$d{} << EOD\n", i);
  for (std::size_t k = 0; k < n; k = k + 1 < n ? std::min(k + stride, n - 1) : n)
    if (std::isfinite(y[k])) text += fmt::format("{:.6g} {:.6g}\n", x[k], y[k]);
  return text + "EOD\n";
}

/// The tolerance as a pale band, behind the curves.
std::string bands(const scene::Chart& chart) {
  std::string text;
  for (const auto& r : chart.references) {
    if (r.tolerance <= 0.0) continue;
    text += fmt::format(
        "set object rectangle from graph 0, first {:.6g} to graph 1, first {:.6g} fillcolor rgb '#eeeeee' "
        "fillstyle solid noborder behind\n",
        r.value - r.tolerance, r.value + r.tolerance);
  }
  return text;
}

/// Whether some curve of it has two finite points: gnuplot fails on a chart without.
bool can_be_drawn(const scene::Chart& chart, const std::vector<scene::Column>& columns) {
  const auto has_two = [&](const std::string& name) {
    const auto* column = find_column(columns, name);
    return column && std::count_if(column->values.begin(), column->values.end(),
                                   [](double v) { return std::isfinite(v); }) >= 2;
  };
  return std::any_of(chart.columns.begin(), chart.columns.end(), has_two);
}

}  // namespace

std::string chart_script(const scene::Chart& chart, const std::vector<scene::Column>& series) {
  std::string text = fmt::format(
      "set terminal svg size 720,440 dynamic enhanced background rgb 'white' font 'sans,14'\nset output {}\n"
      "set title {} noenhanced\nset xlabel {} noenhanced\nset ylabel {} noenhanced\n"
      "set border 3 linecolor rgb '#444444'\nset tics nomirror out\nset grid linecolor rgb '#dddddd'\n"
      "set key bottom right\nset offsets 0, 0, graph 0.05, graph 0.05\n",
      quoted(chart.file), quoted(chart.title), quoted(chart.x_label), quoted(chart.y_label));
  text += bands(chart);
  std::string plots;
  for (std::size_t i = 0; i < chart.columns.size(); ++i) {
    const auto* column = find_column(series, chart.columns[i]);
    if (!column || series.empty()) continue;
    text += data_block(series.front().values, column->values, i);
    const std::string label = i < chart.labels.size() ? chart.labels[i] : "computed";
    const std::string title =
        chart.columns.size() + chart.references.size() > 1 ? "title " + quoted(label) : "notitle";
    plots += fmt::format("{}$d{} using 1:2 with lines linewidth 2 linecolor rgb '{}' {}",
                         plots.empty() ? "" : ", ", i, colours[i % colours.size()], title);
  }
  for (const auto& r : chart.references) {
    const std::string label = r.tolerance > 0.0
                                  ? fmt::format("{}, {:g} ± {:g}", r.label, r.value, r.tolerance)
                                  : fmt::format("{}, {:g}", r.label, r.value);
    plots += fmt::format(", {:.6g} with lines dashtype 2 linewidth 1.5 linecolor rgb '#666666' title {}",
                         r.value, quoted(label));
  }
  return text + "plot " + plots + "\n";
}

std::string draw_charts(const scene::Outcome& outcome, const std::filesystem::path& folder) {
  std::string script;
  for (const auto& chart : outcome.charts)
    if (const auto& columns = columns_of(chart, outcome); can_be_drawn(chart, columns))
      script += chart_script(chart, columns) + "reset\n";
  if (script.empty()) return {};
  const auto gnuplot = find_program("gnuplot");
  if (gnuplot.empty()) return "gnuplot is not installed: no charts";
  const auto file = folder / ".charts.gp";
  io::write_text(file, script);
  const auto code = run_program(gnuplot, {file.filename().string()}, folder);
  std::filesystem::remove(file);
  return code == 0 ? "" : "gnuplot failed: charts are missing or not complete";
}

}  // namespace tremie::report
