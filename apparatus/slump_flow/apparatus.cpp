#include "apparatus/slump_flow/apparatus.hpp"

#include "apparatus/parts/cone/readings.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::slump_flow {
namespace {

/// What the paper used, where its text or its code's defaults say so (reference_data/published.toml). 15 mm
/// cells of 2 points a direction give its 13,000 points.
constexpr const char* paper_preset = R"([mix]
youngs_modulus = "0.01 MPa"
poisson_ratio  = 0.45
[test]
duration   = "20 s"
lift_speed = "15 cm/s"
[floor]
contact = "friction"
[model]
space           = "full"
yield           = "papanastasiou"
regularisation  = "5 s"
scheme          = "explicit_usf"
shape           = "gimp"
pressure        = "cell"
precision       = "single"
time_step       = "1e-4 s"
cell            = "15 mm"
points_per_cell = 2
)";

}  // namespace

scene::ApparatusKeys keys() {
  scene::ApparatusKeys keys{.name = "slump_flow",
                            .help = "The slump-flow test of EN 12350-8.",
                            .schema = scene::mix_sections(),
                            .presets = {{"paper", paper_preset}},
                            .settle = cone::settle};
  for (const scene::Section& section : cone::sections()) keys.schema.push_back(section);
  keys.schema.push_back(scene::measured_section());
  keys.schema.push_back(scene::floor_section());
  keys.schema.push_back(scene::model_section({"axisymmetric", "quarter", "full"}));
  keys.schema.push_back(scene::output_section());
  return keys;
}

scene::Apparatus apparatus() {
  return scene::make_apparatus<cone::Scene>(
      {.keys = keys(), .words = "slump flow", .headlines = headlines(), .glossary = glossary()},
      cone::read_scene, cone::uses, run, cone::estimate);
}

}  // namespace tremie::slump_flow
