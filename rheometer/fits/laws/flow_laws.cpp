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

}  // namespace tremie
