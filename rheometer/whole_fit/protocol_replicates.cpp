#include "rheometer/whole_fit/protocol_replicates.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <optional>
#include <utility>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

using Estimates = std::vector<std::optional<ParameterEstimate>>;
using Readings = std::vector<ProtocolReading>;

constexpr double same_speed = 0.03, same_rest = 0.02;
constexpr double rest_tolerance = 1.0;  ///< [s]

const FitResult* flow_curve_of(const ProtocolReading& r) {
  return r.flow_curve > 0 ? &*r.sections[r.flow_curve - 1].fit : nullptr;
}

std::optional<ParameterEstimate> without_interval(const std::optional<double>& value) {
  if (!value) return std::nullopt;
  return ParameterEstimate{*value, std::nullopt, false};
}

void add(const FitParameter& p, Estimates of_record, Sign sign, const std::string& where,
         std::vector<ReplicateMean>& means) {
  auto m = replicate_mean(p, std::move(of_record), sign);
  if (!m) return;
  m->where = where;
  means.push_back(std::move(*m));
}

// --- of the whole records

struct RecordParameter {
  FitParameter row;
  Sign sign = Sign::not_negative;
  std::function<std::optional<ParameterEstimate>(const ProtocolReading&)> value;
};

const std::vector<RecordParameter>& record_parameters() {
  using R = const ProtocolReading&;
  static const std::vector<RecordParameter> all{
      {{"structuration_rate", "Pa/s", "structuration_rate_Pa_per_s", "A_thix of the peaks",
        "A_thix of the peaks", "A_thix"},
       Sign::any,
       [](R r) { return r.structuration.A_thix; }},
      {{"static_yield_stress_without_rest", "Pa", "static_yield_stress_without_rest_Pa",
        "static, without rest", "static yield stress without rest", "static"},
       Sign::any,
       [](R r) { return r.structuration.at_no_rest; }},
      {{"structuration_rate_by_flow_curve", "Pa/s", "structuration_rate_by_flow_curve_Pa_per_s",
        "A_thix by flow curve", "A_thix without viscous stress", "A_thix"},
       Sign::any,
       [](R r) { return r.structuration.A_thix_by_law; }},
      {{"static_yield_stress_end", "Pa", "static_yield_stress_end_Pa", "static, saturated",
        "static yield stress after long rest", "static"},
       Sign::not_negative,
       [](R r) {
         const auto& s = r.structuration.saturation;
         return without_interval(s ? std::optional(s->end_stress) : std::nullopt);
       }},
      {{"saturation_time", "s", "saturation_time_s", "time of saturation", "time of saturation", "t"},
       Sign::not_negative,
       [](R r) {
         const auto& s = r.structuration.saturation;
         return without_interval(s ? std::optional(s->time) : std::nullopt);
       }},
      {{"breakdown_rate", "1/s", "breakdown_rate_per_s", "breakdown rate k", "breakdown rate k", "k"},
       Sign::not_negative,
       [](R r) { return r.breakdown.rate; }},
      {{"rate_exponent", "", "rate_exponent", "rate exponent a", "rate exponent a", "a"}, Sign::any, [](R r) {
         return r.breakdown.exponent;
       }}};
  return all;
}

void add_flow_curves(const Readings& readings, std::vector<ReplicateMean>& means) {
  const std::string law = common_law(readings);
  if (law.empty()) return;
  for (const LawParameter& p : flow_law(law).parameters) {
    Estimates of_record;
    for (const ProtocolReading& r : readings) {
      const FitResult* fit = flow_curve_of(r);
      of_record.push_back(fit && fit->model == law ? value_of(*fit, p.row) : std::nullopt);
    }
    add(p.row, std::move(of_record), Sign::not_negative, "", means);
  }
}

// --- of sections that are alike

/// Sections of one kind, speed and rest, one of a record at most; null where it has none.
struct Alike {
  const Section* first = nullptr;
  std::vector<const SectionReading*> of_record;
};

bool alike(const Section& a, const Section& b) {
  return a.kind == b.kind && std::abs(a.omega - b.omega) <= same_speed * a.omega &&
         std::abs(a.rest_before - b.rest_before) <= std::max(rest_tolerance, same_rest * a.rest_before);
}

