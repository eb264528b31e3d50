#pragma once

// The update of flocculation.hpp for points side by side.

#include "libmpm/constitutive/flocculation.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// detail::Decay::asymmetry of flocculation.hpp: (k coth(k/2) - 2)/k^2, by its series (error 1e-15) below
/// 1/2. `d` is mean_decay(k).
inline f64x8 decay_asymmetry(const f64x8& k, const f64x8& d) {
  const f64x8 one = all_lanes(1.0), x = k * k;
  const i64x8 small = k < 0.5;
  const f64x8 far = (2.0 * (one - d) / d - k) / (small ? one : x);
  const f64x8 near =
      1.0 / 6.0 -
      x * (1.0 / 360.0 - x * (1.0 / 15120.0 -
                              x * (1.0 / 604800.0 - x * (1.0 / 23950080.0 - x * (691.0 / 653837184000.0)))));
  return small ? near : far;
}

/// flocculation_step of flocculation.hpp.
inline f64x8 flocculation_step(const f64x8& lambda, const Thixotropy& t, double tau_0, const f64x8& gamma_0,
                               const f64x8& gamma_1, double dt) {
  if (t.kinetics == Kinetics::power) {
    f64x8 next = lambda;
    for (int l = 0; l < 8; ++l) next[l] = flocculation_step(lambda[l], t, tau_0, gamma_0[l], gamma_1[l], dt);
    return next;
  }
  const double built = t.A_thix / tau_0 * dt, half = 0.5 * t.alpha * dt;
  if (t.kinetics == Kinetics::roussel) {
    const f64x8 k = half * (gamma_0 + gamma_1), d = mean_decay(k);
    const f64x8 one = all_lanes(1.0), left = d * exp(-(half * (gamma_1 - gamma_0) * decay_asymmetry(k, d)));
    return lambda * (1.0 - k * d) + built * (left < one ? left : one);
  }
  const f64x8 none = {}, gate = none + t.gamma_c;
  const i64x8 rest_0 = gamma_0 < t.gamma_c, rest_1 = gamma_1 < t.gamma_c;
  const i64x8 crosses = rest_0 ^ rest_1;
  if (!any(crosses)) return rest_0 ? lambda + built : lambda * decay(half * (gamma_0 + gamma_1));
  // Before and after the crossing of gamma_c at the share theta of the step.
  const f64x8 theta = crosses ? (gate - gamma_0) / (crosses ? gamma_1 - gamma_0 : none + 1.0) : none + 1.0;
  const f64x8 before = rest_0 ? built * theta : none;
  const f64x8 after = (crosses & rest_1) ? built * (1.0 - theta) : none;
  const f64x8 flow_0 = rest_0 ? none : half * theta * (gamma_0 + (crosses ? gate : gamma_1));
  const f64x8 flow_1 = (crosses & rest_0) ? half * (1.0 - theta) * (gate + gamma_1) : none;
  return (lambda + before) * decay(flow_0 + flow_1) + after;
}

}  // namespace tremie
