#include "apparatus/report/fit_results.hpp"

#include "apparatus/report/protocol_results.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/fits/parameters.hpp"

namespace tremie::report {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<ParameterEstimate>& e) {
  if (!e) return nullptr;
  Json json{{"value", e->value}, {"ci95", nullptr}};
  if (e->ci95) json["ci95"] = {e->ci95->low, e->ci95->high};
  if (e->given) json["given"] = true;
  return json;
}

namespace {

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
  const ShownUnits shown = shown_units(r.sheared_evenly);
  for (const DroppedPoint& p : r.dropped)
    list.push_back({{"line", p.line},
                    {decay ? "time_s" : shown.speed_key, decay ? p.x : p.x / shown.speed},
                    {shown.torque_key, p.torque},
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

Json fit_results(const FitResult& r) {
  Json j;
  j["kind"] = r.kind == RecordKind::torque_decay ? "torque_decay"
              : r.model == interface_model       ? "tribometer"
                                                 : "flow_curve";
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
  for (const FitParameter& p : fit_parameters())
    if (!p.member) j[p.key] = json_of(value_of(r, p));
  j["exponent"] = json_of(r.exponent);
  j["breakdown_rate_per_s"] = json_of(r.breakdown_rate);
  j["rate_exponent"] = nullptr;  // one speed does not tell it
  j["models"] = candidates_json(r);
  j["choice"] = r.choice;
  j["notes"] = r.notes;
  return j;
}

namespace {

/// [walls] of a scene; null where a parameter is not identifiable.
Json json_of_walls(const FitResult& r) {
  const std::string text = scene_walls(r);
  return text.empty() ? Json(nullptr) : Json(text);
}

Json moves_json(const std::vector<MoveByEnds>& moves) {
  Json json;
  for (const MoveByEnds& m : moves) json[m.key] = {{"without_ends", m.without_ends}, {"change", m.change}};
  return json;
}

Json mean_json(const ReplicateMean& m) {
  Json row = json_of(std::optional(m.mean));
  row.update({{"unit", m.parameter.unit},
              {"records", m.records},
              {"scatter_between", json_of(m.between)},
              {"scatter_within", json_of(m.within)},
              {"scatter_between_laboratories", json_of(m.parameter.laboratories)}});
  return row;
}

Json replicates_json(const RecordFits& fits, const std::vector<std::string>& records) {
  const bool protocols = !fits.protocols.empty();
  Json json{{"kind", protocols ? "protocol_replicates" : "replicates"}, {"records", Json::array()}};
  for (std::size_t i = 0; i < records.size(); ++i) {
    Json one{{"record", records[i]}};
    one.update(protocols ? protocol_results(fits.protocols[i].reading) : fit_results(fits.fits[i]));
    if (protocols) one["understood"] = fits.protocols[i].record.understood;
    json["records"].push_back(one);
  }
  Json& mean = json["mean"] = Json::object();
  for (const ReplicateMean& m : fits.means)
    if (m.where.empty()) mean[m.parameter.name] = mean_json(m);
  if (!protocols) return json;
  Json& sections = json["mean_of_sections"] = Json::array();
  for (const ReplicateMean& m : fits.means) {
    if (m.where.empty()) continue;
    Json row{{"parameter", m.parameter.name}, {"where", m.where}};
    row.update(mean_json(m));
    sections.push_back(row);
  }
  json["notes"] = fits.notes;
  return json;
}

}  // namespace

Json fit_results(const RecordFits& fits, const std::vector<std::string>& records) {
  const bool protocol = !fits.protocols.empty(), one = fits.protocols.size() == 1;
  Json json = one                                ? protocol_results(fits.protocols.front().reading)
              : protocol || fits.fits.size() > 1 ? replicates_json(fits, records)
                                                 : fit_results(fits.fits.front());
  if (fits.options.tribometer) json["walls"] = json_of_walls(fits.fits.front());
  if (one) json["understood"] = fits.protocols.front().record.understood;
  json["geometry"] = {{"words", fits.geometry}, {"default", fits.default_geometry}};
  json["ends"] = {{"correction", fits.options.ends}, {"factor", fits.end_factor}};
  if (fits.fits.size() == 1) json["ends"]["moves"] = moves_json(fits.moves);
  json["blades"] = {{"correction", fits.options.blades}};
  return json;
}

}  // namespace tremie::report
