#include "apparatus/cli/fit/fit_protocol.hpp"

#include <fmt/format.h>

#include "apparatus/cli/fit/fit_output.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "rheometer/fits/flow_law.hpp"

namespace tremie::cli {

namespace {

std::string number(const std::optional<double>& v, const char* unit) {
  return v ? fmt::format("{} {}", scene::rounded(*v, 4), unit) : "not told";
}

/// "tau_0 54 [53, 55] Pa; ", nothing where the section does not tell it.
std::string fitted(const FitResult& fit, const FitParameter& p) {
  const std::optional<Estimate> e = value_of(fit, p);
  if (!e || e->given) return {};
  const std::string interval =
      e->ci95 ? fmt::format(" [{}, {}]", scene::rounded(e->ci95->low, 3), scene::rounded(e->ci95->high, 3))
              : "";
  return fmt::format("{} {}{} {}; ", p.symbol, scene::rounded(e->value, 4), interval, unit_on_screen(p));
}

/// What a section says, in one line.
std::string summary_line(const SectionReading& s) {
  std::string text;
  if (s.start_up) {
    text =
        fmt::format("peak {:.4g} mN.m after {:.3g} s", 1e3 * s.start_up->peak_torque, s.start_up->peak_time);
    text += s.start_up->peak_inside
                ? fmt::format(", static yield stress {}, G {}", number(s.start_up->static_yield_stress, "Pa"),
                              number(s.start_up->shear_modulus, "Pa"))
                : ", no peak within the section";
  }
  if (s.decay) {
    text = fmt::format("{:.4g} to {:.4g} mN.m", 1e3 * s.decay->peak_torque, 1e3 * s.decay->end_torque);
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

}  // namespace

void print_protocol(const ProtocolReading& r) {
  fmt::print("{:>3} {:<16} {:>11} {:>9} {:>10} {:>8}  {}\n", "", "section", "lines", "from s", "rev/s",
             "rest s", "reading");
  for (std::size_t i = 0; i < r.sections.size(); ++i) {
    const SectionReading& s = r.sections[i];
    if (s.section.kind == SectionKind::rest && i + 1 < r.sections.size()) continue;  // named by what follows
    const std::string kind = std::string(name_of(s.section.kind)) + (s.section.pre_shear ? " *" : "");
    fmt::print("{:>3} {:<16} {:>11} {:>9.5g} {:>10.4g} {:>8}  {}\n", i + 1, kind,
               fmt::format("{}-{}", s.first_line, s.last_line), s.start, s.section.omega / two_pi,
               s.section.rest_before > 0.0 ? fmt::format("{:.4g}", s.section.rest_before) : "",
               summary_line(s));
    for (const auto& note : s.notes) fmt::print("{:<22} {}\n", "", note);
  }
  fmt::print("{:<22} the pre-shear, read as a decay too\n", "*");
  print_estimate("A_thix of the peaks", r.structuration.A_thix, "Pa/s");
  print_estimate("static, without rest", r.structuration.at_no_rest, "Pa");
  for (const auto& note : r.structuration.notes) fmt::print("{:<22} {}\n", "note", note);
}

std::string protocol_charts(const ProtocolRecord& record, const ProtocolReading& r) {
  std::string text;
  for (std::size_t i = 0; i < r.sections.size(); ++i) {
    const SectionReading& s = r.sections[i];
    if (s.section.kind == SectionKind::rest) continue;
    const bool curve =
        s.section.kind == SectionKind::flow_curve_up || s.section.kind == SectionKind::flow_curve_down;
    text += fmt::format(
        "reset\nset terminal svg size 720,440 dynamic background rgb 'white' font 'sans,14'\nset output "
        "'section_{}.svg'\nset grid linecolor rgb '#dddddd'\nset border 3\nset tics nomirror out\nset title "
        "'{} {}'\n"
        "set xlabel '{}'\nset ylabel 'torque in mN.m'\nset yrange [0:*]\n$data << EOD\n",
        i + 1, i + 1, name_of(s.section.kind), curve ? "speed in rev/s" : "time in s");
    const std::size_t every = 1 + (s.section.end - s.section.begin) / 600;
    for (std::size_t k = s.section.begin; k < s.section.end; k += every)
      text += fmt::format("{:.8g} {:.8g}\n", curve ? record.omega[k] / two_pi : record.time[k],
                          1e3 * record.torque[k]);
    text += "EOD\n";
    std::string fit_curve;
    if (s.fit) {
      text += "$fit << EOD\n";
      const double zero = curve ? 0.0 : record.time[s.section.begin] + s.fit_origin;
      for (std::size_t k = 0; k < s.fit->curve.x.size(); ++k)
        text += fmt::format("{:.8g} {:.8g}\n", curve ? s.fit->curve.x[k] / two_pi : zero + s.fit->curve.x[k],
                            1e3 * s.fit->curve.fitted[k]);
      text += "EOD\n";
      fit_curve = fmt::format(", $fit using 1:2 with lines linewidth 2 linecolor rgb '#0b5394' title '{}'",
                              s.fit->model);
    }
    text +=
        "plot $data using 1:2 with points pointtype 7 pointsize 0.5 linecolor rgb '#444444' title 'record'" +
        fit_curve + "\n";
  }
  return text;
}

}  // namespace tremie::cli
