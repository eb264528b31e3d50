#include "apparatus/verification/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apparatus/report/process.hpp"
#include "apparatus/verification/references/study_output.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::verification {
namespace {

namespace fs = std::filesystem;

std::string stem_of(const CaseGroup& group) { return fmt::format("rung_{}", group.number); }

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.2e}", value) : "—"; }

std::string order_of(const Series& series) {
  const double order = observed_order(series);
  return std::isfinite(order) ? fmt::format("{:.2f}", order) : "—";
}

std::string bounds_table(const std::vector<Bound>& bounds) {
  if (bounds.empty()) return "No bound.\n\n";
  std::string text = "| bound | measured | limit | |\n|---|---|---|---|\n";
  for (const Bound& b : bounds)
    text += fmt::format("| {} | {:.3g} | {} {:.3g} | {} |\n", b.what, b.value, b.at_least ? "≥" : "≤",
                        b.limit, b.kept() ? "kept" : "**broken**");
  return text + "\n";
}

std::string case_section(const Case& one) {
  std::string text = fmt::format("### {}\n\n{}. Reference: {}. Error: {}.\n\n", one.title, one.equation,
                                 one.reference, one.norm);
  text += "| scheme | resolution | error | CPU s | order | |\n|---|---|---|---|---|---|\n";
  for (const Series& s : one.series)
    for (std::size_t i = 0; i < s.runs.size(); ++i) {
      const Run& run = s.runs[i];
      text += fmt::format("| {} | {} | {} | {:.3g} | {} | {} |\n", s.scheme, run.label, number(run.error),
                          run.cpu, i + 1 == s.runs.size() ? order_of(s) : "", run.note);
    }
  text += fmt::format("\n{}", bounds_table(one.bounds));
  for (const std::string& note : one.notes) text += fmt::format("{}\n\n", note);
  return text;
}

std::string table_section(const Table& table) {
  std::string text = fmt::format("### {}\n\n{}\n\n|", table.name, table.text), rule = "|";
  for (const auto& column : table.columns) text += fmt::format(" {} |", column), rule += "---|";
  text += fmt::format("\n{}\n", rule);
  for (const auto& row : table.rows) {
    text += "|";
    for (const auto& field : row) text += fmt::format(" {} |", field);
    text += "\n";
  }
  return text + "\n" + bounds_table(table.bounds);
}

/// Whether the chart has anything to show: two runs of some series.
bool can_be_drawn(const CaseGroup& group) {
  for (const Case& one : group.cases)
    for (const Series& s : one.series)
      if (s.runs.size() > 1) return true;
  return false;
}

std::string csv_of(const CaseGroup& group) {
  std::string text = "case,scheme,resolution,h,error,cpu_s,note\n";
  for (const Case& one : group.cases)
    for (const Series& s : one.series)
      for (const Run& run : s.runs)
        text += fmt::format("{},\"{}\",\"{}\",{:g},{:.6e},{:.6g},\"{}\"\n", one.name, s.scheme, run.label,
                            run.h, run.error, run.cpu, run.note);
  return text;
}

/// A gnuplot string in single quotes, taken as it is.
std::string quoted(const std::string& text) {
  std::string result;
  for (const char c : text) result.append(c == '\'' ? 2 : 1, c);
  return fmt::format("'{}' noenhanced", result);
}

