#include "apparatus/verification/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/charts.hpp"
#include "apparatus/verification/references/study_output.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::verification {
namespace {

namespace fs = std::filesystem;

std::string stem_of(const Case& c) { return fmt::format("case_{}", c.number); }

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

std::string problem_section(const Problem& one) {
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

std::string csv_of(const Case& c) {
  std::string text = "case,scheme,resolution,h,error,cpu_s,note\n";
  for (const Problem& one : c.problems)
    for (const Series& s : one.series)
      for (const Run& run : s.runs)
        text += fmt::format("{},\"{}\",\"{}\",{:g},{:.6e},{:.6g},\"{}\"\n", one.name, s.scheme, run.label,
                            run.h, run.error, run.cpu, run.note);
  return text;
}

/// Error over CPU time, a chart a problem with two runs of some scheme.
std::vector<report::LineChart> charts_of(const Case& c) {
  std::vector<report::LineChart> charts;
  for (const Problem& one : c.problems) {
    if (std::none_of(one.series.begin(), one.series.end(), [](const Series& s) { return s.runs.size() > 1; }))
      continue;
    report::LineChart chart{
        .title = one.title, .x_label = "CPU time (s)", .y_label = "error", .log_x = true, .log_y = true};
    for (const Series& s : one.series) {
      report::Curve curve{.label = s.scheme, .mark = report::Mark::line_and_points};
      for (const Run& run : s.runs)
        if (run.error > 0.0) curve.x.push_back(std::max(run.cpu, 1e-9)), curve.y.push_back(run.error);
      if (!curve.x.empty()) chart.curves.push_back(std::move(curve));
    }
    charts.push_back(std::move(chart));
  }
  return charts;
}

std::string head(const std::vector<Case>& cases, const std::string& command) {
  std::string text = fmt::format(
      "# Verification: error against run time\n\ntremie {} ({}), {}, {}.\nMade by `{}`. CPU seconds are of "
      "one thread; other work on the machine may double them, so compare them within this file alone.\nThe "
      "order is the least-squares slope of log error over log cell size over all resolutions of the "
      "scheme.\n\n",
      version, commit, compiler, study::processor(), command);
  const auto broken = broken_bounds(cases);
  text += broken.empty() ? "Every bound is kept.\n" : "Bounds that are **not kept**:\n\n";
  for (const auto& line : broken) text += fmt::format("- {}\n", line);
  text += '\n';
  return text;
}

}  // namespace

std::vector<std::string> broken_bounds(const std::vector<Case>& cases) {
  std::vector<std::string> lines;
  const auto add = [&](const Case& c, const std::string& name, const std::vector<Bound>& bounds) {
    for (const Bound& b : bounds)
      if (!b.kept())
        lines.push_back(fmt::format("case {}, {}: {} {:.3g}, {} {:.3g} wanted", c.number, name, b.what,
                                    b.value, b.at_least ? "at least" : "at most", b.limit));
  };
  for (const Case& c : cases) {
    for (const Problem& one : c.problems) add(c, one.name, one.bounds);
    for (const Table& table : c.tables) add(c, table.name, table.bounds);
  }
  return lines;
}

void write_document(const std::vector<Case>& cases, const std::string& command, const fs::path& folder) {
  std::string text = head(cases, command);
  for (const Case& c : cases) {
    text += fmt::format("## Case {}. {}\n\n", c.number, c.title);
    if (const auto charts = charts_of(c); !charts.empty()) {
      text += fmt::format("![error over CPU time]({}.svg)\n\n", stem_of(c));
      io::write_text(folder / (stem_of(c) + ".svg"), report::svg_file(charts));
    }
    for (const Problem& one : c.problems) text += problem_section(one);
    for (const Table& table : c.tables) text += table_section(table);
    if (!c.problems.empty()) io::write_text(folder / (stem_of(c) + ".csv"), csv_of(c));
  }
  io::write_text(folder / "VERIFICATION.md", text);
}

}  // namespace tremie::verification
