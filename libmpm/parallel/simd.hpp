#pragma once

// Eight numbers side by side, or sixteen in single precision, for loops over material points: one arithmetic
// operation for all of them where the processor has wide registers, the same bits where it has not.

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

inline f64x8 all_lanes(double x) { return f64x8{x, x, x, x, x, x, x, x}; }

/// f32x16 numbers in single precision.
using f32x16 [[gnu::vector_size(64)]] = float;
inline constexpr std::size_t f32x16_size = 16;
using i32x16 [[gnu::vector_size(64)]] = int;

// a > b ? a : b and a < b ? a : b in each lane.
#ifdef __AVX512F__  // among other arithmetic the compiler would make two instructions of each
inline f64x8 max(const f64x8& a, const f64x8& b) { return _mm512_maskz_max_pd(0xff, a, b); }
inline f64x8 min(const f64x8& a, const f64x8& b) { return _mm512_maskz_min_pd(0xff, a, b); }
inline f32x16 max(const f32x16& a, const f32x16& b) { return _mm512_maskz_max_ps(0xffff, a, b); }
inline f32x16 min(const f32x16& a, const f32x16& b) { return _mm512_maskz_min_ps(0xffff, a, b); }
#else
inline f64x8 max(const f64x8& a, const f64x8& b) { return a > b ? a : b; }
inline f64x8 min(const f64x8& a, const f64x8& b) { return a < b ? a : b; }
inline f32x16 max(const f32x16& a, const f32x16& b) { return a > b ? a : b; }
inline f32x16 min(const f32x16& a, const f32x16& b) { return a < b ? a : b; }
#endif

inline f32x16 sqrt(const f32x16& a) {
  f32x16 r;
  for (std::size_t l = 0; l < f32x16_size; ++l) r[l] = __builtin_sqrtf(a[l]);
  return r;
}

/// The number type of a vector of them, or of one.
template <class T>
using ScalarOf = std::conditional_t<std::is_same_v<T, f32x16>, float, double>;

