#pragma once

// Numbers side by side, eight of them for loops over material points: one arithmetic operation for all of them where the
// processor has wide registers, the same bits where it has not.

#include <array>
#include <cstdint>
#include <cstring>
#include <type_traits>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace tremie {

inline constexpr int f64x8_size = 8;
using f64x8 [[gnu::vector_size(64)]] = double;
using i64x8 [[gnu::vector_size(64)]] = std::int64_t;

/// std::bit_cast, which the browser's standard library lacks.
template <class To, class From>
To bit_cast(const From& from) {
  static_assert(sizeof(To) == sizeof(From));
  To to;
  std::memcpy(&to, &from, sizeof to);
  return to;
}

inline f64x8 all_lanes(double x) { return f64x8{x, x, x, x, x, x, x, x}; }

/// Eight in single precision, and eight of a type.
using f32x8 [[gnu::vector_size(32)]] = float;
using i32x8 [[gnu::vector_size(32)]] = int;

// Four numbers, as a node has them, and sixteen.
using f64x4 [[gnu::vector_size(32)]] = double;
using f32x4 [[gnu::vector_size(16)]] = float;
using f32x16 [[gnu::vector_size(64)]] = float;

template <class Real>
using SimdOf = std::conditional_t<std::is_same_v<Real, float>, f32x8, f64x8>;

// a > b ? a : b and a < b ? a : b in each lane.
#ifdef __AVX512F__  // among other arithmetic the compiler would make two instructions of each
inline f64x8 max(const f64x8& a, const f64x8& b) { return _mm512_maskz_max_pd(0xff, a, b); }
inline f64x8 min(const f64x8& a, const f64x8& b) { return _mm512_maskz_min_pd(0xff, a, b); }
#else
inline f64x8 max(const f64x8& a, const f64x8& b) { return a > b ? a : b; }
inline f64x8 min(const f64x8& a, const f64x8& b) { return a < b ? a : b; }
#endif
inline f32x8 max(const f32x8& a, const f32x8& b) { return a > b ? a : b; }
inline f32x8 min(const f32x8& a, const f32x8& b) { return a < b ? a : b; }

/// Scalar type of a SIMD vector or of a scalar.
template <class T>
using ScalarOf = std::conditional_t<std::is_same_v<T, f32x8>, float, double>;

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

inline double largest(const f64x8& a) {
  double m = a[0];
  for (int l = 1; l < f64x8_size; ++l) m = a[l] > m ? a[l] : m;
  return m;
}
inline double sum(const f64x8& a) {
  double s = a[0];
  for (int l = 1; l < f64x8_size; ++l) s += a[l];
  return s;
}

/// The lanes as integers, where they hold whole numbers of another type.
template <class T>
std::array<int, f64x8_size> to_integers(const T& a) {
  return bit_cast<std::array<int, f64x8_size>>(__builtin_convertvector(a, i32x8));
}

/// Whether a mask has any lane.
inline bool any(const i64x8& a) {
#ifdef __AVX512F__  // lane by lane it would cost more than what it saves
  return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(a)) != 0;
#else
  std::int64_t bits = a[0];
  for (int l = 1; l < f64x8_size; ++l) bits |= a[l];
  return bits != 0;
#endif
}

inline f64x8 sqrt(const f64x8& a) {
  f64x8 r;
  for (int l = 0; l < f64x8_size; ++l) r[l] = __builtin_sqrt(a[l]);
  return r;
}

namespace detail {
/// Adding it to |x| < 2^51 leaves the nearest whole number in the low bits.
inline constexpr double round_to_whole = 6755399441055744.0;  // 1.5 * 2^52
/// Sum of c[k] x^k, by pairs of terms, pairs of pairs and so on (Estrin): few steps wait for another.
inline f64x8 polynomial(const f64x8& x, const double (&c)[14]) {
  const f64x8 x2 = x * x, x4 = x2 * x2, x8 = x4 * x4;
  const auto two = [&](int k) { return c[k] + x * c[k + 1]; };
  const auto four = [&](int k) { return two(k) + x2 * two(k + 2); };
  return (four(0) + x4 * four(4)) + x8 * (four(8) + x4 * two(12));
}
}  // namespace detail

/// Whole number next to x, |x| < 2^51; the even one of two.
inline f64x8 nearest(const f64x8& x) {
#ifdef __AVX512F__
  return _mm512_maskz_roundscale_pd(0xff, x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#else
  return (x + detail::round_to_whole) - detail::round_to_whole;
#endif
}
/// Largest whole number that is not above x, |x| < 2^51.
inline f64x8 floor(const f64x8& x) {
#ifdef __AVX512F__
  return _mm512_maskz_roundscale_pd(0xff, x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#else
  const f64x8 near = nearest(x);
  return near > x ? near - 1.0 : near;
#endif
}
/// Whole number next to x, the even one of two, and the largest that is not above x; |x| < 2^22.
inline f32x8 nearest(const f32x8& x) {
  constexpr float round = 12582912.0F;  // 1.5 * 2^23: sums with it have no fraction
  return (x + round) - round;
}
inline f32x8 floor(const f32x8& x) {
  const f32x8 near = nearest(x);
  return near > x ? near - 1 : near;
}

/// e^x for |x| <= 700 to 2e-16 relative; beyond, e^-700 or e^700.
inline f64x8 exp(const f64x8& x) {
  const f64x8 y = max(min(x, all_lanes(700.0)), all_lanes(-700.0));
  const f64x8 shifted = y * 1.4426950408889634 + detail::round_to_whole;
  const f64x8 k = shifted - detail::round_to_whole;
  const f64x8 r = (y - k * 6.93147180369123816490e-01) - k * 1.90821492927058770002e-10;  // ln 2 in two parts
  // Taylor's polynomial on |r| <= ln 2 / 2: the first term left out is 4e-18.
  const f64x8 p = detail::polynomial(
      r, {1.0, 1.0, 0.5, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0, 1.0 / 5040.0, 1.0 / 40320.0,
          1.0 / 362880.0, 1.0 / 3628800.0, 1.0 / 39916800.0, 1.0 / 479001600.0, 1.0 / 6227020800.0});
  // 2^k; what the shift pushes out is the rounding constant
  const i64x8 bits = (bit_cast<i64x8>(shifted) + 1023) << 52;
  return p * bit_cast<f64x8>(bits);
}

/// e^-x for x >= 0, to 2e-16 relative; without e^x's range reduction where no lane is above 1/500, as in
/// steps that resolve what decays.
inline f64x8 decay(const f64x8& x) {
  if (any(~i64x8(x < 0.002))) return exp(-x);
  return 1.0 - x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x * (1.0 / 120.0)))));
}

/// (1 - e^-x)/x for x >= 0, 1 at x = 0, to 1e-15 relative.
inline f64x8 mean_decay(const f64x8& x) {
  // Below 1/2 the difference loses digits; there the series' first term left out is 5e-17.
  const f64x8 series =
      detail::polynomial(x, {1.0, -0.5, 1.0 / 6.0, -1.0 / 24.0, 1.0 / 120.0, -1.0 / 720.0, 1.0 / 5040.0,
                             -1.0 / 40320.0, 1.0 / 362880.0, -1.0 / 3628800.0, 1.0 / 39916800.0,
                             -1.0 / 479001600.0, 1.0 / 6227020800.0, -1.0 / 87178291200.0});
  const i64x8 near = x < 0.5;
  if (!any(~near)) return series;
  const f64x8 direct = (1.0 - exp(-x)) / max(x, all_lanes(0.5));
  return near ? series : direct;
}

}  // namespace tremie
