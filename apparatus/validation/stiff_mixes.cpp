// Slump of mixes that hardly flow against correlations of slump with yield stresses that rheometers measured.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/validation/readings.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::validation {
namespace {

constexpr double density = 2400.0;

/// tau_0 = rho (300 mm - s)/divisor + offset, s in mm, rho in kg/m3.
struct Correlation {
  const char* name;
  double divisor, offset;
  double mean_deviation;  ///< published, of the yield stress about the correlation [Pa]
};
// Hu, and Ferraris and de Larrard on the same kind of data: NISTIR 6094 (1998), equations (2) and (3).
constexpr Correlation correlations[] = {{"Hu", 270.0, 0.0, 195.0},
                                        {"Ferraris, de Larrard", 347.0, 212.0, 162.0}};

double slump_of(const Correlation& c, double tau_0) {
  return 300.0 - c.divisor * (tau_0 - c.offset) / density;
}

/// A mean absolute deviation is 0.8 standard deviations of a Gaussian.
double slump_error(const Correlation& c) { return 1.96 * c.mean_deviation / 0.798 * c.divisor / density; }

/// A slice of the cone keeps its shape where the weight above it is carried by its strength, sqrt(3) tau_0, and else
/// widens until it is (Schowalter and Christensen, J. Rheol. 42, 1998, with von Mises' strength) [mm].
double uniaxial_slump(double tau_0) {
  constexpr int slices = 3000;
  constexpr double height = 0.3, thickness = height / slices;
  double weight = 0.0, left = 0.0;
  for (int i = 0; i < slices; ++i) {
    const double radius = 0.05 + 0.05 * (i + 0.5) / slices, area = std::numbers::pi * radius * radius;
    weight += density * gravity * area * thickness;
    left += thickness * area / std::max(area, weight / (std::sqrt(3.0) * tau_0));
  }
  return 1e3 * (height - left);
}

std::string scene_of(double tau_0) {
  return fmt::format(
      "apparatus = \"slump_flow\"\n[mix]\nyield_stress = \"{} Pa\"\nplastic_viscosity = \"50 Pa.s\"\ndensity "
      "= \"{} kg/m3\"\n[test]\nlift_speed = \"10 cm/s\"\n",
      tau_0, density);
}

}  // namespace

Section stiff_mixes(const Settings& settings) {
  Section section{"slump", "Slump of stiff mixes",
                  "Slump over yield stress, 2400 kg/m3, 50 Pa.s, cone at 10 cm/s. \"Measured\" are "
                  "correlations with yield stresses by BTRHEOM (NISTIR 6094): τ0 = ρ(300 − s)/270 (Hu) and "
                  "ρ(300 − s)/347 + 212 (Ferraris, de Larrard), mean deviations 195 and 162 Pa."};
  const double yield_stresses[] = {600.0, 1200.0, 1800.0};
  std::vector<Ask> asked;
  for (const double tau_0 : yield_stresses) asked.push_back({scene_of(tau_0), "height_mm"});
  const auto readings = read_scenes(asked, settings);
  for (const Correlation& c : correlations)
    for (std::size_t i = 0; i < readings.size(); ++i)
      section.comparisons.push_back({fmt::format("{:.0f} Pa, {}", yield_stresses[i], c.name), "mm",
                                     slump_of(c, yield_stresses[i]), slump_error(c),
                                     300.0 - readings[i].value, readings[i].error, "none"});
  std::string closed;
  for (const double tau_0 : yield_stresses)
    closed += fmt::format("{}{:.0f}", closed.empty() ? "" : ", ", uniaxial_slump(tau_0));
  section.findings.push_back(fmt::format(
      "Tremie is near the closed form of a yielding cone (Schowalter and Christensen, uniaxial strength √3 "
      "τ0): {} mm. The BTRHEOM reads higher than others, and rheometers differ by factors: no verdict.",
      closed));
  return section;
}

}  // namespace tremie::validation
