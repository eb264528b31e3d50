#include "apparatus/report/html.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>

#include "apparatus/report/summary.hpp"
#include "tremie_version.hpp"

namespace tremie::report {
namespace {

constexpr const char* style =
    "body{font:16px/1.5 sans-serif;max-width:60em;margin:2em auto;padding:0 1em;color:#222}"
    "table{border-collapse:collapse}td{padding:.15em 1.5em .15em 0;border-bottom:1px solid #ddd}"
    "td+td{text-align:right;font-variant-numeric:tabular-nums}img,svg{max-width:100%;height:auto}"
    "pre{background:#f6f6f6;padding:1em;overflow:auto}.bad{color:#a00}";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '&')
      result += "&amp;";
    else if (c == '<')
      result += "&lt;";
    else if (c == '>')
      result += "&gt;";
    else
      result += c;
  }
  return result;
}

std::string file_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::string base64(const std::string& bytes) {
  static constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : letters[group >> (18 - 6 * k) & 63U];
  }
  return text;
}

std::string value_text(const scene::ResultValue& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.4g}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return escaped(*text);
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "yes" : "no";
  return "&ndash;";
}

std::string rows(const std::vector<scene::Result>& results, const std::string& prefix = "") {
  std::string text;
  for (const auto& [name, value] : results) {
    if (const auto* below = std::get_if<std::vector<scene::Result>>(&value))
      text += rows(*below, prefix + name + ".");
    else
      text += fmt::format("<tr><td>{}{}</td><td>{}</td></tr>\n", prefix, name, value_text(value));
  }
  return text;
}

std::string table(const char* heading, const std::vector<scene::Result>& results) {
  return fmt::format("<h2>{}</h2>\n<table>\n{}</table>\n", heading, rows(results));
}

std::vector<scene::Result> checks_of(const Checks& c) {
  return {{"volume_change", c.volume_change},
          {"mass_error", c.mass_error},
          {"unconverged_steps", static_cast<double>(c.unconverged_steps)},
          {"points_lost", static_cast<double>(c.points_lost)},
          {"max_speed_end_m_per_s", c.max_speed_end},
          {"stability_limit_exceeded", c.stability_limit_exceeded}};
}

std::vector<scene::Result> cost_of(const Cost& c) {
  return {{"wall_s", c.wall},
          {"cpu_s", c.cpu},
          {"steps", static_cast<double>(c.steps)},
          {"points", static_cast<double>(c.points)},
          {"simulated_s", c.simulated}};
}

std::string figures(const scene::Outcome& outcome, const std::filesystem::path& folder) {
  std::string text;
  for (const auto& chart : outcome.charts) {
    const std::string svg = file_text(folder / chart.file);
    const auto start = svg.find("<svg");  // without the XML header, which HTML has no place for
    if (start != std::string::npos) text += "<figure>" + svg.substr(start) + "</figure>\n";
  }
  const std::string png = file_text(folder / "shape.png");
  if (!png.empty())
    text += "<figure><img alt=\"final shape\" src=\"data:image/png;base64," + base64(png) + "\"></figure>\n";
  return text;
}

}  // namespace

std::string report_html(const scene::Outcome& outcome, const std::string& resolved,
                        const std::filesystem::path& folder) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Tremie: "
      "{0}</title><style>{1}</style></head>"
      "<body>\n<h1>{0}: {2}</h1>\n",
      outcome.apparatus, style, status_name(outcome.status));
  for (const auto& reason : outcome.checks.reasons)
    text += "<p class=\"bad\">Not to be trusted: " + escaped(reason) + "</p>\n";
  std::string lines;
  for (const auto& line : outcome.lines) lines += escaped(line) + "\n";
  text += "<pre>" + lines + "</pre>\n" + figures(outcome, folder);
  text += table("Results", outcome.results) + table("Checks", checks_of(outcome.checks)) +
          table("Cost", cost_of(outcome.cost));
  text += "<h2>Scene</h2>\n<pre>" + escaped(resolved) + "</pre>\n";
  return text + fmt::format("<p>Tremie {} ({}), {}</p>\n</body></html>\n", version, commit, compiler);
}

}  // namespace tremie::report