/// Two octets as one vector of singles, and one half of such a vector as an octet.
using f32x8 [[gnu::vector_size(32)]] = float;
inline f32x16 to_single(const f64x8& a, const f64x8& b) {
  const f32x8 low = __builtin_convertvector(a, f32x8), high = __builtin_convertvector(b, f32x8);
#ifdef __AVX512F__
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
#else  // the compiler takes shuffles that the processor has not lane by lane, and minutes for it
  const f32x8 halves[2] = {low, high};
  f32x16 both;
  std::memcpy(&both, halves, sizeof both);
  return both;
#endif
}
inline f64x8 to_double(const f32x16& a, int half) {
#ifdef __AVX512F__
  // The compiler would convert by quarters.
  const f32x8 one = half == 0 ? __builtin_shufflevector(a, a, 0, 1, 2, 3, 4, 5, 6, 7)
                              : __builtin_shufflevector(a, a, 8, 9, 10, 11, 12, 13, 14, 15);
  return _mm512_maskz_cvtps_pd(0xff, one);
#else
  f32x8 halves[2];
  std::memcpy(halves, &a, sizeof halves);
  return __builtin_convertvector(halves[half], f64x8);
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

using i32x8 [[gnu::vector_size(32)]] = int;

/// Whole numbers that are kept as doubles.
inline void to_whole(const f64x8& a, std::array<int, f64x8_size>& whole) {
  const auto converted = __builtin_convertvector(a, i32x8);
  std::memcpy(whole.data(), &converted, sizeof converted);
}

/// table[at[l]] in each lane.
inline f64x8 look_up(const double* table, const std::array<int, f64x8_size>& at) {
#ifdef __AVX512F__
  const __m256i indices = _mm256_loadu_si256(reinterpret_cast<const __m256i*>(at.data()));
  return _mm512_mask_i32gather_pd(f64x8{}, 0xff, indices, table, 8);
#else
  f64x8 r;
  for (std::size_t l = 0; l < f64x8_size; ++l) r[l] = table[at[l]];
  return r;
#endif
}

/// The same of sixteen, from a table whose entries are `stride` bytes apart.
template <std::size_t stride>
f32x16 look_up(const float* table, const std::array<int, f64x8_size>& a,
               const std::array<int, f64x8_size>& b) {
  constexpr int step = stride / sizeof(float);
  static_assert(stride % sizeof(float) == 0);
#ifdef __AVX512F__
  const std::array<int, f64x8_size> both[2] = {a, b};
  i32x16 at;
  std::memcpy(&at, both, sizeof at);
  at *= step;
  return _mm512_mask_i32gather_ps(f32x16{}, 0xffff, reinterpret_cast<__m512i>(at), table, 4);
#else
  f32x16 r;
  for (std::size_t l = 0; l < f64x8_size; ++l)
    r[l] = table[step * a[l]], r[f64x8_size + l] = table[step * b[l]];
  return r;
#endif
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

inline bool any(const i32x16& a) {
#ifdef __AVX512F__
  return _mm512_test_epi32_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(a)) != 0;
#else
  int bits = a[0];
  for (std::size_t l = 1; l < f32x16_size; ++l) bits |= a[l];
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
/// The same for |x| < 2^22 in single precision.
inline constexpr float round_single_to_whole = 12582912.0F;  // 1.5 * 2^23

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
/// The same for |x| < 2^22.
inline f32x16 nearest(const f32x16& x) {
#ifdef __AVX512F__
  return _mm512_maskz_roundscale_ps(0xffff, x, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC);
#else
  return (x + detail::round_single_to_whole) - detail::round_single_to_whole;
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
/// The same for |x| < 2^22.
inline f32x16 floor(const f32x16& x) {
#ifdef __AVX512F__
  return _mm512_maskz_roundscale_ps(0xffff, x, _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC);
#else
  const f32x16 near = nearest(x);
  return near > x ? near - 1 : near;
#endif
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
  i64x8 bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 1023) << 52;  // 2^k; what the shift pushes out is the rounding constant
  f64x8 scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
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

/// e^x in single precision for |x| <= 80, to 2e-7 relative; beyond, e^-80 or e^80.
inline f32x16 exp(const f32x16& x) {
  const f32x16 y = max(min(x, 80 - f32x16{}), -80 - f32x16{});
  const f32x16 shifted = y * 1.44269504F + detail::round_single_to_whole;
  const f32x16 k = shifted - detail::round_single_to_whole;
  const f32x16 r = (y - k * 0.693359375F) + k * 2.12194440e-4F;  // ln 2 in two parts
  // Taylor's polynomial on |r| <= ln 2 / 2: the first term left out is 5e-9.
  const f32x16 r2 = r * r;
  const f32x16 p =
      ((1 + r) + r2 * (0.5F + r * (1.0F / 6.0F))) +
      (r2 * r2) * ((1.0F / 24.0F + r * (1.0F / 120.0F)) + r2 * (1.0F / 720.0F + r * (1.0F / 5040.0F)));
  i32x16 bits;
  std::memcpy(&bits, &shifted, sizeof bits);
  bits = (bits + 127) << 23;  // 2^k; what the shift pushes out is the rounding constant
  f32x16 scale;
  std::memcpy(&scale, &bits, sizeof scale);
  return p * scale;
}

/// (1 - e^-x)/x in single precision for x >= 0, 1 at x = 0, to 3e-7 relative.
inline f32x16 mean_decay(const f32x16& x) {
  // Below 1/2 the difference loses digits; there the series' first term left out is 5e-10.
  const f32x16 x2 = x * x, x4 = x2 * x2;
  const f32x16 series =
      ((1 - x * 0.5F) + x2 * (1.0F / 6.0F - x * (1.0F / 24.0F))) +
      x4 * (((1.0F / 120.0F - x * (1.0F / 720.0F)) + x2 * (1.0F / 5040.0F - x * (1.0F / 40320.0F))) +
            x4 * (1.0F / 362880.0F));
  const i32x16 near = x < 0.5F;
  if (!any(~near)) return series;
  const f32x16 direct = (1 - exp(-x)) / max(x, 0.5F - f32x16{});
  return near ? series : direct;
}

}  // namespace tremie
