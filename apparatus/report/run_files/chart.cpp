#include "apparatus/report/run_files/chart.hpp"

#include <algorithm>

#include "libmpm/io/write_error.hpp"

namespace tremie::report {
namespace {

/// The error bar of a column at the end of the time; the result has the column's name.
void add_bars(const scene::Chart& chart, const scene::Outcome& outcome, LineChart& drawn) {
  if (!outcome.error || !chart.table.empty()) return;
  for (std::size_t i = 0; i < drawn.curves.size(); ++i)
    for (const auto& bar : outcome.error->bars)
      if (!drawn.curves[i].y.empty() && bar.name == chart.columns[i])
        drawn.bars.push_back({drawn.curves[i].x.back(), drawn.curves[i].y.back(), bar.error});
}

}  // namespace

LineChart line_chart(const scene::Chart& chart, const scene::Outcome& outcome) {
  const auto& columns = scene::columns_of(chart, outcome);
  LineChart drawn{.title = chart.title, .x_label = chart.x_label, .y_label = chart.y_label};
  const auto* over =
      chart.over.empty() || columns.empty() ? nullptr : scene::find_column(columns, chart.over);
  const bool several = chart.columns.size() + chart.references.size() > 1;
  for (std::size_t i = 0; i < chart.columns.size(); ++i) {
    Curve curve;
    if (several) curve.label = i < chart.labels.size() ? chart.labels[i] : "computed";
    if (const auto* column = scene::find_column(columns, chart.columns[i]))
      curve.x = over ? over->values : columns.front().values, curve.y = column->values;
    drawn.curves.push_back(std::move(curve));
  }
  for (const auto& r : chart.references) drawn.levels.push_back({r.label, r.value, r.tolerance});
  add_bars(chart, outcome, drawn);
  return drawn;
}

void draw_charts(const scene::Outcome& outcome, const std::filesystem::path& folder) {
  for (const auto& chart : outcome.charts)
    if (const LineChart drawn = line_chart(chart, outcome); can_be_drawn(drawn))
      io::write_text(folder / chart.file, chart_svg(drawn));
}

}  // namespace tremie::report