std::vector<Alike> alike_sections(const Readings& readings, SectionKind kind) {
  std::vector<Alike> groups;
  for (std::size_t i = 0; i < readings.size(); ++i)
    for (const SectionReading& s : readings[i].sections) {
      if (s.section.kind != kind) continue;
      auto group = std::find_if(groups.begin(), groups.end(), [&](const Alike& g) {
        return !g.of_record[i] && alike(*g.first, s.section);
      });
      if (group == groups.end())
        group = groups.insert(group, {&s.section, std::vector<const SectionReading*>(readings.size())});
      group->of_record[i] = &s;
    }
  return groups;
}

std::string where_of(const Section& s, bool sheared_evenly) {
  const ShownUnits shown = shown_units(sheared_evenly);
  return text_of("%.3g %s after %.4g s of rest", s.omega / shown.speed, shown.speed_unit, s.rest_before);
}

void add_peaks(const Readings& readings, std::vector<ReplicateMean>& means) {
  static const FitParameter peak{"static_yield_stress",    "Pa",
                                 "static_yield_stress_Pa", "static yield stress",
                                 "static yield stress",    "static"};
  static const FitParameter by_law{"static_yield_stress_by_flow_curve",          "Pa",
                                   "static_yield_stress_by_flow_curve_Pa",       "static, by flow curve",
                                   "static yield stress without viscous stress", "static"};
  static const FitParameter modulus{"shear_modulus", "Pa", "shear_modulus_Pa", "shear modulus",
                                    "shear modulus", "G"};
  const std::pair<const FitParameter*, std::optional<double> StartUpReading::*> rows[] = {
      {&peak, &StartUpReading::static_yield_stress},
      {&by_law, &StartUpReading::static_by_law},
      {&modulus, &StartUpReading::shear_modulus}};
  for (const Alike& group : alike_sections(readings, SectionKind::start_up))
    for (const auto& row : rows) {
      Estimates of_record;
      for (const SectionReading* s : group.of_record)
        of_record.push_back(without_interval(s && s->start_up ? (*s->start_up).*row.second : std::nullopt));
      add(*row.first, std::move(of_record), Sign::not_negative,
          where_of(*group.first, readings.front().sheared_evenly), means);
    }
}

/// The word that most of them are, of equally many the first; empty for none.
std::string most_common(const std::vector<std::string>& words) {
  std::map<std::string, long> count;
  for (const std::string& word : words)
    if (!word.empty()) ++count[word];
  std::string best;
  for (const std::string& word : words)
    if (!word.empty() && (best.empty() || count[word] > count[best])) best = word;
  return best;
}

void add_decays(const Readings& readings, std::vector<ReplicateMean>& means) {
  for (const Alike& group : alike_sections(readings, SectionKind::constant_rate)) {
    std::vector<std::string> models;
    for (const SectionReading* s : group.of_record) models.push_back(s && s->fit ? s->fit->model : "");
    const std::string model = most_common(models);
    for (const FitParameter& p : fit_parameters()) {
      Estimates of_record;
      for (std::size_t i = 0; i < models.size(); ++i)
        of_record.push_back(!model.empty() && models[i] == model ? value_of(*group.of_record[i]->fit, p)
                                                                 : std::nullopt);
      add(p, std::move(of_record), Sign::not_negative,
          model + ", " + where_of(*group.first, readings.front().sheared_evenly), means);
    }
  }
}

}  // namespace

std::string law_read(const ProtocolReading& r) {
  const FitResult* fit = flow_curve_of(r);
  return fit ? fit->model : "";
}

std::string common_law(const Readings& readings) {
  std::string best;
  std::ptrdiff_t most = 0;
  for (const FlowLaw& law : flow_laws()) {
    const auto count = std::count_if(readings.begin(), readings.end(),
                                     [&](const ProtocolReading& r) { return law_read(r) == law.name; });
    if (count > 0 && count >= most) best = law.name, most = count;
  }
  return best;
}

std::vector<ReplicateMean> replicate_means(const Readings& readings) {
  std::vector<ReplicateMean> means;
  add_flow_curves(readings, means);
  for (const RecordParameter& p : record_parameters()) {
    Estimates of_record;
    for (const ProtocolReading& r : readings) of_record.push_back(p.value(r));
    add(p.row, std::move(of_record), p.sign, "", means);
  }
  add_peaks(readings, means);
  add_decays(readings, means);
  return means;
}

}  // namespace tremie
