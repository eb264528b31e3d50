#include "apparatus/report/fit_page/replicates_page.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "apparatus/report/fit_page/fit_page.hpp"
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

std::size_t records_of(const RecordFits& r) { return std::max(r.fits.size(), r.protocols.size()); }

/// "static yield stress, 0.025 rev/s after 240 s of rest".
std::string words_of(const ReplicateMean& m) {
  return m.parameter.words + (m.where.empty() ? "" : ", " + m.where);
}

void add_torques(const std::vector<FitResult>& fits, Page& page) {
  if (fits.empty()) return;
  LineChart chart{.title = "The records and their fits",
                  .x_label = x_label(fits.front()),
                  .y_label = y_label(fits.front()),
                  .curves = {}};
  const std::size_t shown = std::min(fits.size(), most_curves);
  for (std::size_t i = 0; i < shown; ++i)
    chart.curves.push_back({fmt::format("record {}", i + 1), shown_x(fits[i]), fits[i].curve.fitted});
  chart.curves.resize(most_curves);  // so that a record's dots have its line's colour
  for (std::size_t i = 0; i < shown; ++i)
    chart.curves.push_back({"", shown_x(fits[i]), fits[i].curve.observed, Mark::points});
  const std::string left_out =
      shown < fits.size() ? fmt::format(" The first {} of {} records.", shown, fits.size()) : "";
  if (can_be_drawn(chart))
    page.figures.push_back({"torque", "Lines: fits; dots: readings." + left_out, chart_svg(chart)});
}

GridTable means_table(const RecordFits& r) {
  GridTable table{"Mean over the records",
                  {"", "mean", "95 % interval", "told by", "scatter between them", "expected from the fits",
                   "between laboratories"},
                  {}};
  for (const ReplicateMean& m : r.means) {
    const std::string unit = m.parameter.unit.empty() ? "" : " " + unit_on_page(m.parameter);
    const auto& interval = m.mean.ci95;
    table.rows.push_back({words_of(m), scene::rounded(m.mean.value, 4) + unit,
                          interval ? fmt::format("{} to {}", scene::rounded(interval->low, 4),
                                                 scene::rounded(interval->high, 4))
                                   : "–",
                          fmt::format("{} of {}", m.records, records_of(r)), percent(m.between),
                          percent(m.within), percent(m.parameter.laboratories)});
  }
  return table;
}

GridTable records_table(const RecordFits& r, const std::vector<std::string>& records) {
  GridTable table{"Record by record", {"", "record"}, {}};
  if (!r.fits.empty()) table.columns.push_back("scatter about its fit");
  for (const ReplicateMean& m : r.means) {
    if (!m.where.empty()) continue;
    const FitParameter& p = m.parameter;
    table.columns.push_back(p.unit.empty() ? p.words : fmt::format("{} ({})", p.words, unit_on_page(p)));
  }
  for (std::size_t i = 0; i < records_of(r); ++i) {
    std::vector<std::string> row{fmt::format("{}", i + 1), records[i]};
    if (!r.fits.empty()) row.push_back(percent(r.fits[i].scatter));
    for (const ReplicateMean& m : r.means)
      if (m.where.empty()) row.push_back(m.of_record[i] ? scene::rounded(m.of_record[i]->value, 4) : "–");
    table.rows.push_back(row);
  }
  return table;
}

std::string headline(const RecordFits& r) {
  std::string text;
  for (const ReplicateMean& m : r.means) {
    if (!m.where.empty()) continue;
    text +=
        fmt::format("{}{} {}", text.empty() ? "" : ", ", m.parameter.words, scene::rounded(m.mean.value, 3));
    if (m.mean.ci95) text += " ± " + scene::rounded(0.5 * (m.mean.ci95->high - m.mean.ci95->low), 2);
    if (!m.parameter.unit.empty()) text += " " + unit_on_page(m.parameter);
  }
  return fmt::format("{} {} of one material: {}", records_of(r), r.fits.empty() ? "tests" : "records",
                     text.empty() ? "they tell no parameter" : text);
}

}  // namespace

std::string replicates_html(const RecordFits& r, const std::vector<std::string>& records,
                            const std::string& command) {
  Page page;
  page.headline = headline(r);
  page.title = "Tremie: " + page.headline;
  page.verdict = {r.reasons.empty() ? VerdictKind::agrees : VerdictKind::differs,
                  r.reasons.empty()
                      ? "The model fits every record."
                      : "The model does not fit every record, or not every parameter can be trusted."};
  page.trust = {r.reasons.empty(), "± is 95 % of the mean, by the scatter between the records.", r.reasons};
  add_torques(r.fits, page);
  page.grids = {means_table(r), records_table(r, records)};
  page.remarks = r.notes;
  page.words = {
      "Scatter between the records larger than what the fits expect: the material, its rest or its sampling "
      "differs "
      "between them, which no single fit can see.",
      "Between laboratories: one cement paste in the rheometers of several (Haist et al. 2020)."};
  page.made = facts_of_this_run(command);
  return to_html(page);
}

}  // namespace tremie::report