std::string chart_of(const CaseGroup& group) {
  std::vector<const Case*> drawn;
  for (const Case& one : group.cases)
    if (std::any_of(one.series.begin(), one.series.end(), [](const Series& s) { return s.runs.size() > 1; }))
      drawn.push_back(&one);
  const std::size_t columns = std::min<std::size_t>(2, drawn.size()), rows = (drawn.size() + 1) / 2;
  std::string text = fmt::format(
      "set terminal svg size {},{} font 'sans,13' background rgb 'white'\nset output '{}.svg'\n"
      "set logscale xy\nset format x '10^{{%L}}'\nset format y '10^{{%L}}'\nset grid linecolor rgb "
      "'#dddddd'\n"
      "set xlabel 'CPU time in s'\nset key outside bottom center horizontal\nset multiplot layout {},{}\n",
      620 * columns, 460 * rows, stem_of(group), rows, columns);
  constexpr std::array colours{"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
  for (const Case* one : drawn) {
    std::string plots;
    for (std::size_t i = 0; i < one->series.size(); ++i) {
      text += fmt::format("$d{} << EOD\n", i);
      for (const Run& run : one->series[i].runs)
        if (run.error > 0.0) text += fmt::format("{:.6g} {:.6g}\n", std::max(run.cpu, 1e-9), run.error);
      text += "EOD\n";
      if (std::none_of(one->series[i].runs.begin(), one->series[i].runs.end(),
                       [](const Run& run) { return run.error > 0.0; }))
        continue;
      plots += fmt::format(
          "{}$d{} using 1:2 with linespoints linewidth 2 pointtype 7 linecolor rgb '{}' title {}",
          plots.empty() ? "" : ", ", i, colours[i % colours.size()], quoted(one->series[i].scheme));
    }
    text += fmt::format("set title {}\nset ylabel 'error'\nplot {}\n", quoted(one->title), plots);
  }
  return text + "unset multiplot\n";
}

std::string draw(const std::vector<CaseGroup>& groups, const fs::path& folder) {
  std::string script;
  for (const CaseGroup& group : groups)
    if (can_be_drawn(group)) script += chart_of(group) + "reset\n";
  if (script.empty()) return {};
  const auto gnuplot = report::find_program("gnuplot");
  if (gnuplot.empty()) return "gnuplot is not installed: no charts";
  const fs::path file = folder / ".charts.gp";
  io::write_text(file, script);
  const auto code = report::run_program(gnuplot, {file.filename().string()}, folder);
  fs::remove(file);
  return code == 0 ? "" : "gnuplot failed: charts are missing or not complete";
}

std::string head(const std::vector<CaseGroup>& groups, const std::string& command) {
  std::string text = fmt::format(
      "# Verification: error against run time\n\ntremie {} ({}), {}, {}.\nMade by `{}`. CPU seconds are of "
      "one "
      "thread; "
      "other work on the machine may double them, so compare them within this file alone.\nThe order is the "
      "least-squares slope of log error "
      "over "
      "log "
      "cell size over all resolutions of the scheme.\n\n",
      version, commit, compiler, study::processor(), command);
  const auto broken = broken_bounds(groups);
  text += broken.empty() ? "Every bound is kept.\n" : "Bounds that are **not kept**:\n\n";
  for (const auto& line : broken) text += fmt::format("- {}\n", line);
  text += '\n';
  return text;
}

}  // namespace

std::vector<std::string> broken_bounds(const std::vector<CaseGroup>& groups) {
  std::vector<std::string> lines;
  const auto add = [&](const CaseGroup& group, const std::string& name, const std::vector<Bound>& bounds) {
    for (const Bound& b : bounds)
      if (!b.kept())
        lines.push_back(fmt::format("rung {}, {}: {} {:.3g}, {} {:.3g} wanted", group.number, name, b.what,
                                    b.value, b.at_least ? "at least" : "at most", b.limit));
  };
  for (const CaseGroup& group : groups) {
    for (const Case& one : group.cases) add(group, one.name, one.bounds);
    for (const Table& table : group.tables) add(group, table.name, table.bounds);
  }
  return lines;
}

std::string write_document(const std::vector<CaseGroup>& groups, const std::string& command,
                           const fs::path& folder) {
  std::string text = head(groups, command);
  for (const CaseGroup& group : groups) {
    text += fmt::format("## Rung {}. {}\n\n", group.number, group.title);
    if (can_be_drawn(group)) text += fmt::format("![error over CPU time]({}.svg)\n\n", stem_of(group));
    for (const Case& one : group.cases) text += case_section(one);
    for (const Table& table : group.tables) text += table_section(table);
    if (!group.cases.empty()) io::write_text(folder / (stem_of(group) + ".csv"), csv_of(group));
  }
  io::write_text(folder / "VERIFICATION.md", text);
  return draw(groups, folder);
}

}  // namespace tremie::verification
