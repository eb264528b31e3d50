// Whether one sliding floor, tau_i = ratio tau_0 and k_i, explains the fresh and the rested spreads of Mixes A to C: the pair
// that fits two mixes' fresh spreads best forecasts the third's.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "apparatus/validation/mixes.hpp"
#include "apparatus/validation/readings.hpp"

namespace tremie::validation {
namespace {

struct Layer {
  double ratio, viscosity;  ///< tau_i/tau_0, k_i [Pa s/m]
};

std::vector<Layer> layers() {
  std::vector<Layer> all;
  for (const double ratio : {0.4, 0.5, 0.65})
    for (const double viscosity : {300.0, 1000.0, 3000.0}) all.push_back({ratio, viscosity});
  return all;
}

Ask ask(const PaperMix& mix, bool rested, const Layer& layer) {
  return {.scene = fmt::format(
              "apparatus = \"slump_flow\"\nmix = \"{}\"\n[test]\nrest = \"{} s\"\n[floor]\ncontact = "
              "\"interface\"\ninterface_yield_ratio = {}\ninterface_viscosity = \"{} Pa.s/m\"\n",
              mix.file, rested ? 240 : 0, layer.ratio, layer.viscosity),
          .result = "spread_mm",
          .with_error = false};
}

struct Spreads {
  std::array<double, 3> fresh, rested;  ///< of Mixes A to C [mm]
};

/// Sum of squares of the fresh spreads' errors of the mixes but `left_out`.
double misfit(const Spreads& s, std::size_t left_out) {
  double sum = 0.0;
  for (std::size_t mix = 0; mix < 3; ++mix)
    if (mix != left_out) sum += std::pow(s.fresh[mix] - paper_mix[mix].fresh, 2);
  return sum;
}

std::size_t best_of(const std::vector<Spreads>& spreads, std::size_t left_out) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < spreads.size(); ++i)
    if (misfit(spreads[i], left_out) < misfit(spreads[best], left_out)) best = i;
  return best;
}

std::string table(const std::vector<Layer>& all, const std::vector<Spreads>& spreads) {
  std::string text =
      "\n\n|τ_i/τ0|k_i (Pa·s/m)|A fresh|rested|B fresh|rested|C fresh|rested|\n"
      "|---|---|---|---|---|---|---|---|\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    text += fmt::format("|{}|{}|", all[i].ratio, all[i].viscosity);
    for (std::size_t mix = 0; mix < 3; ++mix)
      text += fmt::format("{:.0f}|{:.0f}|", spreads[i].fresh[mix], spreads[i].rested[mix]);
    text += "\n";
  }
  return text + "|measured|± 30|590|575|550|530|500|485|\n";
}

}  // namespace

Section sliding_floor(const Settings& settings) {
  const std::vector<Layer> all = layers();
  std::vector<Ask> asked;
  for (const Layer& layer : all)
    for (const PaperMix& mix : paper_mix)
      for (const bool rested : {false, true}) asked.push_back(ask(mix, rested, layer));
  const auto readings = read_scenes(asked, settings);
  std::vector<Spreads> spreads(all.size());
  for (std::size_t i = 0; i < readings.size(); ++i)
    (i % 2 == 0 ? spreads[i / 6].fresh : spreads[i / 6].rested)[i / 2 % 3] = readings[i].value;
  Section section{"sliding", "A floor that slides",
                  "A layer of paste slides along the plate with τ = τ_i + k_i u; default kinetics. Each of "
                  "nine pairs (τ_i/τ0, k_i) is common to all mixes. The pair that fits two mixes' fresh "
                  "spreads best forecasts the third's." +
                      table(all, spreads)};
  for (std::size_t third = 0; third < 3; ++third) {
    const std::size_t best = best_of(spreads, third);
    for (const bool rested : {false, true})
      section.comparisons.push_back(
          {fmt::format("{} {} ({}, {})", paper_mix[third].name, rested ? "rested" : "fresh", all[best].ratio,
                       all[best].viscosity),
           "mm", rested ? paper_mix[third].rested : paper_mix[third].fresh, paper_tolerance,
           rested ? spreads[best].rested[third] : spreads[best].fresh[third], NAN});
  }
  section.findings.push_back(
      "Pairs lie on a ridge: larger τ_i and smaller k_i spread about as far. No tribometer was used.");
  return section;
}

}  // namespace tremie::validation
