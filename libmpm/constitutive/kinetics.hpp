#pragma once

// The registry of the kinetics of lambda: one line each. What kinetics state is in kinetics_interface.hpp. Everything that
// stores, steps, rests, reads or fits lambda goes through this variant and names none of them.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "libmpm/constitutive/gated_kinetics.hpp"
#include "libmpm/constitutive/power_kinetics.hpp"
#include "libmpm/constitutive/rate_power_kinetics.hpp"
#include "libmpm/constitutive/roussel_kinetics.hpp"

namespace tremie {

using Kinetics = std::variant<GatedKinetics,    // Kinetics{} is the first; scenes default to the last
                              RousselKinetics,  //
                              PowerKinetics,    //
                              RatePowerKinetics>;

/// Calls visit(K{}) for all kinetics K of the registry.
template <class Visit>
void for_each_kinetics(Visit visit) {
  for_each_of<Kinetics>(visit);
}

inline std::vector<std::string> kinetics_words() {
  std::vector<std::string> words;
  for_each_kinetics([&](const auto& k) { words.emplace_back(k.word); });
  return words;
}

/// Those of a word, with their default parameters; empty: there are none.
inline std::optional<Kinetics> kinetics_named(std::string_view word) {
  std::optional<Kinetics> named;
  for_each_kinetics([&](const auto& k) {
    if (k.word == word) named = k;
  });
  return named;
}

inline std::string_view word(const Kinetics& kinetics) {
  return std::visit([](const auto& k) { return k.word; }, kinetics);
}
inline std::optional<double> gate(const Kinetics& kinetics) {
  return std::visit([](const auto& k) { return k.gate(); }, kinetics);
}
/// Roussel's alpha, where breakdown is in proportion to it; empty: kinetics have none.
inline std::optional<double> destructuration(const Kinetics& kinetics) {
  return std::visit(
      [](const auto& k) -> std::optional<double> {
        if constexpr (requires { k.alpha; }) return k.alpha;
        return std::nullopt;
      },
      kinetics);
}
inline bool breaks_down(const Kinetics& kinetics) {
  return std::visit([](const auto& k) { return k.breaks_down(); }, kinetics);
}
/// Whether breakdown goes with less than the first power of the shear rate, so that slow shear counts.
inline bool slow_shear_breaks_down(const Kinetics& kinetics) {
  const auto* by_power = std::get_if<RatePowerKinetics>(&kinetics);
  return by_power && by_power->rate_exponent < 1.0;
}
/// The shares of the parts of lambda that a point stores besides their sum: none where lambda is the whole state.
inline std::vector<double> part_shares(const Kinetics& kinetics) {
  std::vector<double> shares;
  std::visit(
      [&](const auto& k) {
        if constexpr (requires { k.modes; })
          for (const auto& mode : k.modes) shares.push_back(mode.share);
      },
      kinetics);
  return shares;
}
inline DecayFitRules decay_fit(const Kinetics& kinetics) {
  return std::visit([](const auto& k) { return k.decay_fit; }, kinetics);
}
inline Kinetics fitted(const Kinetics& kinetics, double alpha, double exponent, double gamma_c) {
  return std::visit([&](const auto& k) -> Kinetics { return k.fitted(alpha, exponent, gamma_c); }, kinetics);
}

/// The parameter of the key "mix.thixotropy." + name; null: they have none.
inline double* parameter(Kinetics& kinetics, std::string_view name) {
  return std::visit(
      [&](auto& k) {
        double* found = nullptr;
        for (const auto& key : k.keys())
          if (key.name.substr(key.name.rfind('.') + 1) == name) found = &(k.*key.member);
        return found;
      },
      kinetics);
}

}  // namespace tremie
