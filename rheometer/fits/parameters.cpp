#include "rheometer/fits/parameters.hpp"

#include <algorithm>
#include <iterator>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

const FitParameter& yield_stress_parameter() {
  static const FitParameter row{"yield_stress",         "Pa",    "yield_stress_Pa", "yield stress",
                                "dynamic yield stress", "tau_0", &FitResult::tau_0, 0.27};
  return row;
}

const FitParameter& plastic_viscosity_parameter() {
  static const FitParameter row{"plastic_viscosity", "Pa s", "plastic_viscosity_Pa_s", "plastic viscosity",
                                "plastic viscosity", "mu",   &FitResult::mu,           0.24};
  return row;
}

const std::vector<FitParameter>& fit_parameters() {
  static const std::vector<FitParameter> all = [] {
    std::vector<FitParameter> rows{
        yield_stress_parameter(),
        plastic_viscosity_parameter(),
        {"static_yield_stress", "Pa", "static_yield_stress_Pa", "static yield stress", "static yield stress",
         "static", &FitResult::static_yield_stress},
        {"flocculation_start", "", "flocculation_start", "flocculation at start", "λ at the start", "lambda",
         &FitResult::lambda_0},
        {"alpha", "", "alpha", "alpha", "α", "alpha", &FitResult::alpha},
        {"breakdown_rate", "1/s", "breakdown_rate_per_s", "breakdown rate", "breakdown rate at this speed",
         "k", &FitResult::breakdown_rate},
        {"exponent", "", "exponent", "exponent n", "exponent of the kinetics", "n", &FitResult::exponent},
        {"structuration_rate", "Pa/s", "structuration_rate_Pa_per_s", "A_thix", "A_thix", "A_thix",
         &FitResult::A_thix}};
    for (const FlowLaw& law : flow_laws())
      for (const LawParameter& p : law.parameters)
        if (!p.row.member) rows.push_back(p.row);
    for (const FitParameter& p : interface_parameters()) rows.push_back(p);
    return rows;
  }();
  return all;
}

const std::vector<FitParameter>& interface_parameters() {
  static const std::vector<FitParameter> all{
      {"interface_yield_stress", "Pa", "interface_yield_stress_Pa", "interface yield stress",
       "yield stress of the interface", "tau_i"},
      {"interface_viscosity", "Pa s/m", "interface_viscosity_Pa_s_per_m", "interface viscosity",
       "viscous constant of the interface", "k_i"}};
  return all;
}

std::optional<ParameterEstimate> value_of(const FitResult& fit, const FitParameter& parameter) {
  if (parameter.member) return fit.*parameter.member;
  const auto known = fit.of_law.find(parameter.name);
  return known == fit.of_law.end() ? std::nullopt : known->second;
}

std::vector<FitParameter> parameters_of(const FitResult& fit) {
  std::vector<FitParameter> rows;
  if (fit.model == interface_model) return interface_parameters();
  if (const FlowLaw* law = law_of(fit))
    for (const LawParameter& p : law->parameters) rows.push_back(p.row);
  else
    std::copy_if(fit_parameters().begin(), fit_parameters().end(), std::back_inserter(rows),
                 [&](const auto& p) {
                   const auto other =
                       fit.model == RatePowerKinetics::word ? &FitResult::alpha : &FitResult::breakdown_rate;
                   if (!p.member) return value_of(fit, p).has_value();  // of the flow curve's law
                   const bool has_law = !fit.of_law.empty();
                   return p.member != &FitResult::exponent && p.member != other &&
                          !(has_law && p.member == &FitResult::mu);
                 });
  return rows;
}

void set_value(FitResult& fit, const FitParameter& parameter, const std::optional<ParameterEstimate>& value) {
  (parameter.member ? fit.*parameter.member : fit.of_law[parameter.name]) = value;
}

std::string scene_walls(const FitResult& fit) {
  const auto tau_i = value_of(fit, interface_parameters()[0]), k_i = value_of(fit, interface_parameters()[1]);
  if (!tau_i || !k_i) return {};
  return text_of(
      "[walls]\ncontact = \"interface\"\ninterface_yield_stress = \"%.4g Pa\"\ninterface_viscosity = \"%.4g "
      "Pa.s/m\"\n",
      tau_i->value, k_i->value);
}

}  // namespace tremie
