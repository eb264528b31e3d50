#pragma once

// The equations of the kinetics of lambda as the references integrate them (CVODE, IDA, ARKODE), written from the equation
// alone: no update of libmpm/constitutive is called here. For each kinetics: right_hand_side, derivatives and check.
//
//   roussel   d lambda/dt = A_thix/tau_0 - alpha lambda gamma_dot                    equation (3)
//   gated     d lambda/dt = A_thix/tau_0            where gamma_dot <  gamma_c       equation (3) at rest
//             d lambda/dt = -alpha lambda gamma_dot where gamma_dot >= gamma_c       equation (4)
//   power     d lambda/dt = A_thix/tau_0 (1 - lambda/lambda_max) - alpha lambda^n gamma_dot, gated where gamma_c > 0
//   rate_power  the same with k gamma_dot^a in place of alpha gamma_dot, 0 where gamma_dot is; in modes lambda = sum
//             lambda_i, lambda_i = share_i x_i, x_i by the equation with factor_i k
//
// b is A_thix/tau_0 [1/s], `flowing` the side of the gate; without a gate it has no meaning.

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <stdexcept>
#include <vector>

#include "libmpm/constitutive/flocculation.hpp"

namespace tremie::kinetics_equations {

/// Derivatives of the right-hand side, build(lambda) - k broken(lambda, gamma_dot); those of a term that does not act
/// are 0.
struct Derivatives {
  double build_by_lambda = 0.0;
  double k = 0.0, broken_by_lambda = 0.0, broken_by_rate = 0.0;
};

inline void refuse_negative(std::initializer_list<double> values) {
  for (const double x : values)
    if (!(std::isfinite(x) && x >= 0.0))
      throw std::invalid_argument("A_thix, alpha, the critical shear rate and lambda must not be negative");
}

// --- roussel

inline void check(const RousselKinetics& r) { refuse_negative({r.alpha}); }
inline double right_hand_side(const RousselKinetics& r, double b, double lambda, double gamma_dot, bool) {
  return b - r.alpha * lambda * gamma_dot;
}
inline Derivatives derivatives(const RousselKinetics& r, double, double lambda, double gamma_dot, bool) {
  return {0.0, r.alpha, gamma_dot, lambda};
}

// --- gated

inline void check(const GatedKinetics& g) { refuse_negative({g.alpha, g.gamma_c}); }
inline double right_hand_side(const GatedKinetics& g, double b, double lambda, double gamma_dot,
                              bool flowing) {
  return flowing ? 0.0 - g.alpha * lambda * gamma_dot : b;
}
inline Derivatives derivatives(const GatedKinetics& g, double, double lambda, double gamma_dot,
                               bool flowing) {
  return flowing ? Derivatives{0.0, g.alpha, gamma_dot, lambda} : Derivatives{};
}

// --- power

inline void check(const PowerKinetics& p) {
  refuse_negative({p.alpha, p.gamma_c});
  if (!(p.exponent >= 1.0) || !(p.saturation > 0.0))
    throw std::invalid_argument("the exponent must be at least 1 and the saturation greater than 0");
}
inline double power_of(const PowerKinetics& p, double lambda) {
  return p.exponent == 1.0 ? lambda : std::pow(std::max(lambda, 0.0), p.exponent);
}
inline double right_hand_side(const PowerKinetics& p, double b, double lambda, double gamma_dot,
                              bool flowing) {
  const bool gated = p.gamma_c > 0.0;
  const double build = gated && flowing ? 0.0 : b * (1.0 - lambda * (1.0 / p.saturation));
  return gated && !flowing ? build : build - p.alpha * power_of(p, lambda) * gamma_dot;
}
inline Derivatives derivatives(const PowerKinetics& p, double b, double lambda, double gamma_dot,
                               bool flowing) {
  const bool gated = p.gamma_c > 0.0;
  const double build_by_lambda = gated && flowing ? 0.0 : -b * (1.0 / p.saturation);
  if (gated && !flowing) return {build_by_lambda};
  const double slope =
      p.exponent == 1.0 ? 1.0 : p.exponent * std::pow(std::max(lambda, 0.0), p.exponent - 1.0);
  return {build_by_lambda, p.alpha, slope * gamma_dot, power_of(p, lambda)};
}

// --- rate_power

inline void check(const RatePowerKinetics& r) {
  refuse_negative({r.breakdown, r.gamma_c, r.rate_exponent, 1.0 - r.rate_exponent});
  if (!(r.exponent >= 1.0) || !(r.saturation > 0.0))
    throw std::invalid_argument("the exponent must be at least 1 and the saturation greater than 0");
  for (const BreakdownMode& mode : r.modes) refuse_negative({mode.share, mode.factor});
}
/// gamma_dot^a and its derivative, which is taken at 1e-9 1/s at least, where it would be infinite.
inline double power_of_rate(const RatePowerKinetics& r, double gamma_dot) {
  return gamma_dot > 0.0 ? std::pow(gamma_dot, r.rate_exponent) : 0.0;
}
inline double right_hand_side(const RatePowerKinetics& r, double b, double lambda, double gamma_dot,
                              bool flowing) {
  const bool gated = r.gamma_c > 0.0;
  const double build = gated && flowing ? 0.0 : b * (1.0 - lambda / r.saturation);
  if (gated && !flowing) return build;
  return build - r.breakdown * std::pow(std::max(lambda, 0.0), r.exponent) * power_of_rate(r, gamma_dot);
}
inline Derivatives derivatives(const RatePowerKinetics& r, double b, double lambda, double gamma_dot,
                               bool flowing) {
  const bool gated = r.gamma_c > 0.0;
  const double build_by_lambda = gated && flowing ? 0.0 : -b / r.saturation;
  if (gated && !flowing) return {build_by_lambda};
  const double x = std::max(lambda, 0.0), slope = r.exponent * std::pow(x, r.exponent - 1.0);
  const double by_rate = r.rate_exponent * std::pow(std::max(gamma_dot, 1e-9), r.rate_exponent - 1.0);
  return {build_by_lambda, r.breakdown, slope * power_of_rate(r, gamma_dot),
          std::pow(x, r.exponent) * by_rate};
}

// --- parts of lambda: one, lambda itself, where kinetics have no modes

inline std::vector<BreakdownMode> modes_of(const Kinetics& kinetics) {
  const auto* r = std::get_if<RatePowerKinetics>(&kinetics);
  return r && !r->modes.empty() ? r->modes : std::vector<BreakdownMode>{{}};
}
/// The kinetics that part i follows over its share.
inline Kinetics of_part(const Kinetics& kinetics, const BreakdownMode& mode) {
  if (const auto* r = std::get_if<RatePowerKinetics>(&kinetics))
    return RatePowerKinetics{r->breakdown * mode.factor, r->rate_exponent, r->gamma_c, r->exponent,
                             r->saturation};
  return kinetics;
}

// --- chosen at run time; their names are others, so that kinetics without an equation do not compile

inline double rate_of_lambda(const Kinetics& kinetics, double b, double lambda, double gamma_dot,
                             bool flowing) {
  return std::visit([&](const auto& k) { return right_hand_side(k, b, lambda, gamma_dot, flowing); },
                    kinetics);
}
inline Derivatives derivatives_of(const Kinetics& kinetics, double b, double lambda, double gamma_dot,
                                  bool flowing) {
  return std::visit([&](const auto& k) { return derivatives(k, b, lambda, gamma_dot, flowing); }, kinetics);
}

/// Throws std::invalid_argument for parameters or a lambda that no equation takes.
inline void check(const Thixotropy& t, double lambda) {
  refuse_negative({t.A_thix, lambda});
  std::visit([](const auto& k) { check(k); }, t.kinetics);
}

}  // namespace tremie::kinetics_equations
