#include "apparatus/report/protocol_results.hpp"

#include <fmt/format.h>

#include "apparatus/report/fit_results.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::report {
namespace {

using Json = nlohmann::ordered_json;

Json start_up_json(const StartUpReading& s, bool stress) {
  return {{stress ? "peak_shear_stress_Pa" : "peak_torque_N_m", s.peak_torque},
          {"peak_time_s", s.peak_time},
          {stress ? "peak_strain" : "peak_angle_rad",
           stress ? s.peak_angle / evenly_sheared_speed : s.peak_angle},
          {"peak_inside", s.peak_inside},
          {stress ? "end_shear_stress_Pa" : "end_torque_N_m", s.end_torque},
          {"static_yield_stress_Pa", json_of(s.static_yield_stress)},
          {"static_yield_stress_by_flow_curve_Pa", json_of(s.static_by_law)},
          {"shear_modulus_Pa", json_of(s.shear_modulus)}};
}

Json decay_json(const DecayShape& d, bool stress) {
  return {{stress ? "peak_shear_stress_Pa" : "peak_torque_N_m", d.peak_torque},
          {stress ? "end_shear_stress_Pa" : "end_torque_N_m", d.end_torque},
          {"half_time_s", json_of(d.half_time)},
          {"exponential_scatter", json_of(d.exponential_scatter)},
          {"power_scatter", json_of(d.power_scatter)},
          {"power_exponent", json_of(d.power_m)}};
}

Json section_json(const SectionReading& s, std::size_t number, bool stress) {
  Json j{{"number", number},
         {"kind", std::string(name_of(s.section.kind))},
         {"pre_shear", s.section.pre_shear},
         {"first_line", s.first_line},
         {"last_line", s.last_line},
         {"start_s", s.start},
         {"duration_s", s.duration},
         {shown_units(stress).speed_key, s.section.omega / shown_units(stress).speed},
         {"rest_before_s", s.section.rest_before > 0.0 ? Json(s.section.rest_before) : Json(nullptr)}};
  j["start_up"] = s.start_up ? start_up_json(*s.start_up, stress) : Json(nullptr);
  j["decay"] = s.decay ? decay_json(*s.decay, stress) : Json(nullptr);
  j[stress ? "loop_area_Pa_per_s" : "loop_area_W"] = json_of(s.loop_area);
  j["fit"] = s.fit ? fit_results(*s.fit) : Json(nullptr);
  j["notes"] = s.notes;
  j["reasons"] = s.reasons;
  return j;
}

Json saturation_json(const std::optional<Saturation>& s) {
  if (!s) return nullptr;
  return {{"static_yield_stress_end_Pa", s->end_stress},
          {"time_s", s->time},
          {"relative_scatter", s->scatter},
          {"chance_of_a_line", s->chance},
          {"longest_rest_by_the_shorter_Pa", json_of(s->forecast_of_longest)}};
}

Json models_json(const Breakdown& b) {
  Json models = Json::array();
  for (const Candidate& c : b.candidates)
    models.push_back({{"name", c.name},
                      {"parameters", c.parameters},
                      {"relative_scatter", c.scatter},
                      {"aicc_difference", json_of(c.difference)},
                      {"chosen", c.chosen}});
  return models;
}

Json breakdown_json(const Breakdown& b) {
  Json times = Json::array(), modes = Json::array();
  for (const BreakdownTime& t : b.times)
    times.push_back({{"section", t.section},
                     {"speed_rev_per_s", t.omega / two_pi},
                     {"shear_rate_per_s", t.rate},
                     {"half_time_s", t.half_time},
                     {"half_time_by_law_s", json_of(t.half_time_by_law)},
                     {"onset_s", t.onset},
                     {"breakdown_rate_per_s", json_of(t.breakdown_rate)},
                     {"relative_scatter", json_of(t.scatter)}});
  for (const BreakdownMode& mode : b.modes) modes.push_back({mode.share, mode.factor});
  return {{"half_times", times}, {"modes", modes}, {"models", models_json(b)}, {"choice", b.choice}};
}

Json forecasts_json(const std::vector<PeakForecast>& forecasts) {
  Json list = Json::array();
  for (const PeakForecast& f : forecasts)
    list.push_back(
        {{"rest_s", f.rest}, {"static_yield_stress_Pa", f.measured}, {"by_shorter_rests_Pa", f.forecast}});
  return list;
}

}  // namespace

Json protocol_results(const ProtocolReading& r) {
  Json j{{"kind", "protocol"}, {"sections", Json::array()}};
  j["flow_curve_section"] = r.flow_curve > 0 ? Json(r.flow_curve) : Json(nullptr);
  for (std::size_t i = 0; i < r.sections.size(); ++i)
    j["sections"].push_back(section_json(r.sections[i], i + 1, r.sheared_evenly));
  const Structuration& a = r.structuration;
  j["structuration_rate_Pa_per_s"] = json_of(a.A_thix);
  j["static_yield_stress_without_rest_Pa"] = json_of(a.at_no_rest);
  j["structuration"] = {{"rest_s", a.rest},
                        {"static_yield_stress_Pa", a.stress},
                        {"rate_by_flow_curve_Pa_per_s", json_of(a.A_thix_by_law)},
                        {"without_rest_by_flow_curve_Pa", json_of(a.at_no_rest_by_law)},
                        {"relative_scatter", json_of(a.scatter)},
                        {"saturation", saturation_json(a.saturation)},
                        {"forecasts", forecasts_json(a.forecasts)},
                        {"rate_short_rests_Pa_per_s", json_of(a.early)},
                        {"rate_long_rests_Pa_per_s", json_of(a.late)}};
  j["breakdown_rate_per_s"] = json_of(r.breakdown.rate);
  j["rate_exponent"] = json_of(r.breakdown.exponent);
  j["breakdown"] = breakdown_json(r.breakdown);
  j["notes"] = a.notes;
  for (const std::string& note : r.breakdown.notes) j["notes"].push_back(note);
  return j;
}

std::string protocol_csv(const ProtocolReading& r) {
  const ShownUnits shown = shown_units(r.sheared_evenly);
  std::string text =
      fmt::format("number,kind,first_line,last_line,start_s,duration_s,{},rest_before_s,peak_{},",
                  shown.speed_key, shown.torque_key);
  text += "static_yield_stress_Pa,shear_modulus_Pa,model,relative_scatter";
  for (const FitParameter& p : fit_parameters())
    text += fmt::format(",fit_{0},fit_{0}_low,fit_{0}_high", p.key);
  text += ",loop_area\n";
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
    text += fmt::format("{},{},{},{},{:.8g},{:.8g},{:.8g},{:.8g},{},{},{},{},{}", i + 1,
                        name_of(s.section.kind), s.first_line, s.last_line, s.start, s.duration,
                        s.section.omega / shown_units(r.sheared_evenly).speed, s.section.rest_before,
                        cell(peak), cell(stress), cell(modulus), s.fit ? s.fit->model : "", cell(scatter));
    for (const FitParameter& p : fit_parameters()) {
      const auto e = s.fit ? value_of(*s.fit, p) : std::nullopt;
      const bool interval = e && e->ci95;
      text += fmt::format(",{},{},{}", e ? cell(e->value) : "", interval ? cell(e->ci95->low) : "",
                          interval ? cell(e->ci95->high) : "");
    }
    text += fmt::format(",{}\n", cell(s.loop_area));
  }
  return text;
}

}  // namespace tremie::report
