#include "apparatus/report/fit_page/replicates_page.hpp"

#include <fmt/format.h>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::report {
namespace {

/// Beyond four, lines and their colours are no longer told apart.
constexpr std::size_t most_curves = 4;

std::string percent(const std::optional<double>& share) {
  return share ? fmt::format("{:.2g} %", 100.0 * *share) : "–";
}

void add_torques(const ReplicatesReport& r, Page& page) {
  const FitReport& first = r.fits.front();
  LineChart chart{.title = "The records and their fits",
                  .x_label = first.decay ? "time (s)" : "speed (rev/s)",
                  .y_label = "torque (N·m)",
                  .curves = {}};
  const std::size_t shown = std::min(r.fits.size(), most_curves);
  for (std::size_t i = 0; i < shown; ++i)
    chart.curves.push_back({fmt::format("record {}", i + 1), r.fits[i].x, r.fits[i].fitted});
  chart.curves.resize(most_curves);  // so that a record's dots have its line's colour
  for (std::size_t i = 0; i < shown; ++i)
    chart.curves.push_back({"", r.fits[i].x, r.fits[i].observed, Mark::points});
  const std::string left_out =
      shown < r.fits.size() ? fmt::format(" The first {} of {} records.", shown, r.fits.size()) : "";
  if (can_be_drawn(chart))
    page.figures.push_back({"torque", "Lines: fits; dots: readings." + left_out, chart_svg(chart)});
}

GridTable means_table(const ReplicatesReport& r) {
  GridTable table{"Mean over the records",
                  {"", "mean", "95 % interval", "told by", "scatter between them", "expected from the fits",
                   "between laboratories"},
                  {}};
  for (const MeanParameter& m : r.means) {
    const std::string unit = m.unit.empty() ? "" : " " + m.unit;
    table.rows.push_back({m.words, scene::rounded(m.mean, 4) + unit,
                          m.low && m.high
                              ? fmt::format("{} to {}", scene::rounded(*m.low, 4), scene::rounded(*m.high, 4))
                              : "–",
                          fmt::format("{} of {}", m.records, r.fits.size()), percent(m.between),
                          percent(m.within), percent(m.laboratories)});
  }
  return table;
}

GridTable records_table(const ReplicatesReport& r) {
  GridTable table{"Record by record", {"", "record", "scatter about its fit"}, {}};
  for (const MeanParameter& m : r.means)
    table.columns.push_back(m.unit.empty() ? m.words : fmt::format("{} ({})", m.words, m.unit));
  for (std::size_t i = 0; i < r.fits.size(); ++i) {
    std::vector<std::string> row{fmt::format("{}", i + 1), r.fits[i].record, percent(r.fits[i].scatter)};
    for (const MeanParameter& m : r.means) row.push_back(m.values[i] ? scene::rounded(*m.values[i], 4) : "–");
    table.rows.push_back(row);
  }
  return table;
}

std::string headline(const ReplicatesReport& r) {
  std::string text;
  for (const MeanParameter& m : r.means) {
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", m.words, scene::rounded(m.mean, 3));
    if (m.low && m.high) text += " ± " + scene::rounded(0.5 * (*m.high - *m.low), 2);
    if (!m.unit.empty()) text += " " + m.unit;
  }
  return fmt::format("{} records of one material: {}", r.fits.size(),
                     text.empty() ? "they tell no parameter" : text);
}

}  // namespace

std::string replicates_html(const ReplicatesReport& r) {
  Page page;
  page.headline = headline(r);
  page.title = "Tremie: " + page.headline;
  page.verdict = {r.reasons.empty() ? VerdictKind::agrees : VerdictKind::differs,
                  r.reasons.empty()
                      ? "The model fits every record."
                      : "The model does not fit every record, or not every parameter can be trusted."};
  page.trust = {r.reasons.empty(), "± is 95 % of the mean, by the scatter between the records.", r.reasons};
  add_torques(r, page);
  page.grids = {means_table(r), records_table(r)};
  page.words = {
      "Scatter between the records larger than what the fits expect: the material, its rest or its sampling "
      "differs "
      "between them, which no single fit can see.",
      "Between laboratories: one cement paste in the rheometers of several (Haist et al. 2020)."};
  page.made = facts_of_this_run(r.command);
  return to_html(page);
}

}  // namespace tremie::report
