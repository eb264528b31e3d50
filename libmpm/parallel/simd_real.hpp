#pragma once

// Eight numbers of either precision side by side.

#include <array>
#include <cstring>

#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// Eight numbers of a type.
template <class Real>
using SimdOf = std::conditional_t<std::is_same_v<Real, float>, f32x8, f64x8>;

template <class Real>
SimdOf<Real> to_real(const f64x8& a) {
  return __builtin_convertvector(a, SimdOf<Real>);
}
inline f64x8 to_double(const f64x8& a) { return a; }
inline f64x8 to_double(const f32x8& a) {
#ifdef __AVX512F__  // the compiler would convert by halves
  return _mm512_maskz_cvtps_pd(0xff, a);
#else
  return __builtin_convertvector(a, f64x8);
#endif
}

inline f32x8 max(const f32x8& a, const f32x8& b) { return a > b ? a : b; }
inline f32x8 min(const f32x8& a, const f32x8& b) { return a < b ? a : b; }
/// Whole number next to x, the even one of two, and the largest that is not above x; |x| < 2^22.
inline f32x8 nearest(const f32x8& x) {
  constexpr float round = 12582912.0F;  // 1.5 * 2^23: sums with it have no fraction
  return (x + round) - round;
}
inline f32x8 floor(const f32x8& x) {
  const f32x8 near = nearest(x);
  return near > x ? near - 1 : near;
}

/// Whole numbers that are kept as numbers of another kind.
template <class T>
std::array<int, f64x8_size> to_whole(const T& a) {
  const auto converted = __builtin_convertvector(a, i32x8);
  std::array<int, f64x8_size> whole;
  std::memcpy(whole.data(), &converted, sizeof converted);
  return whole;
}

}  // namespace tremie
