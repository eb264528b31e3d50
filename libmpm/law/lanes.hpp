#pragma once

// Eight numbers side by side, for loops over material points: one arithmetic operation for eight points where
// the processor has wide registers, the same bits where it has not.

#include <cstdint>
#include <cstring>

namespace tremie {

inline constexpr int n_lanes = 8;
using Lanes [[gnu::vector_size(64)]] = double;
using LaneMask [[gnu::vector_size(64)]] = std::int64_t;

inline Lanes all_lanes(double x) { return Lanes{} + x; }
inline Lanes max(const Lanes& a, const Lanes& b) { return a > b ? a : b; }
inline Lanes min(const Lanes& a, const Lanes& b) { return a < b ? a : b; }

inline double largest(const Lanes& a) {
  double m = a[0];
  for (int l = 1; l < n_lanes; ++l) m = a[l] > m ? a[l] : m;
  return m;
}
inline double sum(const Lanes& a) {
  double s = a[0];
  for (int l = 1; l < n_lanes; ++l) s += a[l];
  return s;
}

inline Lanes sqrt(const Lanes& a) {
  Lanes r;
  for (int l = 0; l < n_lanes; ++l) r[l] = __builtin_sqrt(a[l]);
  return r;
}

namespace detail {
/// Adding it to |x| < 2^51 leaves the nearest whole number in the low bits.
inline constexpr double round_to_whole = 6755399441055744.0;  // 1.5 * 2^52
}  // namespace detail

/// Largest whole number that is not above x, |x| < 2^51.
inline Lanes floor(const Lanes& x) {
  const Lanes nearest = (x + detail::round_to_whole) - detail::round_to_whole;
  return nearest > x ? nearest - 1.0 : nearest;
}

/// e^x for |x| <= 700 to 2e-16 relative; beyond, e^-700 or e^700.
inline Lanes exp(const Lanes& x) {
  const Lanes y = max(min(x, all_lanes(700.0)), all_lanes(-700.0));
  const Lanes shifted = y * 1.4426950408889634 + detail::round_to_whole;
  const Lanes k = shifted - detail::round_to_whole;
  const Lanes r = (y - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;  // ln 2 in two parts
  // Taylor's polynomial on |r| <= ln 2 / 2: the first term left out is 4e-18.
  Lanes p = all_lanes(1.0 / 6227020800.0);
  constexpr double coefficients[] = {1.0 / 479001600.0,
                                     1.0 / 39916800.0,
                                     1.0 / 3628800.0,
                                     1.0 / 362880.0,
                                     1.0 / 40320.0,
                                     1.0 / 5040.0,
                                     1.0 / 720.0,
                                     1.0 / 120.0,
                                     1.0 / 24.0,
                                     1.0 / 6.0,
                                     0.5,
                                     1.0,
                                     1.0};
  for (double c : coefficients) p = p * r + c;
  LaneMask bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;  // 2^k; what the shift pushes out is the rounding constant
  Lanes scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
}

/// (1 - e^-x)/x for x >= 0, 1 at x = 0, to 1e-15 relative.
inline Lanes mean_decay(const Lanes& x) {
  // Below 1/2 the difference loses digits; there the series' first term left out is 5e-17.
  Lanes series = all_lanes(-1.0 / 87178291200.0);
  constexpr double coefficients[] = {1.0 / 6227020800.0,
                                     -1.0 / 479001600.0,
                                     1.0 / 39916800.0,
                                     -1.0 / 3628800.0,
                                     1.0 / 362880.0,
                                     -1.0 / 40320.0,
                                     1.0 / 5040.0,
                                     -1.0 / 720.0,
                                     1.0 / 120.0,
                                     -1.0 / 24.0,
                                     1.0 / 6.0,
                                     -0.5,
                                     1.0};
  for (double c : coefficients) series = series * x + c;
  const Lanes direct = (1.0 - exp(-x)) / max(x, all_lanes(0.5));
  return x < 0.5 ? series : direct;
}

}  // namespace tremie
