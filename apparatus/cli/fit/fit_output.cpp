#include "apparatus/cli/fit/fit_output.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

namespace tremie::cli {

Json json_of(const std::optional<Estimate>& e) {
  if (!e) return nullptr;
  Json json{{"value", e->value}, {"ci95", nullptr}};
  if (e->ci95) json["ci95"] = {e->ci95->low, e->ci95->high};
  if (e->given) json["given"] = true;
  return json;
}

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

Json apparent_json(const FitResult& r) {
  if (!r.apparent) return nullptr;
  const ApparentReading& a = *r.apparent;
  Json json{{"offset_torque_N_m", a.offset_torque},
            {"offset", a.offset},
            {"method", "least squares in ln(lambda)"},
            {"shear_rate_newtonian_per_s", a.newtonian_rate},
            {"shear_rate_at_vane_per_s", json_of(a.rate_at_vane)}};
  for (const ApparentAlpha& w : a.windows)
    json["windows"].push_back({{"window_s", w.window},
                               {"coefficient_per_s", w.coefficient},
                               {"alpha_newtonian_rate", w.alpha_newtonian_rate},
                               {"alpha_rate_at_vane", json_of(w.alpha_rate_at_vane)}});
  return json;
}

Json dropped_json(const FitResult& r) {
  Json list = Json::array();
  const bool decay = r.kind == RecordKind::torque_decay;
  for (const DroppedPoint& p : r.dropped)
    list.push_back({{"line", p.line},
                    {decay ? "time_s" : "speed_rev_per_s", decay ? p.x : p.x / two_pi},
                    {"torque_N_m", p.torque},
                    {"reason", p.reason}});
  return list;
}

Json candidates_json(const FitResult& r) {
  Json list = Json::array();
  for (const Candidate& c : r.candidates)
    list.push_back({{"model", c.name},
                    {"parameters", c.parameters},
                    {"relative_scatter", c.scatter},
                    {"residual_correlation", c.correlation},
                    {"aicc", json_of(c.aicc)},
                    {"aicc_difference", json_of(c.difference)},
                    {"fits", c.fits},
                    {"chosen", c.chosen}});
  return list;
}

}  // namespace

Json results_json(const FitResult& r) {
  Json j;
  j["kind"] = r.kind == RecordKind::torque_decay ? "torque_decay" : "flow_curve";
  j["yield_stress_Pa"] = json_of(r.tau_0);
  j["plastic_viscosity_Pa_s"] = json_of(r.mu);
  j["static_yield_stress_Pa"] = json_of(r.static_yield_stress);
  j["flocculation_start"] = json_of(r.lambda_0);
  j["alpha"] = json_of(r.alpha);
  j["structuration_rate_Pa_per_s"] = json_of(r.A_thix);
  j["alpha_apparent"] = r.apparent ? Json(r.apparent->windows.back().alpha_newtonian_rate) : Json(nullptr);
  j["alpha_apparent_basis"] = apparent_json(r);
  j["plug"] = json_of(r.plug);
  j["plug_below_rev_per_s"] = r.plug_below ? Json(*r.plug_below / two_pi) : Json(nullptr);
  j["sheared_radius_mm"] = r.sheared_radius ? Json(1e3 * *r.sheared_radius) : Json(nullptr);
  j["points_dropped"] = dropped_json(r);
  j["points_dropped_count"] = r.dropped_count;
  j["points_used"] = r.readings;
  j["relative_scatter"] = r.scatter;
  j["residual_correlation"] = r.correlation;
  j["effective_readings"] = r.effective_readings;
  j["model"] = r.model;
  j["consistency_Pa_s_n"] = json_of(r.consistency);
  j["flow_index"] = json_of(r.flow_index);
  j["exponent"] = json_of(r.exponent);
  j["models"] = candidates_json(r);
  j["choice"] = r.choice;
  j["notes"] = r.notes;
  return j;
}

void print_estimate(const char* name, const std::optional<Estimate>& e, const char* unit) {
  if (!e)
    fmt::print("{:<22} not told by this record\n", name);
  else if (e->given)
    fmt::print("{:<22} {:.4g} {} (given)\n", name, e->value, unit);
  else if (!e->ci95)
    fmt::print("{:<22} {:.4g} {} (no interval: as many readings as parameters)\n", name, e->value, unit);
  else
    fmt::print("{:<22} {:.4g} {} [{:.4g}, {:.4g}]\n", name, e->value, unit, e->ci95->low, e->ci95->high);
}

namespace {

void print_estimate_if(const std::optional<Estimate>& e, const char* name, const char* unit) {
  if (e) print_estimate(name, e, unit);
}

void print_candidates(const FitResult& r) {
  if (r.candidates.size() > 1) {
    fmt::print("{:<22} {:>10} {:>9} {:>11} {:>8} {:>8}\n", "model", "parameters", "scatter", "correlation",
               "AICc", "fits");
    for (const Candidate& c : r.candidates)
      fmt::print("{:<22} {:>10} {:>7.2f} % {:>11.2f} {:>8} {:>8}\n", (c.chosen ? "* " : "  ") + c.name,
                 c.parameters, 100.0 * c.scatter, c.correlation,
                 c.difference ? fmt::format("+{:.1f}", *c.difference) : "-", c.fits ? "yes" : "no");
  }
  if (!r.choice.empty()) fmt::print("{:<22} {}\n", "chosen", r.choice);
}

}  // namespace

void print_result(const FitResult& r) {
  print_candidates(r);
  print_estimate("yield stress", r.tau_0, "Pa");
  if (r.model != "herschel_bulkley") print_estimate("plastic viscosity", r.mu, "Pa.s");
  print_estimate_if(r.consistency, "consistency", "Pa.s^n");
  print_estimate_if(r.flow_index, "flow index", "");
  if (r.kind == RecordKind::torque_decay) {
    print_estimate("static yield stress", r.static_yield_stress, "Pa");
    print_estimate("flocculation at start", r.lambda_0, "");
    print_estimate("alpha", r.alpha, "");
    print_estimate("A_thix", r.A_thix, "Pa/s");
    if (r.apparent) {
      const ApparentAlpha& all = r.apparent->windows.back();
      fmt::print(
          "{:<22} {:.4g} (exponential over {:.4g} s, shear rate 2 Omega/(1 - Ri^2/Ro^2) = {:.4g} 1/s)\n",
          "apparent alpha", all.alpha_newtonian_rate, all.window, r.apparent->newtonian_rate);
    }
  }
  print_estimate_if(r.exponent, "exponent n", "");
  if (r.plug) fmt::print("{:<22} {}\n", "plug", *r.plug ? "yes" : "no");
  fmt::print("{:<22} {} used, {} dropped, scatter {:.2g} %\n", "readings", r.readings, r.dropped_count,
             100.0 * r.scatter);
  constexpr std::size_t most = 10;
  for (std::size_t i = 0; i < std::min(most, r.dropped.size()); ++i)
    fmt::print("{:<22} line {}: {}\n", "dropped", r.dropped[i].line, r.dropped[i].reason);
  if (r.dropped.size() > most) fmt::print("{:<22} and more, named in summary.json\n", "dropped");
  for (const auto& note : r.notes) fmt::print("{:<22} {}\n", "note", note);
}

}  // namespace tremie::cli
