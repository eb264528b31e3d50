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
  return {.name = "slump_flow",
          .help = "The slump-flow test of EN 12350-8.",
          .schema = scene::joined(
              {scene::mix_sections(),
               cone::sections(),
               {scene::measured_section(), scene::floor_section(),
                scene::model_section({"axisymmetric", "quarter", "full"}), scene::output_section()}}),
          .presets = {{"paper", paper_preset}},
          .settle = cone::settle};
}

}  // namespace tremie::slump_flow
