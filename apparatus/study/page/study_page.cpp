#include "apparatus/study/page/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/report/run_files/glossary.hpp"

namespace tremie::study {
namespace {

using report::unit_for_people;
using report::with_unit;
using report::words_of;

constexpr std::size_t most_figures = 24;

std::string percent(double share, double error) {
  return fmt::format("{:.0f} ± {:.0f} %", 100.0 * share, 100.0 * error);
}

/// "spread: mix.yield_stress decides 87 ± 3 % of its variance, test.rest 9 ± 2 %."
std::string what_matters(const Definition& study, const ResultIndices& one) {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < one.indices.size(); ++i) order.emplace_back(-one.indices[i].total, i);
  std::sort(order.begin(), order.end());
  std::vector<std::string> parts;
  for (const auto& [total, i] : order)
    if (parts.size() < 4)
      parts.push_back(fmt::format("{} {}", study.factors[i].key,
                                  percent(one.indices[i].total, one.indices[i].total_error)));
  return fmt::format("{}, total-effect share of each factor in its variance: {}.", words_of(one.result),
                     fmt::join(parts, ", "));
}

report::Figure bars(const Definition& study, const ResultIndices& one) {
  report::BarChart chart{
      .title = "What matters: " + words_of(one.result),
      .x_label = "share of the variance; line: 95 % interval",
      .series = {"by the factor alone (first order)", "with all that it interacts in (total)"}};
  for (std::size_t i = 0; i < one.indices.size(); ++i) {
    const SobolIndex& index = one.indices[i];
    chart.names.push_back(study.factors[i].key);
    chart.values.push_back({index.first, index.total});
    chart.errors.push_back({index.first_error, index.total_error});
  }
  return {"sobol-" + one.result,
          fmt::format("Sobol indices of {} rows; the fitted polynomial explains {:.0f} % of rows left out.",
                      one.rows, 100.0 * one.explained),
          bars_svg(chart)};
}

/// The trusted rows' result over a factor, as points.
report::Curve scatter(const Design& design, const Collected& collected, std::size_t factor,
                      std::size_t result) {
  report::Curve curve{.label = "runs", .mark = report::Mark::points};
  for (const Row& row : collected.rows) {
    const auto number = trusted_number(row, result);
    if (!number || row.row >= design.size()) continue;
    curve.x.push_back(design[row.row][factor].number), curve.y.push_back(*number);
  }
  return curve;
}

/// The result over one factor: rows, and the mean over all other factors.
void add_effect(const Definition& study, const Design& design, const Collected& collected,
                const ResultIndices* one, std::size_t factor, std::size_t result, report::Page& page) {
  const Factor& f = study.factors[factor];
  const std::string& name = study.results[result];
  report::LineChart chart{.title = fmt::format("{} over {}", words_of(name), f.key),
                          .x_label = with_unit(f.key, unit_of(f)),
                          .y_label = with_unit(words_of(name), unit_for_people(name)),
                          .curves = {scatter(design, collected, factor, result)}};
  chart.log_x = f.scale == Scale::log;
  if (one)
    chart.curves.push_back({"mean over the other factors", one->main_effects[factor].at,
                            one->main_effects[factor].mean, report::Mark::line});
  if (page.figures.size() < most_figures && report::can_be_drawn(chart))
    page.figures.push_back({fmt::format("effect-{}-{}", name, f.key), "", chart_svg(chart)});
}

void add_figures(const Definition& study, const Design& design, const Collected& collected,
                 const std::vector<ResultIndices>& indices, report::Page& page) {
  for (std::size_t r = 0; r < study.results.size(); ++r) {
    const auto found = std::find_if(indices.begin(), indices.end(),
                                    [&](const auto& one) { return one.result == study.results[r]; });
    const ResultIndices* one = found == indices.end() ? nullptr : &*found;
    if (one) page.figures.push_back(bars(study, *one));
    for (std::size_t f = 0; f < study.factors.size(); ++f)
      add_effect(study, design, collected, one, f, r, page);
  }
}

report::GridTable index_table(const Definition& study, const ResultIndices& one) {
  report::GridTable table{"Sobol indices of " + words_of(one.result), {"factor", "first order", "total"}};
  for (std::size_t i = 0; i < one.indices.size(); ++i)
    table.rows.push_back({study.factors[i].key, percent(one.indices[i].first, one.indices[i].first_error),
                          percent(one.indices[i].total, one.indices[i].total_error)});
  return table;
}

/// Smallest, mean and largest of each result over the trusted rows.
report::GridTable range_table(const Definition& study, const Design& design, const Collected& collected) {
  report::GridTable table{"Results over the runs", {"", "rows", "smallest", "mean", "largest"}};
  for (std::size_t r = 0; r < study.results.size(); ++r) {
    const auto values = scatter(design, collected, 0, r).y;
    if (values.empty()) continue;
    double sum = 0.0;
    for (const double v : values) sum += v;
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    const std::string& name = study.results[r];
    table.rows.push_back({with_unit(words_of(name), unit_for_people(name)), fmt::format("{}", values.size()),
                          report::person_number(*low, name),
                          report::person_number(sum / static_cast<double>(values.size()), name),
                          report::person_number(*high, name)});
  }
  return table;
}

std::string rows_sentence(const Design& design, const Collected& collected) {
  std::size_t good = 0, doubtful = 0;
  const std::size_t moving = moving_rows(collected);
  for (const Row& row : collected.rows) good += row.exit_code == 0, doubtful += row.exit_code == 3;
  const std::string unfinished =
      moving == 0 ? ""
                  : fmt::format(
                        " In {} runs the concrete still moved when the time of the test was over "
                        "(test.duration): their results are of that moment, not of rest.",
                        moving);
  return fmt::format(
             "{} of {} runs can be trusted; {} are not to be trusted, {} failed, {} are missing (study.csv "
             "names them and says why). The error of cells and steps of a run is in none of the numbers.",
             good, design.size(), doubtful, collected.rows.size() - good - doubtful,
             collected.missing.size()) +
         unfinished;
}

}  // namespace

std::string study_html(const Definition& study, const Design& design, const Collected& collected,
                       const std::vector<ResultIndices>& indices, const std::string& note,
                       const std::vector<std::string>& reasons, const std::string& command) {
  report::Page page;
  std::vector<std::string> keys;
  for (const Factor& factor : study.factors) keys.push_back(factor.key);
  page.headline = fmt::format("{}: {} runs of {} over {}", study.name, design.size(),
                              study.base.filename().string(), fmt::join(keys, ", "));
  page.title = "Tremie: " + page.headline;
  page.trust = {reasons.empty(), rows_sentence(design, collected), reasons};
  for (const ResultIndices& one : indices) page.remarks.push_back(what_matters(study, one));
  if (!note.empty()) page.remarks.push_back(note);
  add_figures(study, design, collected, indices, page);
  for (const ResultIndices& one : indices) page.grids.push_back(index_table(study, one));
  if (auto ranges = range_table(study, design, collected); !ranges.rows.empty()) page.grids.push_back(ranges);
  page.words = {"First order: share of the variance removed, on average, by fixing the factor.",
                "Total: share that remains when all other factors are fixed; above first order where it "
                "interacts with others."};
  page.made = report::facts_of_this_run(command);
  page.scene = study.resolved_base, page.scene_words = "The base scene, every value in SI";
  return to_html(page);
}

}  // namespace tremie::study
