#include "apparatus/report/run_files/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/report/page/page.hpp"
#include "apparatus/report/page/shapes.hpp"
#include "apparatus/report/run_files/chart.hpp"
#include "apparatus/report/run_files/glossary.hpp"
#include "apparatus/report/summary.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::report {
namespace {

std::optional<double> error_of(const scene::Outcome& o, const std::string& name) {
  if (o.error)
    for (const auto& bar : o.error->bars)
      if (bar.name == name) return bar.error;
  return std::nullopt;
}

std::string answer_text(const scene::Outcome& o, const scene::Answer& a) {
  const auto value = scene::find_number(o, a.name);
  if (!value) return {};
  std::string text = a.word.empty() ? "" : a.word + " ";
  text += fmt::format("{:.{}f}", *value, a.digits);
  if (const auto error = error_of(o, a.name)) text += fmt::format(" ± {:.{}f}", *error, a.digits);
  const std::string unit = unit_for_people(a.name);
  return unit.empty() ? text : text + " " + unit;
}

Verdict verdict_of(const scene::Outcome& o) {
  Verdict verdict;
  const auto line = measured_line(o);
  if (line.empty()) {
    verdict.text = o.judged;
    return verdict;
  }
  const auto& m = *o.measured;
  const bool beyond = std::abs(m.difference) > m.tolerance;
  // What still spreads can only grow: beyond the measured value it differs already.
  const bool final = !o.moving_at_end || m.difference > m.tolerance;
  if (final && m.on.empty()) verdict.kind = beyond ? VerdictKind::differs : VerdictKind::agrees;
  verdict.text = line + (o.judged.empty() ? "" : " " + o.judged);
  return verdict;
}

/// How the errors were found, with the results' keys in words.
std::string basis_in_words(const scene::ErrorEstimate& error, const std::string& apparatus) {
  std::string text = error.basis;
  for (const auto& bar : error.bars)
    if (const std::size_t at = text.find(bar.name + ":"); at != std::string::npos)
      text.replace(at, bar.name.size(), words_of(bar.name, apparatus));
  return text;
}

Trust trust_of(const scene::Outcome& o) {
  const Checks& c = o.checks;
  Trust trust{c.reasons.empty() && o.status == Status::completed, {}, c.reasons};
  if (o.error && !o.error->bars.empty())
    trust.text = fmt::format("The error of cells and steps is the ± above ({}). ",
                             basis_in_words(*o.error, o.apparatus));
  else if (o.has_points)
    trust.text =
        "The discretisation error (cells and time steps) was not estimated; --with-error estimates it. ";
  if (o.has_points)
    trust.text += fmt::format("The concrete's volume changed by {:+.2g} %; {}; {}.", 100.0 * c.volume_change,
                              c.unconverged_steps == 0 ? fmt::format("all {} steps converged", o.cost.steps)
                                                       : fmt::format("{} of {} steps did not converge",
                                                                     c.unconverged_steps, o.cost.steps),
                              c.points_lost == 0 ? std::string("no point was lost")
                                                 : fmt::format("{} points were lost", c.points_lost));
  if (o.status == Status::interrupted)
    trust.text +=
        fmt::format(" The run was interrupted at {:.2f} s: its numbers are those so far.", o.cost.simulated);
  else if (o.moving_at_end)
    trust.text += " The concrete still moved when the time of the test was over (test.duration).";
  return trust;
}

std::string value_text(const scene::ResultValue& value, const std::string& key) {
  if (const auto* number = std::get_if<double>(&value)) return person_number(*number, key);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* truth = std::get_if<bool>(&value)) return *truth ? "yes" : "no";
  return "–";
}

/// What stands in place of a result that is null.
std::string words_for_none(const scene::Outcome& o, const std::string& name) {
  for (const auto& [result, words] : o.none)
    if (result == name) return words;
  return "–";
}

void add_rows(const scene::Outcome& o, const std::vector<scene::Result>& results, const std::string& prefix,
              ValueTable& table) {
  for (const auto& [name, value] : results) {
    if (const auto* below = std::get_if<std::vector<scene::Result>>(&value)) {
      add_rows(o, *below, prefix + name + ".", table);
      continue;
    }
    if (name == "measured" && std::holds_alternative<std::monostate>(value)) continue;  // nothing was
    std::string text = prefix.empty() && std::holds_alternative<std::monostate>(value)
                           ? words_for_none(o, name)
                           : value_text(value, name);
    if (const auto error = error_of(o, name); error && prefix.empty())
      text += " ± " + scene::rounded(*error, 2);
    const bool number = std::holds_alternative<double>(value);
    table.rows.push_back(
        {words_of(prefix + name, o.apparatus), text, number ? unit_for_people(name) : "", prefix + name});
  }
}

ValueTable cost_table(const Cost& c) {
  return {"What it cost",
          {{"processor time", scene::rounded(c.cpu, 3), "s", "cpu_s"},
           {"by the clock", scene::rounded(c.wall, 3), "s", "wall_s"},
           {"steps", fmt::format("{}", c.steps), "", "steps"},
           {"points", fmt::format("{}", c.points), "", "points"},
           {"simulated", scene::rounded(c.simulated, 4), "s", "simulated_s"}}};
}

