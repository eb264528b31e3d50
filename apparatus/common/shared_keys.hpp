#pragma once

// The sections that several apparatus share, and how their values become the library's plain data.

#include <optional>
#include <string>

#include "apparatus/common/model.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::scene {

/// [mix] and [mix.thixotropy], with the default of K.
Schema mix_sections(const std::string& bulk_modulus = "1 MPa");

/// Rules of the mix: one way to give K, yield stress with thixotropy. Call it from ApparatusKeys::settle.
void settle_mix(Values& values);

/// What an apparatus can compute beyond a rigid material whose structure breaks down by the shear rate at the point.
struct MixAbilities {
  bool elastic = false;  ///< mix.shear_modulus
  bool layer = false;    ///< mix.thixotropy.layer
};
/// The same for an apparatus that can; a key that the apparatus cannot compute is an InputError.
void settle_mix_with(Values& values, const MixAbilities& can);

Mix read_mix(const Values& values);

/// Keys that the schedules of several tests have.
Key rest_key(const std::string& fallback, const std::string& help);
Key duration_key(const std::string& fallback,
                 const std::string& help = "at most; a flow that has come to rest ends earlier");
/// The speed of a lift, or "instant".
Key lift_key(const std::string& name, const std::string& fallback, const std::string& help);

/// Throws InputError where the points do not fit into a computer.
void check_points(const Values& values, double points);

/// What was measured on the real concrete, where the mix says so: for charts, never for the run.
struct Measured {
  std::string name, source;
  std::optional<double> slump_flow_0, slump_flow_240;  ///< [m], without and with 240 s of rest
  double tolerance = 0.0;                              ///< of both [m]
  // [measured], which wins over the mix's:
  std::optional<double> spread = {}, spread_tolerance = {};  ///< [m]
  std::optional<double> t500 = {};                           ///< [s]
  /// Concrete on which slump_flow_0 and slump_flow_240 were measured, if not this one; empty: this one.
  std::string on = {};
  std::string licence = {};  ///< of the mix's numbers
};
Measured read_measured(const Values& values);

/// [measured], of a slump flow.
Section measured_section();

/// [floor].
Section floor_section();
/// A friction floor takes its coefficient from the mix where the scene gives none.
void settle_floor(Values& values);
Floor read_floor(const Values& values);

/// The defaults of [model] that differ from apparatus to apparatus, as in TOML.
struct ModelDefaults {
  std::string cell = "[\"10 mm\", \"5 mm\"]";  ///< empty: settled by the apparatus
  std::string points_per_cell = "[4, 4]";
  std::string cell_help = "[across, up], or one length; [\"14 mm\", \"7 mm\"] in three dimensions";
  std::string points_help = "[across, up], or one number for each direction; [4, 2] in three dimensions";
  std::string space_help = {};
};

/// [model], with the spaces that an apparatus has; the first is its default.
Section model_section(const std::vector<std::string>& spaces, const ModelDefaults& defaults = {});
Model read_model(const Values& values);

/// [output].
Section output_section();
struct Output {
  double frame_interval = 0.0;  ///< [s]; 0: chosen (run/run_loop.hpp)
  bool frames = true;
  std::optional<double> checkpoint_interval = {};  ///< of wall time [s]; empty: none are kept
};
Output read_output(const Values& values);

}  // namespace tremie::scene
