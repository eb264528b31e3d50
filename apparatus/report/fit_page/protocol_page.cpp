#include "apparatus/report/fit_page/protocol_page.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "apparatus/report/fit_page/fit_page.hpp"
#include "apparatus/report/page/charts.hpp"
#include "apparatus/report/page/page.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::report {
namespace {

std::string text_of(const std::optional<double>& v) { return v ? scene::rounded(*v, 4) : "–"; }

bool is_curve(const SectionReading& s) {
  return s.section.kind == SectionKind::flow_curve_up || s.section.kind == SectionKind::flow_curve_down;
}

/// Torque of a section, thinned to some hundreds of readings, and the line of its fit; none of a rest.
LineChart section_chart(const ProtocolRecord& record, const SectionReading& s, std::size_t number) {
  if (s.section.kind == SectionKind::rest) return {};
  const ShownUnits shown = shown_units(record.sheared_evenly);
  const double torque = record.sheared_evenly ? 1.0 : 1e3;
  LineChart chart{.title = fmt::format("Section {}: {}", number, name_of(s.section.kind)),
                  .x_label = is_curve(s) ? shown.speed_label : "time in the section (s)",
                  .y_label = record.sheared_evenly ? shown.torque_label : "torque (mN·m)",
                  .curves = {}};
  Curve readings{.label = "readings", .x = {}, .y = {}, .mark = Mark::points};
  const double start = record.time[s.section.begin];
  for (std::size_t k = s.section.begin; k < s.section.end; k += 1 + (s.section.end - s.section.begin) / 300) {
    readings.x.push_back(is_curve(s) ? record.omega[k] / shown.speed : record.time[k] - start);
    readings.y.push_back(torque * record.torque[k]);
  }
  chart.curves = {readings};
  if (s.fit) {
    Curve line{.label = s.fit->model + (s.fit->reasons.empty() ? "" : " (does not fit)"),
               .x = s.fit->curve.x,
               .y = s.fit->curve.fitted};
    for (double& x : line.x) x = is_curve(s) ? x / shown.speed : x + s.fit_origin;
    for (double& y : line.y) y *= torque;
    chart.curves.push_back(line);
  }
  return chart;
}

void add_peaks(const Structuration& a, Page& page) {
  LineChart chart{.title = "Static yield stress after rest",
                  .x_label = "rest (s)",
                  .y_label = "static yield stress (Pa)",
                  .curves = {{"peaks of the start-ups", a.rest, a.stress, Mark::points}}};
  if (a.A_thix && a.at_no_rest && a.rest.size() > 1) {
    const double first = a.rest.front(), last = a.rest.back(), rate = a.A_thix->value;
    chart.curves.push_back({fmt::format("line of {:.3g} Pa/s", rate),
                            {first, last},
                            {a.at_no_rest->value + rate * first, a.at_no_rest->value + rate * last}});
  }
  if (can_be_drawn(chart)) page.figures.push_back({"peaks", "", chart_svg(chart)});
}

/// "yield stress 54 (53.2 to 55) Pa, plastic viscosity 35.8 (35 to 36.6) Pa·s"; of what the record tells.
std::string parameters_text(const FitResult& fit) {
  std::string text;
  for (const FitParameter& p : parameters_of(fit))
    if (const auto e = value_of(fit, p); e && !e->given)
      text +=
          fmt::format("{}{} {} {}", text.empty() ? "" : ", ", p.words, with_interval(*e, 3), unit_on_page(p));
  return text.empty() ? "–" : text;
}

std::vector<std::string> row(const SectionReading& s, std::size_t number, bool sheared_evenly) {
  const double torque = sheared_evenly ? 1.0 : 1e3;
  std::optional<double> peak, stress, modulus;
  if (s.start_up)
    peak = torque * s.start_up->peak_torque, stress = s.start_up->static_yield_stress,
    modulus = s.start_up->shear_modulus;
  if (s.decay) peak = torque * s.decay->peak_torque;
  return {std::to_string(number),
          std::string(name_of(s.section.kind)),
          fmt::format("{:.4g}", s.section.omega / shown_units(sheared_evenly).speed),
          s.section.rest_before > 0.0 ? fmt::format("{:.4g}", s.section.rest_before) : "–",
          text_of(peak),
          text_of(stress),
          text_of(modulus),
          s.fit ? fmt::format("{}, {:.2g} %", s.fit->model, 100.0 * s.fit->scatter) : "–",
          s.fit ? parameters_text(*s.fit) : "–"};
}

}  // namespace

std::string protocol_html(const ProtocolRecord& record, const ProtocolReading& reading,
                          const std::string& file, const std::string& command) {
  Page page;
  const Structuration& a = reading.structuration;
  page.headline =
      fmt::format("{}, a test of {} sections: {}", std::filesystem::path(file).filename().string(),
                  reading.sections.size(),
                  a.A_thix ? "A_thix " + with_interval(*a.A_thix, 3) + " Pa/s" : "tells no A_thix");
  page.title = "Tremie: " + page.headline;
  const bool good = reading.reasons.empty();
  page.verdict = {
      good ? VerdictKind::agrees : VerdictKind::differs,
      good ? "Each section is described by its model."
           : "A section is not described by any of the models; what it would have told is left out."};
  page.trust = {good, "Intervals hold 95 %.", reading.reasons};
  add_peaks(a, page);
  for (std::size_t i = 0; i < reading.sections.size(); ++i)
    if (const auto chart = section_chart(record, reading.sections[i], i + 1); can_be_drawn(chart))
      page.figures.push_back({fmt::format("section_{}", i + 1), "", chart_svg(chart)});
  GridTable table{"Sections",
                  {"", "kind", shown_units(record.sheared_evenly).speed_label, "rest before (s)",
                   record.sheared_evenly ? "peak (Pa)" : "peak (mN·m)", "static yield stress (Pa)",
                   "shear modulus (Pa)", "model, scatter", "parameters"},
                  {}};
  for (std::size_t i = 0; i < reading.sections.size(); ++i)
    if (reading.sections[i].section.kind != SectionKind::rest)
      table.rows.push_back(row(reading.sections[i], i + 1, record.sheared_evenly));
  page.grids = {table};
  page.remarks = a.notes;
  for (std::size_t i = 0; i < reading.sections.size(); ++i)
    for (const std::string& note : reading.sections[i].notes)
      page.remarks.push_back(fmt::format("Section {}: {}", i + 1, note));
  for (const auto& note : record.understood) page.remarks.push_back("Read: " + note);
  page.words = {"Static yield stress: of the peak of a start-up, over the vane's side.",
                "A_thix: how fast rest builds the yield stress up."};
  page.made = facts_of_this_run(command);
  return to_html(page);
}

std::vector<std::pair<std::string, std::string>> protocol_chart_files(const ProtocolRecord& record,
                                                                      const ProtocolReading& reading) {
  std::vector<std::pair<std::string, std::string>> files;
  for (std::size_t i = 0; i < reading.sections.size(); ++i)
    if (const auto chart = section_chart(record, reading.sections[i], i + 1); can_be_drawn(chart))
      files.emplace_back(fmt::format("section_{}.svg", i + 1), svg_file({chart}));
  return files;
}

}  // namespace tremie::report
