#pragma once

// Numbers side by side. A vector is at most as wide as a register of the processor; what is wider is a pair of halves, and
// an operation on it is two on them. (Of a vector that no register holds g++ makes and moves one number at a time, through
// memory.) So one code serves every width, with the same bits in each lane.

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace tremie {

#if defined(__AVX512F__)
inline constexpr int simd_bytes = 64;  ///< of a register
#elif defined(__AVX__)
inline constexpr int simd_bytes = 32;
#else
inline constexpr int simd_bytes = 16;
#endif

/// What is too wide for a register.
template <class Half>
struct SimdPair {
  Half low, high;

  using Number = std::remove_cvref_t<decltype(std::declval<Half>()[0])>;
  static constexpr int size = 2 * static_cast<int>(sizeof(Half) / sizeof(Number));

  SimdPair() = default;
  // By its halves: g++ would copy the whole in pieces of 16 bytes, which a wider load has to wait for.
  [[gnu::always_inline]] SimdPair(const SimdPair& b) : low(b.low), high(b.high) {}
  [[gnu::always_inline]] SimdPair& operator=(const SimdPair& b) {
    low = b.low, high = b.high;
    return *this;
  }
  [[gnu::always_inline]] SimdPair(const Half& first, const Half& second) : low(first), high(second) {}
  template <class... Numbers>
  requires(sizeof...(Numbers) == size && (std::is_arithmetic_v<Numbers> && ...))
      SimdPair(Numbers... numbers) {
    const Number all[] = {static_cast<Number>(numbers)...};
    std::memcpy(static_cast<void*>(this), all, sizeof all);
  }
  template <std::integral Lane>
  [[gnu::always_inline]] Number& operator[](Lane lane) {
    return reinterpret_cast<Number*>(this)[lane];
  }
  template <std::integral Lane>
  [[gnu::always_inline]] const Number& operator[](Lane lane) const {
    return reinterpret_cast<const Number*>(this)[lane];
  }
  template <class Other>
  [[gnu::always_inline]] SimdPair& operator+=(const Other& b) {
    return *this = *this + b;
  }
  template <class Other>
  [[gnu::always_inline]] SimdPair& operator-=(const Other& b) {
    return *this = *this - b;
  }
  template <class Other>
  [[gnu::always_inline]] SimdPair& operator*=(const Other& b) {
    return *this = *this * b;
  }
  template <class Other>
  [[gnu::always_inline]] SimdPair& operator|=(const Other& b) {
    return *this = *this | b;
  }
};

namespace detail {

template <class T>
inline constexpr bool is_pair = false;
template <class Half>
inline constexpr bool is_pair<SimdPair<Half>> = true;

template <class T, int n, bool fits = n * sizeof(T) <= simd_bytes>
struct SimdType {
  using Type [[gnu::vector_size(n * sizeof(T))]] = T;
};
template <class T, int n>
struct SimdType<T, n, false> {
  using Type = SimdPair<typename SimdType<T, n / 2>::Type>;
};

}  // namespace detail

/// n numbers of type T side by side.
template <class T, int n>
using Simd = typename detail::SimdType<T, n>::Type;

using f64x4 = Simd<double, 4>;  ///< as a node has them
using f64x8 = Simd<double, 8>;  ///< one a point, in loops over points
using f32x4 = Simd<float, 4>;
using f32x8 = Simd<float, 8>;
inline constexpr int f64x8_size = 8;

template <class Real>
using SimdOf = Simd<Real, f64x8_size>;

/// Type of a vector's numbers, or of a number.
template <class V>
struct ScalarType {
  using Type = std::remove_cvref_t<decltype(std::declval<V>()[0])>;
};
template <>
struct ScalarType<double> {
  using Type = double;
};
template <class V>
using ScalarOf = typename ScalarType<V>::Type;
template <class V>
inline constexpr int size_of = static_cast<int>(sizeof(V) / sizeof(ScalarOf<V>));

// Operations on pairs.
#define TREMIE_ON_PAIRS(op)                                                                             \
  template <class Half>                                                                                 \
  [[gnu::always_inline]] inline auto operator op(const SimdPair<Half>& a, const SimdPair<Half>& b) {    \
    return SimdPair(a.low op b.low, a.high op b.high);                                                  \
  }                                                                                                     \
  template <class Half, class Number>                                                                   \
  requires std::is_arithmetic_v<Number>                                                                 \
  [[gnu::always_inline]] inline auto operator op(const SimdPair<Half>& a, Number b) {                   \
    return SimdPair(a.low op static_cast<ScalarOf<Half>>(b), a.high op static_cast<ScalarOf<Half>>(b)); \
  }                                                                                                     \
  template <class Half, class Number>                                                                   \
  requires std::is_arithmetic_v<Number>                                                                 \
  [[gnu::always_inline]] inline auto operator op(Number a, const SimdPair<Half>& b) {                   \
    return SimdPair(static_cast<ScalarOf<Half>>(a) op b.low, static_cast<ScalarOf<Half>>(a) op b.high); \
  }
TREMIE_ON_PAIRS(+)
TREMIE_ON_PAIRS(-)
TREMIE_ON_PAIRS(*)
TREMIE_ON_PAIRS(/)
TREMIE_ON_PAIRS(<)
TREMIE_ON_PAIRS(>)
TREMIE_ON_PAIRS(==)
TREMIE_ON_PAIRS(&)
TREMIE_ON_PAIRS(|)
TREMIE_ON_PAIRS(^)
TREMIE_ON_PAIRS(<<)
#undef TREMIE_ON_PAIRS
template <class Half>
[[gnu::always_inline]] inline SimdPair<Half> operator-(const SimdPair<Half>& a) {
  return {-a.low, -a.high};
}
template <class Half>
[[gnu::always_inline]] inline SimdPair<Half> operator~(const SimdPair<Half>& a) {
  return {~a.low, ~a.high};
}

using i64x8 = decltype(f64x8{} < f64x8{});  ///< what comparisons give: all bits of a lane or none

/// mask ? a : b in each lane.
template <class Mask, class V>
[[gnu::always_inline]] inline V select(const Mask& mask, const V& a, const V& b) {
  if constexpr (detail::is_pair<V>)
    return {select(mask.low, a.low, b.low), select(mask.high, a.high, b.high)};
  else
    return mask ? a : b;
}

template <class V>
[[gnu::always_inline]] inline V load(const ScalarOf<V>* from) {
  if constexpr (detail::is_pair<V>) {
    using Half = decltype(V::low);
    return {load<Half>(from), load<Half>(from + V::size / 2)};
  } else {
    V v;
    std::memcpy(&v, from, sizeof v);
    return v;
  }
}
template <class V>
[[gnu::always_inline]] inline void store(const V& v, ScalarOf<V>* to) {
  if constexpr (detail::is_pair<V>)
    store(v.low, to), store(v.high, to + V::size / 2);
  else
    std::memcpy(to, &v, sizeof v);
}

namespace detail {

/// shuffle<index>(a, b): number k of the result is number index(k, n) of the n of a, or of those of b after them.
template <int (*index)(int, int), class V>
[[gnu::always_inline]] inline V shuffle(const V& a, const V& b) {
  return [&]<int... k>(std::integer_sequence<int, k...>) {
    return __builtin_shufflevector(a, b, index(k, size_of<V>)...);
  }
  (std::make_integer_sequence<int, size_of<V>>{});
}

// Within four numbers each: the first two or the last two of a and b, one from each in turn, or one after the other.
constexpr int turns_low(int k, int n) { return k / 4 * 4 + k % 4 / 2 + k % 2 * n; }
constexpr int turns_high(int k, int n) { return turns_low(k, n) + 2; }
constexpr int halves_low(int k, int n) { return k / 4 * 4 + k % 2 + k % 4 / 2 * n; }
constexpr int halves_high(int k, int n) { return halves_low(k, n) + 2; }
// Numbers 0 and 2, or 1 and 3, of each four of a and b in turn.
constexpr int even(int k, int n) { return k / 2 * 2 + k % 2 * n; }
constexpr int odd(int k, int n) { return even(k, n) + 1; }

}  // namespace detail

/// Two vectors as one of twice as many numbers.
template <class V>
[[gnu::always_inline]] inline Simd<ScalarOf<V>, 2 * size_of<V>> join(const V& low, const V& high) {
  if constexpr (2 * sizeof(V) > simd_bytes)
    return {low, high};
  else
    return [&]<int... k>(std::integer_sequence<int, k...>) {
      return __builtin_shufflevector(low, high, k...);
    }
  (std::make_integer_sequence<int, 2 * size_of<V>>{});
}
/// The first half of a vector, or the second.
template <bool second, class V>
[[gnu::always_inline]] inline auto half_of(const V& v) {
  if constexpr (detail::is_pair<V>)
    return second ? v.high : v.low;
  else
    return [&]<int... k>(std::integer_sequence<int, k...>) {
      return __builtin_shufflevector(v, v, (k + (second ? size_of<V> / 2 : 0))...);
    }
  (std::make_integer_sequence<int, size_of<V> / 2>{});
}

/// The numbers as another type.
template <class T, class V>
[[gnu::always_inline]] inline Simd<T, size_of<V>> convert(const V& v) {
  using To = Simd<T, size_of<V>>;
  if constexpr (std::is_same_v<T, ScalarOf<V>>)
    return v;
  else if constexpr (detail::is_pair<V> || detail::is_pair<To>)
    return join(convert<T>(half_of<false>(v)), convert<T>(half_of<true>(v)));
#ifdef __AVX512F__  // the compiler would convert by halves
  else if constexpr (std::is_same_v<To, f64x8> && std::is_same_v<V, f32x8>)
    return _mm512_maskz_cvtps_pd(0xff, v);
#endif
  else
    return __builtin_convertvector(v, To);
}
template <class Real>
[[gnu::always_inline]] inline SimdOf<Real> to_real(const f64x8& a) {
  return convert<Real>(a);
}
template <class V>
[[gnu::always_inline]] inline f64x8 to_double(const V& a) {
  return convert<double>(a);
}
/// The lanes as integers, where they hold whole numbers of another type.
template <class V>
[[gnu::always_inline]] inline std::array<int, f64x8_size> to_integers(const V& a) {
  std::array<int, f64x8_size> integers;
  store(convert<int>(a), integers.data());
  return integers;
}

/// Transposes blocks of four by four: number k of v[i], of each four numbers, becomes number i of v[k].
template <class V>
[[gnu::always_inline]] inline void transpose(V (&v)[4]) {
  using namespace detail;
  if constexpr (is_pair<V> && size_of < V >> 4) {
    decltype(V::low) low[4] = {v[0].low, v[1].low, v[2].low, v[3].low},
                     high[4] = {v[0].high, v[1].high, v[2].high, v[3].high};
    transpose(low), transpose(high);
    for (int k = 0; k < 4; ++k) v[k] = {low[k], high[k]};
  } else if constexpr (is_pair<V>) {  // of registers with two numbers
    const V a = v[0], b = v[1], c = v[2], d = v[3];
    v[0] = {shuffle<even>(a.low, b.low), shuffle<even>(c.low, d.low)};
    v[1] = {shuffle<odd>(a.low, b.low), shuffle<odd>(c.low, d.low)};
    v[2] = {shuffle<even>(a.high, b.high), shuffle<even>(c.high, d.high)};
    v[3] = {shuffle<odd>(a.high, b.high), shuffle<odd>(c.high, d.high)};
  } else {  // each step within 128 bits, as registers are made of them
    constexpr bool four = sizeof(ScalarOf<V>) == 4;
    const V a = shuffle < four ? turns_low : even > (v[0], v[1]),
            b = shuffle < four ? turns_low : even > (v[2], v[3]),
            c = shuffle < four ? turns_high : odd > (v[0], v[1]),
            d = shuffle < four ? turns_high : odd > (v[2], v[3]);
    v[0] = shuffle<halves_low>(a, b), v[3] = shuffle<halves_high>(c, d);
    v[four ? 1 : 2] = shuffle<halves_high>(a, b), v[four ? 2 : 1] = shuffle<halves_low>(c, d);
  }
}

/// The same number in all lanes.
inline f64x8 all_lanes(double x) { return x - f64x8{}; }

// a > b ? a : b and a < b ? a : b in each lane.
template <class V>
[[gnu::always_inline]] inline V max(const V& a, const V& b) {
#ifdef __AVX512F__  // among other arithmetic the compiler would make two instructions of each
  if constexpr (std::is_same_v<V, f64x8>) return _mm512_maskz_max_pd(0xff, a, b);
#endif
  return select(a > b, a, b);
}
template <class V>
[[gnu::always_inline]] inline V min(const V& a, const V& b) {
#ifdef __AVX512F__
  if constexpr (std::is_same_v<V, f64x8>) return _mm512_maskz_min_pd(0xff, a, b);
#endif
  return select(a < b, a, b);
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

/// Whether a mask has any lane.
template <class Mask>
[[gnu::always_inline]] inline bool any(const Mask& a) {
#ifdef __AVX512F__  // lane by lane it would cost more than what it saves
  if constexpr (sizeof a == 64)
    return _mm512_test_epi64_mask(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(a)) != 0;
#endif
  if constexpr (size_of < Mask >> 2)
    return any(half_of<false>(a) | half_of<true>(a));
  else
    return (a[0] | a[1]) != 0;
}

template <class V>
[[gnu::always_inline]] inline V sqrt(const V& a) {
  if constexpr (detail::is_pair<V>) {
    return {sqrt(a.low), sqrt(a.high)};
  } else {
    V r;
    for (int l = 0; l < size_of<V>; ++l) r[l] = __builtin_sqrt(a[l]);
    return r;
  }
}

namespace detail {
/// The bits of numbers as integers, and back.
template <class V>
[[gnu::always_inline]] inline auto bits_of(const V& a) {
  if constexpr (is_pair<V>)
    return SimdPair(bits_of(a.low), bits_of(a.high));
  else
    return reinterpret_cast<decltype(a < a)>(a);
}
template <class V>
[[gnu::always_inline]] inline Simd<double, size_of<V>> with_bits(const V& a) {
  if constexpr (is_pair<V>)
    return {with_bits(a.low), with_bits(a.high)};
  else
    return reinterpret_cast<Simd<double, size_of<V>>>(a);
}
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
  return select(near > x, near - 1.0, near);
#endif
}
/// Whole number next to x, the even one of two, and the largest that is not above x; |x| < 2^22.
inline f32x8 nearest(const f32x8& x) {
  constexpr float round = 12582912.0F;  // 1.5 * 2^23: sums with it have no fraction
  return (x + round) - round;
}
inline f32x8 floor(const f32x8& x) {
  const f32x8 near = nearest(x);
  return select(near > x, near - 1.0F, near);
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
  return p * detail::with_bits((detail::bits_of(shifted) + 1023) << 52);
}

/// e^-x for x >= 0, to 2e-16 relative; without e^x's range reduction where no lane is above 1/500, as in
/// steps that resolve what decays.
inline f64x8 decay(const f64x8& x) {
  if (any(~(x < 0.002))) return exp(-x);
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
  return select(near, series, direct);
}

}  // namespace tremie
