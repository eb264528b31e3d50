#pragma once

// The scene keys of the yield laws, as the laws state them (libmpm/constitutive/laws/law_interface.hpp): parameters of
// [model] beside model.yield, and those of [mix] that take the place of plastic_viscosity. Those of the wall laws
// (libmpm/boundary/wall_law_interface.hpp): parameters beside `contact`, of [floor] or [walls].

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"
#include "libmpm/boundary/wall_law.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"

namespace tremie::scene {

/// "mix.thixotropy" and "exponent" of "mix.thixotropy.exponent".
inline std::string_view section_of(std::string_view key) { return key.substr(0, key.rfind('.')); }
inline std::string name_of(std::string_view key) { return std::string(key.substr(key.rfind('.') + 1)); }

/// The key of a parameter of a law or of kinetics.
template <class L>
Key scene_key(const LawKey<L>& of_law) {
  Key key{.name = name_of(of_law.name)};
  key.kind = of_law.unit.empty() ? Kind::number : Kind::quantity;
  if (!of_law.unit.empty()) key.dimension = dimension_of(of_law.unit);
  key.range = {.low = of_law.low, .high = of_law.high, .low_open = of_law.low_open};
  key.fallback = of_law.fallback;
  key.example = of_law.example;
  key.help = of_law.help;
  return key;
}

template <class T>
void add_once(std::vector<T>& list, const T& item) {
  if (std::find(list.begin(), list.end(), item) == list.end()) list.push_back(item);
}

/// model.yield and the laws' parameters in [model].
std::vector<Key> law_model_keys();

/// plastic_viscosity, and what a law may have in its place.
std::vector<Key> viscosity_keys();

/// One description of the viscous part is left: that of the later layer. Throws InputError where a layer gives two, or
/// where no law has model.yield with these keys.
void settle_law(Values& values);

/// The law that model.yield and the keys of [mix] name, with its parameters.
YieldLaw read_law(const Values& values);

/// `contact` and the wall laws' parameters; `friction`: those that follow the pressure too.
std::vector<Key> contact_keys(bool friction = true);

/// One description of the interface's yield stress is left: that of the later layer. Throws InputError where it has none
/// or two, or where explicit steps would have to know it.
void settle_interface(Values& values, const std::string& section);

/// The wall law that the `contact` of a section names, with its parameters.
WallLaw read_wall_law(const Values& values, const std::string& section);

}  // namespace tremie::scene
