#pragma once

// The registry of yield laws: one line a law. What a law states is in law_interface.hpp. Implicit and explicit
// steps, the material cell, Couette flow and the scene's keys go through this variant and name no law.

#include <cmath>
#include <cstddef>
#include <variant>

#include "libmpm/constitutive/laws/bi_viscous.hpp"
#include "libmpm/constitutive/laws/bingham.hpp"
#include "libmpm/constitutive/laws/herschel_bulkley.hpp"
#include "libmpm/constitutive/laws/papanastasiou.hpp"

namespace tremie {

using YieldLaw = std::variant<ExactBingham,     //
                              Papanastasiou,    //
                              BiViscous,        //
                              HerschelBulkley,  //
                              RegularisedHerschelBulkley>;

/// Calls visit(L{}) for every law L of the registry.
template <class Visit>
void for_each_law(Visit visit) {
  for_each_of<YieldLaw>(visit);
}

// The functions of law_interface.hpp for a law that is known at run time. Loops over many points visit the variant
// once, outside.

inline double secant(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.secant(gamma_dot, tau_y); }, law);
}
inline double slope(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.slope(gamma_dot, tau_y); }, law);
}
inline double potential(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.potential(gamma_dot, tau_y); }, law);
}
inline double dual_limit(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.dual_limit(gamma_dot, tau_y); }, law);
}
inline double prox(const YieldLaw& law, double a, double tau_y, double r) {
  return std::visit([&](const auto& l) { return l.prox(a, tau_y, r); }, law);
}
inline double stress(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.stress(gamma_dot, tau_y); }, law);
}
inline double viscosity(const YieldLaw& law, double gamma_dot, double tau_y) {
  return std::visit([&](const auto& l) { return l.viscosity(gamma_dot, tau_y); }, law);
}
inline double newtonian(const YieldLaw& law) {
  return std::visit([](const auto& l) { return l.newtonian(); }, law);
}
inline double largest_secant(const YieldLaw& law, double tau_y) {
  return std::visit([&](const auto& l) { return l.largest_secant(tau_y); }, law);
}
inline bool is_exact(const YieldLaw& law) {
  return std::visit([](const auto& l) { return l.exact; }, law);
}
/// Whether the law takes the place of the mix's plastic viscosity.
inline bool is_viscous(const YieldLaw& law) {
  return std::visit([](const auto& l) { return l.viscous; }, law);
}

/// The secant of points side by side: a law's own, or one by one.
template <class Simd>
Simd secant(const YieldLaw& law, const Simd& gamma_dot, const Simd& tau_y) {
  return std::visit(
      [&](const auto& l) -> Simd {
        if constexpr (requires { l.simd_secant(gamma_dot, tau_y); }) {
          return l.simd_secant(gamma_dot, tau_y);
        } else {
          Simd s{};
          for (std::size_t i = 0; i < sizeof(Simd) / sizeof(gamma_dot[0]); ++i)
            s[i] = static_cast<ScalarOf<Simd>>(l.secant(gamma_dot[i], tau_y[i]));
          return s;
        }
      },
      law);
}

}  // namespace tremie
