// The comparison as a page: curves over each other, then what differs.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "apparatus/registry/registry.hpp"
#include "apparatus/report/compare/comparison.hpp"
#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/report/run_files/glossary.hpp"

namespace tremie::report {
namespace {

/// Columns about the method rather than the concrete: in the files, not among the curves.
constexpr std::array<std::string_view, 9> about_the_method{
    "spread_max_point_mm", "time_step_s",     "iterations",        "volume_change",   "kinetic_energy_J",
    "max_speed_m_per_s",   "torque_wall_N_m", "momentum_rate_N_m", "torque_power_N_m"};

const FileColumns* find_table(const RunResult& run, const std::string& file) {
  if (file == run.series.file) return &run.series;
  const auto found =
      std::find_if(run.tables.begin(), run.tables.end(), [&](const auto& t) { return t.file == file; });
  return found == run.tables.end() ? nullptr : &*found;
}

/// Column `y` over column `x` of the file, a curve a run; nothing where no run has it.
void add_overlay(const Comparison& comparison, const std::string& file, const std::string& x,
                 const std::string& y, Page& page) {
  const std::string& apparatus = comparison.runs.front().apparatus;
  LineChart chart{.title = words_of(y, apparatus),
                  .x_label = with_unit(words_of(x, apparatus), unit_for_people(x)),
                  .y_label = with_unit(words_of(y, apparatus), unit_for_people(y))};
  for (const auto& run : comparison.runs) {
    Curve curve{.label = run.name};
    if (const auto* table = find_table(run, file))
      if (const auto* a = scene::find_column(table->columns, x), *b = scene::find_column(table->columns, y);
          a && b)
        curve.x = a->values, curve.y = b->values;
    chart.curves.push_back(std::move(curve));
  }
  const std::string stem = file.substr(0, file.find('.'));
  if (can_be_drawn(chart))
    page.figures.push_back({fmt::format("{}-{}-over-{}", stem, y, x), "", chart_svg(chart)});
}

/// The columns that any run has in the file, in order.
std::vector<std::string> columns_in(const Comparison& comparison, const std::string& file) {
  std::vector<std::string> names;
  for (const auto& run : comparison.runs)
    if (const auto* table = find_table(run, file))
      for (const auto& column : table->columns)
        if (std::find(names.begin(), names.end(), column.name) == names.end()) names.push_back(column.name);
  return names;
}

void add_curves(const Comparison& comparison, Page& page) {
  std::vector<std::string> files{"timeseries.csv"};
  for (const auto& run : comparison.runs)
    for (const auto& table : run.tables)
      if (std::find(files.begin(), files.end(), table.file) == files.end()) files.push_back(table.file);
  for (const auto& file : files) {
    const auto names = columns_in(comparison, file);
    for (std::size_t i = 1; i < names.size(); ++i)
      if (std::find(about_the_method.begin(), about_the_method.end(), names[i]) == about_the_method.end())
        add_overlay(comparison, file, names.front(), names[i], page);
  }
  // A law is looked at over the rate, which a time series of a material cell has.
  add_overlay(comparison, "timeseries.csv", "shear_rate_per_s", "shear_stress_Pa", page);
}

std::string cell_text(const ComparedRow& row, std::size_t i) {
  if (row.texts[i] == "true" || row.texts[i] == "false") return row.texts[i] == "true" ? "yes" : "no";
  if (!row.numbers[i]) return row.texts[i];
  const std::string text = person_number(*row.numbers[i], row.key);
  return row.errors[i] ? text + " ± " + person_number(*row.errors[i], row.key) : text;
}

std::string difference_text(const ComparedRow& row) {
  if (!row.differs) return "the same";
  if (!row.difference) return "";
  const std::string text = person_number(*row.difference, row.key);
  return row.error ? text + " ± " + person_number(*row.error, row.key) : text;
}

std::string heading(const std::string& key, const std::string& apparatus) {
  const std::string unit = unit_for_people(key);
  return unit.empty() ? words_of(key, apparatus) : words_of(key, apparatus) + ", " + unit;
}

GridTable scene_table(const Comparison& comparison) {
  GridTable table{"What differs in the scenes", {"key"}};
  for (const auto& run : comparison.runs) table.columns.push_back(run.name);
  for (const auto& row : comparison.scene) {
    if (!row.differs) continue;
    table.rows.push_back({row.key});
    table.rows.back().insert(table.rows.back().end(), row.texts.begin(), row.texts.end());
  }
  return table;
}

GridTable result_table(const Comparison& comparison) {
  GridTable table{"Results", {""}};
  for (const auto& run : comparison.runs) table.columns.push_back(run.name);
  table.columns.push_back(comparison.runs.size() == 2 ? "difference" : "largest difference");
  for (const auto& row : comparison.results) {
    table.rows.push_back({heading(row.key, comparison.runs.front().apparatus)});
    for (std::size_t i = 0; i < row.texts.size(); ++i) table.rows.back().push_back(cell_text(row, i));
    table.rows.back().push_back(difference_text(row));
  }
  return table;
}

Trust trust_of(const Comparison& comparison) {
  Trust trust{true, "", comparison_reasons(comparison)};
  trust.trusted = trust.reasons.empty();
  trust.text = error_sentence(comparison);
  return trust;
}

std::string programs_sentence(const Comparison& comparison) {
  std::vector<std::string> parts;
  bool same = true;
  for (const auto& run : comparison.runs) {
    parts.push_back(run.name + ": " + run.program);
    same = same && run.program == comparison.runs.front().program;
  }
  return same ? "" : fmt::format("The runs are by different programs ({}).", fmt::join(parts, "; "));
}

}  // namespace

std::string comparison_headline(const Comparison& comparison) {
  const std::string& name = comparison.runs.front().apparatus;
  std::vector<std::string> names;
  for (const auto& run : comparison.runs) names.push_back(run.name);
  std::string text = fmt::format("{} of {}", words_of(name), fmt::join(names, " | "));
  for (const auto& apparatus : scene::all_apparatus())
    if (apparatus.keys.name == name && !apparatus.headlines.empty()) {
      const auto& headline = apparatus.headlines.front();
      for (const auto& row : comparison.results) {
        if (row.key != headline.name) continue;
        std::vector<std::string> values;
        for (std::size_t i = 0; i < row.numbers.size(); ++i)
          values.push_back(row.numbers[i] ? fmt::format("{:.{}f}", *row.numbers[i], headline.digits) : "–");
        text += fmt::format(": {} {} {}", headline.word, fmt::join(values, " | "),
                            unit_for_people(headline.name));
      }
    }
  return text;
}

std::string comparison_html(const Comparison& comparison, const std::string& command) {
  Page page;
  page.headline = comparison_headline(comparison);
  page.title = "Tremie: " + page.headline;
  page.verdict.text = scene_sentence(comparison);
  page.trust = trust_of(comparison);
  if (const auto text = programs_sentence(comparison); !text.empty()) page.remarks.push_back(text);
  add_curves(comparison, page);
  if (const auto scenes = scene_table(comparison); !scenes.rows.empty()) page.grids.push_back(scenes);
  page.grids.push_back(result_table(comparison));
  page.words = {
      "λ, the flocculation state: 0 in concrete just sheared, growing at rest; the yield stress is "
      "(1 + λ) times the dynamic one.",
      "–: does not apply to this run."};
  page.made = facts_of_this_run(command);
  return to_html(page);
}

}  // namespace tremie::report
