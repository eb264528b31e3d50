#pragma once

// The registry of wall laws: one line a law. What a law states is in wall_law_interface.hpp. Implicit and explicit steps
// and the scene's keys go through this variant and name no law.

#include <optional>
#include <string>
#include <variant>

#include "libmpm/boundary/coulomb.hpp"
#include "libmpm/boundary/free_slip.hpp"
#include "libmpm/boundary/interface.hpp"
#include "libmpm/boundary/no_slip.hpp"

namespace tremie {

using WallLaw = std::variant<NoSlip, Coulomb, Interface, FreeSlip>;

/// Calls visit(L{}) for every law L of the registry.
template <class Visit>
void for_each_wall_law(Visit visit) {
  for_each_of<WallLaw>(visit);
}

inline FaceKind face(const WallLaw& law) {
  return std::visit([](const auto& l) { return l.face; }, law);
}
inline double yield_force(const WallLaw& law, double pressing) {
  return std::visit(
      [&](const auto& l) {
        if constexpr (requires { l.yield_force(pressing); })
          return l.yield_force(pressing);
        else
          return 0.0;
      },
      law);
}
/// Empty for a law that states none.
inline std::optional<WallStress> wall_stress(const WallLaw& law) {
  return std::visit(
      [](const auto& l) -> std::optional<WallStress> {
        if constexpr (requires { l.stress(); })
          return l.stress();
        else
          return std::nullopt;
      },
      law);
}
inline bool follows_pressure(const WallLaw& law) {
  return std::visit([](const auto& l) { return l.follows_pressure; }, law);
}
inline double bears(const WallLaw& law, double pressure) {
  return std::visit([&](const auto& l) { return l.bears(pressure); }, law);
}
inline std::string word(const WallLaw& law) {
  return std::visit([](const auto& l) { return std::string(l.word); }, law);
}
inline const char* use(const WallLaw& law) {
  return std::visit([](const auto& l) { return l.use; }, law);
}

}  // namespace tremie