void add_shape(const scene::Outcome& o, const MovingPicture& moving, Page& page) {
  if (!o.stage || o.stage->full || moving.frames.empty()) return;
  Shape shape{.title = "Shape at the end",
              .point_size = o.stage->point_size,
              .walls = moving.fixed,
              .mirrored = moving.mirrored,
              .ring_diameter = o.stage->ring_diameter};
  // What is shown is thinned: a point stands for more than its own size, the more so the more were left out.
  const double left_out = static_cast<double>(o.cost.points) /
                          static_cast<double>(std::max<std::size_t>(moving.frames.back().places.size(), 1));
  shape.point_size *= std::sqrt(std::clamp(left_out, 1.0, 4.0));
  for (const auto& p : moving.frames.back().places) shape.places.push_back({p[0], p[1]});
  if (!o.stage->plan.empty()) shape.plan_diameter = 1e-3 * scene::find_number(o, o.stage->plan).value_or(0.0);
  page.figures.push_back({"shape", "The concrete at the end, from the computed points.", shape_svg(shape)});
}

/// What turns, as it stands in the last frame.
std::vector<Polyline> turned_at_the_end(const MovingPicture& moving) {
  std::vector<Polyline> solids = moving.turning;
  const double a = moving.frames.empty() ? 0.0 : moving.frames.back().turned, c = std::cos(a),
               s = std::sin(a);
  for (Polyline& body : solids)
    for (auto& p : body) p = {c * p[0] - s * p[1], s * p[0] + c * p[1]};
  return solids;
}

/// A shear rate over the radius as a section from above, where a table has one.
void add_disc(const scene::Outcome& o, const MovingPicture& moving, Page& page) {
  for (const auto& table : o.tables) {
    if (table.columns.empty() || table.columns.front().name != "radius_mm") continue;
    for (const auto& column : table.columns) {
      if (column.name != "shear_rate_per_s") continue;
      Disc disc{.title = "Section at the end", .words = "shear rate (1/s)", .values = column.values};
      for (const double r : table.columns.front().values) disc.radius.push_back(1e-3 * r);
      disc.solids = turned_at_the_end(moving);
      if (std::string svg = disc_svg(disc); !svg.empty())
        page.figures.push_back(
            {"section",
             moving.turning.empty()
                 ? "The concrete between vane and container, by its shear rate."
                 : "The concrete about the blades, by its shear rate; mean over the angle.",
             svg});
    }
  }
}

}  // namespace

std::string headline_of(const scene::Outcome& o) {
  std::string text;
  for (const auto& answer : o.answers)
    if (const std::string part = answer_text(o, answer); !part.empty())
      text += (text.empty() ? "" : ", ") + part;
  const std::string asked = o.asked.empty() ? o.apparatus : o.asked;
  const std::string so_far = o.status == Status::interrupted
                                 ? fmt::format(" so far, interrupted at {:.2f} s", o.cost.simulated)
                             : o.moving_at_end ? " and still moving"
                                               : "";
  return asked + ": " + (text.empty() ? status_name(o.status) : text + so_far);
}

std::string measured_line(const scene::Outcome& o) {
  if (!o.measured || !std::isfinite(o.measured->difference)) return {};
  const auto& m = *o.measured;
  const std::string measured = fmt::format("the measured {:.4g} ± {:.3g} {}", m.value, m.tolerance, m.unit);
  const std::string off =
      fmt::format("{:.3g} {} {}", std::abs(m.difference), m.unit, m.difference < 0.0 ? "below" : "above");
  if (!m.on.empty()) return fmt::format("Not measured on this concrete; {} {} of {}.", off, measured, m.on);
  if (o.moving_at_end && m.difference <= m.tolerance)
    return fmt::format("Still moving{}, so no verdict; so far {} {}.",
                       o.status == Status::interrupted ? "" : " at the end", off, measured);
  if (std::abs(m.difference) <= m.tolerance) return fmt::format("Agrees with {}: {}.", measured, off);
  return m.tolerance > 0.0 ? fmt::format("Differs from {}: {}, {:.1f} times the tolerance.", measured, off,
                                         std::abs(m.difference) / m.tolerance)
                           : fmt::format("Differs from {}: {}.", measured, off);
}

std::string report_html(const scene::Outcome& o, const std::string& resolved, const MovingPicture& moving,
                        const std::string& command) {
  Page page;
  page.headline = headline_of(o);
  page.title = "Tremie: " + page.headline;
  page.verdict = verdict_of(o);
  page.trust = trust_of(o);
  page.remarks = o.remarks;
  add_shape(o, moving, page);
  if (!o.stage || o.stage->full) add_disc(o, moving, page);
  for (const auto& chart : o.charts)
    if (const LineChart drawn = line_chart(chart, o); can_be_drawn(drawn))
      page.figures.push_back({chart.file.substr(0, chart.file.find('.')), "", chart_svg(drawn)});
  if (moving.frames.size() > 1) page.moving = thinned(moving, 40, 2500);
  ValueTable results{"Results"};
  add_rows(o, o.results, "", results);
  page.numbers = {results, cost_table(o.cost)};
  page.words = {
      "λ, the flocculation state: 0 in concrete just sheared, growing at rest; the yield stress is (1 + λ) "
      "times the dynamic one.",
      "–: does not apply to this run."};
  page.made = facts_of_this_run(command);
  page.scene = resolved;
  return to_html(page);
}

}  // namespace tremie::report
