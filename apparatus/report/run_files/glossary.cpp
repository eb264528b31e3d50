#include "apparatus/report/run_files/glossary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace tremie::report {
namespace {

constexpr std::array<std::pair<const char*, const char*>, 13> endings{{{"_mm_per_s", "mm/s"},
                                                                       {"_mm", "mm"},
                                                                       {"_m_per_s", "m/s"},
                                                                       {"_rev_per_s", "rev/s"},
                                                                       {"_Pa_per_s", "Pa/s"},
                                                                       {"_per_s", "1/s"},
                                                                       {"_Pa_s", "Pa.s"},
                                                                       {"_s", "s"},
                                                                       {"_J", "J"},
                                                                       {"_Pa", "Pa"},
                                                                       {"_N_m", "N.m"},
                                                                       {"_m3", "m3"},
                                                                       {"_m", "m"}}};

const std::map<std::string, std::string>& glossary() {
  static const std::map<std::string, std::string> words{
      {"time_s", "time since the start of the test"},
      {"spread_mm", "slump flow, mean diameter"},
      {"spread_max_point_mm", "twice the radius of the outermost point's centre"},
      {"height_mm", "height at the centre"},
      {"t500_s", "t500, time to a diameter of 500 mm"},
      {"stopped_at_s", "came to rest at"},
      {"class_en12350_8", "slump-flow class (EN 206); of concrete at rest"},
      {"class_en12350_10", "passing-ability class (EN 206); of concrete at rest"},
      {"flocculation_mean_start", "flocculation state λ at the start, mean"},
      {"flocculation_mean_end", "flocculation state λ at the end, mean"},
      {"flocculation_mean", "flocculation state λ, volume mean"},
      {"shear_rate_mean_peak_per_s", "largest mean shear rate"},
      {"shear_rate_mean_per_s", "shear rate, volume mean"},
      {"mean_velocity_mm_per_s", "(SF − 200 mm)/(2 t_stop): high for a mix that stops early"},
      {"within_tremie_range", "within 450 to 650 mm (tremie concrete)"},
      {"measured.spread_mm", "measured slump flow"},
      {"measured.tolerance_mm", "its tolerance"},
      {"measured.difference_mm", "computed minus measured"},
      {"h1_mm", "H1, depth behind the gate"},
      {"h2_mm", "H2, depth at the channel's end"},
      {"passing_ratio", "passing ratio H2/H1"},
      {"passing_ratio_change_per_min", "change of the passing ratio over the last 30 s, a minute"},
      {"t200_s", "t200, front 200 mm from the gate"},
      {"t400_s", "t400, front 400 mm from the gate"},
      {"volume_in_channel_m3", "volume in the channel"},
      {"front_mm", "distance of the front from the gate"},
      {"torque_peak_N_m", "largest torque on the blades"},
      {"torque_end_N_m", "torque on the blades at the end"},
      {"torque_wall_end_N_m", "torque on the container at the end"},
      {"torque_power_end_N_m", "dissipated power over speed at the end"},
      {"torque_couette_reference_N_m", "torque of a solid cylinder in the same container (Couette flow)"},
      {"torque_plane_N_m", "torque of the plane section times the height"},
      {"static_yield_stress_apparent_Pa", "T/(2πr²h) at the peak: apparent static yield stress"},
      {"dynamic_yield_stress_apparent_Pa",
       "T/(2πr²h) at the end: apparent, with viscous part and flocculation left"},
      {"alpha_apparent", "α as read off the decay"},
      {"flocculation_error_max", "largest difference of λ from CVODE"},
      {"stress_max_Pa", "largest shear stress"},
      {"stress_end_Pa", "shear stress at the end"},
      {"hysteresis_area_Pa_per_s", "area of the hysteresis loop"},
      {"volume_change", "change of volume, ΣV/V0 − 1"},
      {"slump_flow", "slump flow"},
      {"l_box", "L-box"},
      {"icar_vane", "vane"},
      {"cell", "material cell"},
      {"measured.t500_s", "measured t500"},
      {"reiner_riwlin", "yield stress and viscosity by Reiner-Riwlin (of several speeds)"},
      {"reiner_riwlin.yield_stress_Pa", "yield stress by Reiner-Riwlin, as the instrument reports"},
      {"reiner_riwlin.plastic_viscosity_Pa_s",
       "plastic viscosity by Reiner-Riwlin, as the instrument reports"},
      {"yield_stress_Pa", "yield stress"},
      {"plastic_viscosity_Pa_s", "plastic viscosity"},
      {"flocculation_apparent_start", "flocculation state λ at the start, as read off the torque"},
      {"flocculation_apparent", "flocculation state λ, as read off the torque"},
      {"flocculation_reference", "flocculation state λ by CVODE"},
      {"speed_rev_per_s", "speed of the vane"},
      {"torque_N_m", "torque on the blades"},
      {"radius_mm", "radius"},
      {"distance_mm", "distance from the gate"},
      {"depth_mm", "depth"},
      {"velocity_m_per_s", "velocity"},
      {"shear_rate_per_s", "shear rate"},
      {"shear_stress_Pa", "shear stress"},
      {"max_speed_m_per_s", "largest speed"},
      {"kinetic_energy_J", "kinetic energy"},
      {"flocculation_end", "flocculation state λ at the end"},
      {"input.yield_stress_Pa", "yield stress that went in"},
      {"input.plastic_viscosity_Pa_s", "plastic viscosity that went in"},
      {"input.flocculation_start", "flocculation state λ that went in"},
      {"input.static_yield_stress_Pa", "static yield stress that went in"},
      {"input.destructuration", "α that went in"},
      {"alpha_window_s", "time over which α is read"},
      {"shear_rate_nominal_per_s", "nominal shear rate 2Ω/(1 − r²/R²), by which α is read"},
      {"bars", "bars in front of the gate"},
      {"end_factor", "torque over that of the plane section"},
      {"time_step_s", "time step"},
      {"iterations", "iterations of the yield method in the step"},
      {"position", "places of the points"},
      {"velocity", "velocities of the points"},
      {"volume", "volumes of the points"},
      {"pressure", "pressures of the points"},
      {"shear_rate", "shear rates of the points"},
      {"flocculation", "flocculation state λ"}};
  return words;
}

}  // namespace

std::string unit_of(const std::string& name) {
  for (const auto& [ending, unit] : endings)
    if (name.ends_with(ending)) return unit;
  return "1";
}

std::string words_of(const std::string& name) {
  const auto found = glossary().find(name);
  if (found != glossary().end()) return found->second;
  std::string text = name;
  for (const auto& [ending, unit] : endings)
    if (text.ends_with(ending)) {
      text.resize(text.size() - std::string(ending).size());
      break;
    }
  std::replace(text.begin(), text.end(), '_', ' ');
  std::replace(text.begin(), text.end(), '.', ' ');
  return text;
}

std::string unit_for_people(const std::string& name) {
  const std::string unit = unit_of(name);
  return unit == "1" ? "" : unit == "N.m" ? "N·m" : unit == "Pa.s" ? "Pa·s" : unit == "m3" ? "l" : unit;
}

std::string person_number(double value, const std::string& name) {
  if (!std::isfinite(value)) return "–";
  if (unit_of(name) == "m3") value *= 1e3;  // litres, as unit_for_people() says
  if (unit_of(name) == "mm") return fmt::format("{:.{}f}", value, std::abs(value) < 10.0 ? 1 : 0);
  // Runs are good to about a per cent: three digits.
  return std::abs(value) < 100.0 ? fmt::format("{:.3g}", value) : fmt::format("{:.0f}", value);
}

}  // namespace tremie::report
