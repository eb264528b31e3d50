#include <algorithm>
#include <stdexcept>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/fits/laws/bingham.hpp"
#include "rheometer/fits/laws/herschel_bulkley.hpp"

namespace tremie {

const std::vector<FlowLaw>& flow_laws() {
  static const std::vector<FlowLaw> all{bingham_law(),  //
                                        herschel_bulkley_law()};
  return all;
}

const FlowLaw& flow_law(const std::string& name) {
  std::string names;
  for (const FlowLaw& law : flow_laws()) {
    if (law.name == name) return law;
    names += (names.empty() ? "" : ", ") + law.name;
  }
  throw std::invalid_argument("there is no law \"" + name + "\" of a flow curve; there are: " + names);
}

const FlowLaw* law_of(const FitResult& fit) {
  return fit.kind == RecordKind::flow_curve && fit.model != interface_model ? &flow_law(fit.model) : nullptr;
}

std::optional<KnownLaw> known_law(const FitResult& fit) {
  const FlowLaw* law = law_of(fit);
  if (!law || !fit.reasons.empty()) return std::nullopt;
  KnownLaw known{law->name, {}, fit.law_covariance};
  for (const LawParameter& p : law->parameters) {
    const auto value = value_of(fit, p.row);
    if (!value) return std::nullopt;
    known.parameters.push_back(value->value);
  }
  known.parameters.front() = std::max(0.0, known.parameters.front());
  return known;
}

ViscousStress viscous_stress(const KnownLaw& known) {
  const FlowLaw& law = flow_law(known.name);
  if (!law.viscous)
    throw std::invalid_argument("a decay is not read by the flow curve's law, " + law.words +
                                ": allowed are those with a stress k gamma_dot^n beyond the yield stress");
  return law.viscous(known.parameters);
}

}  // namespace tremie
