#include "apparatus/estimate/estimate_json.hpp"

#include <nlohmann/json.hpp>

namespace tremie::estimate {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<Interval>& i) {
  if (!i) return nullptr;
  return {{"value", i->value}, {"ci95", {i->low, i->high}}};
}

Json json_of(const std::optional<double>& number) {
  if (!number) return nullptr;
  return *number;
}

}  // namespace

std::string estimate_json(const MixEstimate& e) {
  const Json json{{"results",
                   {{"yield_stress_Pa", json_of(e.tau_0)},
                    {"plastic_viscosity_Pa_s", json_of(e.mu)},
                    {"yield_stress_thin_layer_law_Pa", json_of(e.tau_0_thin_layer)},
                    {"yield_stress_with_plug_stress_Pa", json_of(e.tau_0_plug)}}},
                  {"checks", {{"reasons", e.reasons}}}};
  return json.dump(2);
}

}  // namespace tremie::estimate
