#include "apparatus/cli/fit/fit_protocol.hpp"

#include <fmt/format.h>

#include <numbers>

#include "apparatus/cli/fit/fit_output.hpp"
#include "apparatus/scene/units.hpp"

namespace tremie::cli {

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

Json start_up_json(const StartUpReading& s) {
  return {{"peak_torque_N_m", s.peak_torque},
          {"peak_time_s", s.peak_time},
          {"peak_inside", s.peak_inside},
          {"end_torque_N_m", s.end_torque},
          {"static_yield_stress_Pa", json_of(s.static_yield_stress)},
          {"shear_modulus_Pa", json_of(s.shear_modulus)}};
}

Json decay_json(const DecayShape& d) {
  return {
      {"peak_torque_N_m", d.peak_torque},          {"end_torque_N_m", d.end_torque},
      {"half_time_s", json_of(d.half_time)},       {"exponential_scatter", json_of(d.exponential_scatter)},
      {"power_scatter", json_of(d.power_scatter)}, {"power_exponent", json_of(d.power_m)}};
}

Json section_json(const SectionReading& s, std::size_t number) {
  Json j{{"number", number},
         {"kind", std::string(name_of(s.section.kind))},
         {"pre_shear", s.section.pre_shear},
         {"first_line", s.first_line},
         {"last_line", s.last_line},
         {"start_s", s.start},
         {"duration_s", s.duration},
         {"speed_rev_per_s", s.section.omega / two_pi},
         {"rest_before_s", s.section.rest_before > 0.0 ? Json(s.section.rest_before) : Json(nullptr)}};
  j["start_up"] = s.start_up ? start_up_json(*s.start_up) : Json(nullptr);
  j["decay"] = s.decay ? decay_json(*s.decay) : Json(nullptr);
  j["fit"] = s.fit ? report::fit_results(*s.fit) : Json(nullptr);
  j["notes"] = s.notes;
  j["reasons"] = s.reasons;
  return j;
}

std::string number(const std::optional<double>& v, const char* unit) {
  return v ? fmt::format("{} {}", scene::rounded(*v, 4), unit) : "not told";
}

std::string told(const std::optional<Estimate>& e, const char* name, const char* unit) {
  if (!e || e->given) return {};
  const std::string interval =
      e->ci95 ? fmt::format(" [{}, {}]", scene::rounded(e->ci95->low, 3), scene::rounded(e->ci95->high, 3))
              : "";
  return fmt::format("{} {}{} {}; ", name, scene::rounded(e->value, 4), interval, unit);
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
  text += told(f.tau_0, "tau_0", "Pa") + told(f.mu, "mu", "Pa.s") + told(f.consistency, "k", "Pa.s^n") +
          told(f.flow_index, "n", "") + told(f.static_yield_stress, "static", "Pa") +
          told(f.alpha, "alpha", "");
  return text.substr(0, text.size() - 2);
}

}  // namespace

nlohmann::ordered_json protocol_json(const ProtocolReading& r) {
  Json j{{"kind", "protocol"}, {"sections", Json::array()}};
  for (std::size_t i = 0; i < r.sections.size(); ++i)
    j["sections"].push_back(section_json(r.sections[i], i + 1));
  const Structuration& a = r.structuration;
  j["structuration_rate_Pa_per_s"] = json_of(a.A_thix);
  j["static_yield_stress_without_rest_Pa"] = json_of(a.at_no_rest);
  j["structuration"] = {{"rest_s", a.rest},
                        {"static_yield_stress_Pa", a.stress},
                        {"relative_scatter", json_of(a.scatter)},
                        {"rate_short_rests_Pa_per_s", json_of(a.early)},
                        {"rate_long_rests_Pa_per_s", json_of(a.late)}};
  j["notes"] = a.notes;
  return j;
}

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

std::string protocol_csv(const ProtocolReading& r) {
  std::string text =
      "number,kind,first_line,last_line,start_s,duration_s,speed_rev_per_s,rest_before_s,peak_torque_N_m,"
      "static_yield_stress_Pa,shear_modulus_Pa,model,relative_scatter\n";
  const auto cell = [](const std::optional<double>& v) {
    return v ? fmt::format("{:.8g}", *v) : std::string{};
  };
  for (std::size_t i = 0; i < r.sections.size(); ++i) {
    const SectionReading& s = r.sections[i];
    std::optional<double> peak, stress, modulus, scatter;
    if (s.start_up)
      peak = s.start_up->peak_torque, stress = s.start_up->static_yield_stress,
      modulus = s.start_up->shear_modulus;
    if (s.decay) peak = s.decay->peak_torque;
    if (s.fit) scatter = s.fit->scatter;
    text += fmt::format("{},{},{},{},{:.8g},{:.8g},{:.8g},{:.8g},{},{},{},{},{}\n", i + 1,
                        name_of(s.section.kind), s.first_line, s.last_line, s.start, s.duration,
                        s.section.omega / two_pi, s.section.rest_before, cell(peak), cell(stress),
                        cell(modulus), s.fit ? s.fit->model : "", cell(scatter));
  }
  return text;
}

}  // namespace tremie::cli
