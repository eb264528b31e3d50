#include "apparatus/cli/fit/fit_protocol.hpp"

#include <fmt/format.h>

#include "apparatus/cli/fit/fit_output.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/scene/units.hpp"
#include "rheometer/fits/flow_law.hpp"

namespace tremie::cli {

namespace {

std::string number(const std::optional<double>& v, const char* unit) {
  return v ? fmt::format("{} {}", scene::rounded(*v, 4), unit) : "not identifiable";
}

/// "tau_0 54 [53, 55] Pa; ", nothing where the section does not tell it.
std::string fitted(const FitResult& fit, const FitParameter& p) {
  const std::optional<ParameterEstimate> e = value_of(fit, p);
  if (!e || e->given) return {};
  const std::string interval =
      e->ci95 ? fmt::format(" [{}, {}]", scene::rounded(e->ci95->low, 3), scene::rounded(e->ci95->high, 3))
              : "";
  return fmt::format("{} {}{} {}; ", p.symbol, scene::rounded(e->value, 4), interval, unit_on_screen(p));
}

/// What a section says, in one line.
std::string summary_line(const SectionReading& s, bool stress) {
  const double scale = stress ? 1.0 : 1e3;
  const char* unit = stress ? "Pa" : "mN.m";
  std::string text;
  if (s.start_up) {
    text = fmt::format("peak {:.4g} {} after {:.3g} s", scale * s.start_up->peak_torque, unit,
                       s.start_up->peak_time);
    text += s.start_up->peak_inside
                ? fmt::format(", static yield stress {}, G {}", number(s.start_up->static_yield_stress, "Pa"),
                              number(s.start_up->shear_modulus, "Pa"))
                : ", no peak within the section";
    if (s.start_up->static_by_law)
      text += fmt::format(", {} without its viscous part", number(s.start_up->static_by_law, "Pa"));
  }
  if (s.decay) {
    text =
        fmt::format("{:.4g} to {:.4g} {}", scale * s.decay->peak_torque, scale * s.decay->end_torque, unit);
    if (s.decay->half_time) text += fmt::format(", half after {:.3g} s", *s.decay->half_time);
    if (s.decay->exponential_scatter && s.decay->power_scatter)
      text += fmt::format(", exponential {:.2g} %, power of time {:.2g} %",
                          100.0 * *s.decay->exponential_scatter, 100.0 * *s.decay->power_scatter);
    text += "; ";
  }
  if (!s.fit) return text;
  const FitResult& f = *s.fit;
  text += fmt::format("{} {}, scatter {:.2g} %; ", f.model, f.reasons.empty() ? "fits" : "does not fit",
                      100.0 * f.scatter);
  for (const FitParameter& p : parameters_of(f))
    if (p.member != &FitResult::lambda_0 && p.member != &FitResult::A_thix) text += fitted(f, p);
  return text.substr(0, text.size() - 2);
}

void print_fall(const BreakdownTime& t) {
  std::string text = fmt::format("section {}, {:.3g} 1/s: half of the excess lost after {:.3g} s", t.section,
                                 t.rate, t.half_time);
  if (t.half_time_by_law) text += fmt::format(", {:.3g} s by k and a", *t.half_time_by_law);
  if (t.scatter) text += fmt::format("; scatter {:.2g} %", 100.0 * *t.scatter);
  say("{:<22} {}\n", "", text);
}

void print_modes(const Breakdown& b) {
  if (b.modes.empty()) return;
  std::string text;
  for (const BreakdownMode& mode : b.modes)
    text += fmt::format("{}[{:.3g}, {:.3g}]", text.empty() ? "" : ", ", mode.share, mode.factor);
  say("{:<22} [{}]\n", "modes (share, factor)", text);
}

}  // namespace

void print_protocol(const ProtocolReading& r) {
  const ShownUnits shown = shown_units(r.sheared_evenly);
  say("{:>3} {:<16} {:>11} {:>9} {:>10} {:>8}  {}\n", "", "section", "lines", "from s", shown.speed_unit,
      "rest s", "reading");
  for (std::size_t i = 0; i < r.sections.size(); ++i) {
    const SectionReading& s = r.sections[i];
    if (s.section.kind == SectionKind::rest && i + 1 < r.sections.size()) continue;  // named by what follows
    const std::string kind = std::string(name_of(s.section.kind)) + (s.section.pre_shear ? " *" : "");
    say("{:>3} {:<16} {:>11} {:>9.5g} {:>10.4g} {:>8}  {}\n", i + 1, kind,
        fmt::format("{}-{}", s.first_line, s.last_line), s.start, s.section.omega / shown.speed,
        s.section.rest_before > 0.0 ? fmt::format("{:.4g}", s.section.rest_before) : "",
        summary_line(s, r.sheared_evenly));
    for (const auto& note : s.notes) say("{:<22} {}\n", "", note);
  }
  say("{:<22} the pre-shear, read as a decay too\n", "*");
  print_estimate("A_thix of the peaks", r.structuration.A_thix, "Pa/s");
  print_estimate("static, without rest", r.structuration.at_no_rest, "Pa");
  if (r.structuration.A_thix_by_law) {
    print_estimate("A_thix by flow curve", r.structuration.A_thix_by_law, "Pa/s");
    print_estimate("static, without rest", r.structuration.at_no_rest_by_law, "Pa");
  }
  if (const auto& s = r.structuration.saturation)
    say("{:<22} {:.4g} Pa less what is left of it after {:.3g} s ({:.2g} % scatter; the line has {:.2g} %)\n",
        "static, saturating", s->end_stress, s->time, 100.0 * s->scatter,
        100.0 * r.structuration.scatter.value_or(0.0));
  print_estimate("breakdown rate k", r.breakdown.rate, "1/s");
  print_estimate("rate exponent a", r.breakdown.exponent, "");
  for (const BreakdownTime& t : r.breakdown.times) print_fall(t);
  print_modes(r.breakdown);
  for (const Candidate& c : r.breakdown.candidates)
    say("{:<22} {}: {} parameters, scatter {:.2g} %, AICc {:+.1f}\n", "", c.name, c.parameters,
        100.0 * c.scatter, c.difference.value_or(0.0));
  for (const auto& note : r.breakdown.notes) say("{:<22} {}\n", "note", note);
  for (const auto& note : r.structuration.notes) say("{:<22} {}\n", "note", note);
}

}  // namespace tremie::cli
