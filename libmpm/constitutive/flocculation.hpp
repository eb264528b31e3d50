#pragma once

// The flocculation state lambda of one material point, after Wilkes, Kumar and Biscontin: it is built up at the rate
// A_thix / tau_0 and broken down by shear, as the kinetics have it (kinetics.hpp), and gives the static yield stress
// (1 + lambda) tau_0, equation (7).
//
// Shear rates in 1/s, times in s, stresses in Pa; lambda has no unit.

#include "libmpm/constitutive/kinetics.hpp"

namespace tremie {

struct Thixotropy {
  double A_thix = 0.0;  ///< structuration rate at rest [Pa/s]
  Kinetics kinetics = {};
  double initial_flocculation = 0;  ///< lambda before any rest
  /// The shear rate that breaks structure down is its mean over the concrete within this length, weighted by 1 -
  /// distance/layer [m]; 0: the rate at the point itself.
  double layer = 0.0;
};

/// lambda after a rest of duration `rest`, in closed form.
inline double flocculation_after_rest(double lambda, const Thixotropy& t, double tau_0, double rest) {
  return std::visit([&](const auto& k) { return k.after_rest(lambda, t.A_thix, tau_0, rest); }, t.kinetics);
}

/// lambda at the end of a step of length dt in which the shear rate went from gamma_0 to gamma_1.
inline double flocculation_step(double lambda, const Thixotropy& t, double tau_0, double gamma_0,
                                double gamma_1, double dt) {
  const double build_rate = t.A_thix / tau_0;
  return std::visit([&](const auto& k) { return k.update(lambda, build_rate, gamma_0, gamma_1, dt); },
                    t.kinetics);
}

/// The same where lambda may have parts: part(i) is the place of part i.
template <class Part>
double flocculation_step(double lambda, const Thixotropy& t, double tau_0, double gamma_0, double gamma_1,
                         double dt, const Part& part) {
  const double build_rate = t.A_thix / tau_0;
  return std::visit(
      [&](const auto& k) {
        if constexpr (requires { k.modes; }) {
          double sum = 0.0;
          for (std::size_t i = 0; i < k.modes.size(); ++i) {
            const double share = k.modes[i].share;
            part(i) = share * k.of_mode(i).update(part(i) / share, build_rate, gamma_0, gamma_1, dt);
            sum += part(i);
          }
          if (!k.modes.empty()) return sum;
        }
        return k.update(lambda, build_rate, gamma_0, gamma_1, dt);
      },
      t.kinetics);
}

/// The same for points side by side: the kinetics' own, or one by one.
inline f64x8 flocculation_step(const f64x8& lambda, const Thixotropy& t, double tau_0, const f64x8& gamma_0,
                               const f64x8& gamma_1, double dt) {
  const double build_rate = t.A_thix / tau_0;
  return std::visit(
      [&](const auto& k) -> f64x8 {
        if constexpr (requires { k.simd_update(lambda, build_rate, gamma_0, gamma_1, dt); }) {
          return k.simd_update(lambda, build_rate, gamma_0, gamma_1, dt);
        } else {
          f64x8 next = lambda;
          for (int l = 0; l < f64x8_size; ++l)
            next[l] = k.update(lambda[l], build_rate, gamma_0[l], gamma_1[l], dt);
          return next;
        }
      },
      t.kinetics);
}

/// lambda after a step of length dt from the time `start` of a history, in which rate(time) [1/s] gives the
/// shear rate. gamma_0 and gamma_1 are its values at the ends of the step, which the neighbouring steps
/// share. Sixth order where the rate is smooth, through a gate too; exact at constant rate; positive and bounded for
/// every dt. Kinetics without update_along take the rate at the ends alone: second order.
template <class Rate>
double flocculation_step_along(double lambda, const Thixotropy& t, double tau_0, const Rate& rate,
                               double start, double gamma_0, double gamma_1, double dt) {
  const double build_rate = t.A_thix / tau_0;
  return std::visit(
      [&](const auto& k) {
        if constexpr (requires { k.update_along(lambda, build_rate, rate, start, gamma_0, gamma_1, dt); }) {
          return k.update_along(lambda, build_rate, rate, start, gamma_0, gamma_1, dt);
        } else {
          return k.update(lambda, build_rate, gamma_0, gamma_1, dt);
        }
      },
      t.kinetics);
}

/// Static yield stress, equation (7) [Pa].
inline double static_yield_stress(double lambda, double tau_0) { return (1.0 + lambda) * tau_0; }

}  // namespace tremie
