#pragma once

// Batch16 numbers in single precision as four nodes of a row, four entries each, and how the entries of
// sixteen points, one lane a point, come there and back.

#include "libmpm/grid/tiles.hpp"
#include "libmpm/parallel/simd.hpp"
#ifdef __AVX512F__
#include <immintrin.h>
#endif

namespace tremie::detail {

/// Four nodes of a row, from any one on.
inline f32x16 load_controls(const f32x4* from) {
  f32x16 four;
  std::memcpy(&four, from, sizeof four);
  return four;
}
inline void add_controls(const f32x16& four, f32x4* to) {
  const f32x16 sum = load_controls(to) + four;
  std::memcpy(to, &sum, sizeof sum);
}

/// One entry of four a point, where transpose_blocks brings them.
struct alignas(64) Entries : std::array<f32x4, f32x16_size> {};

/// With AVX-512 the number as it is rounded: no multiply-add is made of the product that it is and a sum, for
/// additions have units of their own on some processors.
inline f32x16 rounded(f32x16 a) {
#ifdef __AVX512F__
  asm("" : "+v"(a));
#endif
  return a;
}

/// The same node's entries four times; the entries 0 to 3 four times each.
inline f32x16 four_times(const f32x4& a) {
#ifdef __AVX512F__  // one load; a shuffle would take an arithmetic unit
  return _mm512_maskz_broadcast_f32x4(0xffff, a);
#else
  const f32x4 four[4] = {a, a, a, a};
  f32x16 times;
  std::memcpy(&times, four, sizeof times);
  return times;
#endif
}
inline f32x16 each_four_times(const f32x4& a) {
#ifdef __AVX512F__
  const f32x16 b = four_times(a);
  return __builtin_shufflevector(b, b, 0, 0, 0, 0, 5, 5, 5, 5, 10, 10, 10, 10, 15, 15, 15, 15);
#else
  const f32x4 none = {}, four[4] = {none + a[0], none + a[1], none + a[2], none + a[3]};
  f32x16 times;
  std::memcpy(&times, four, sizeof times);
  return times;
#endif
}

/// Blocks of four and within them: points 4a + b of column c go to entry c of block a of vector b.
inline void transpose_blocks(const f32x16 (&column)[4], f32x16 (&row)[4]) {
#ifdef __AVX512F__
  const f32x16 low_01 =
      __builtin_shufflevector(column[0], column[1], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
  const f32x16 high_01 = __builtin_shufflevector(column[0], column[1], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11,
                                                 27, 14, 30, 15, 31);
  const f32x16 low_23 =
      __builtin_shufflevector(column[2], column[3], 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
  const f32x16 high_23 = __builtin_shufflevector(column[2], column[3], 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11,
                                                 27, 14, 30, 15, 31);
  row[0] = __builtin_shufflevector(low_01, low_23, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  row[1] =
      __builtin_shufflevector(low_01, low_23, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
  row[2] =
      __builtin_shufflevector(high_01, high_23, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
  row[3] =
      __builtin_shufflevector(high_01, high_23, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
#else  // the compiler takes shuffles that the processor has not lane by lane, and minutes for it
  float from[4][f32x16_size], to[4][f32x16_size];
  std::memcpy(from, column, sizeof from);
  for (std::size_t c = 0; c < 4; ++c)
    for (std::size_t l = 0; l < f32x16_size; ++l) to[l % 4][l / 4 * 4 + c] = from[c][l];
  std::memcpy(row, to, sizeof to);
#endif
}

/// Where transpose_blocks brings point l, in entries of four.
constexpr std::size_t place_of(std::size_t l) { return l % 4 * 4 + l / 4; }

/// Each lane l with the number of lane place_of(l).
inline f32x16 transposed(const f32x16& a) {
#ifdef __AVX512F__
  return __builtin_shufflevector(a, a, 0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15);
#else
  float from[f32x16_size], to[f32x16_size];
  std::memcpy(from, &a, sizeof from);
  for (std::size_t l = 0; l < f32x16_size; ++l) to[l] = from[place_of(l)];
  f32x16 result;
  std::memcpy(&result, to, sizeof result);
  return result;
#endif
}

/// Blocks of four of four vectors, the same ones side by side; the fourth ones are left out.
struct Blocks {
  f32x16 first, second, third;
};
inline Blocks first_three_blocks(const f32x16 (&of)[4]) {
#ifdef __AVX512F__
  const f32x16 low_01 =
      __builtin_shufflevector(of[0], of[1], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
  const f32x16 low_23 =
      __builtin_shufflevector(of[2], of[3], 0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23);
  const f32x16 high_01 =
      __builtin_shufflevector(of[0], of[1], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  const f32x16 high_23 =
      __builtin_shufflevector(of[2], of[3], 8, 9, 10, 11, 12, 13, 14, 15, 24, 25, 26, 27, 28, 29, 30, 31);
  return {
      __builtin_shufflevector(low_01, low_23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27),
      __builtin_shufflevector(low_01, low_23, 4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31),
      __builtin_shufflevector(high_01, high_23, 0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27)};
#else
  float from[4][f32x16_size], to[3][f32x16_size];
  std::memcpy(from, of, sizeof from);
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t l = 0; l < f32x16_size; ++l) to[k][l] = from[l / 4][4 * k + l % 4];
  Blocks blocks;
  std::memcpy(&blocks, to, sizeof blocks);
  return blocks;
#endif
}

/// A column a component, 0 where there is none, as one entry of four a point.
template <std::size_t n>
[[gnu::always_inline]] inline Entries entries_of(const f32x16 (&of)[n]) {
  Entries entry;
  const auto column = [&](std::size_t c) { return c < n ? of[c < n ? c : 0] : f32x16{}; };
  const f32x16 four[4] = {column(0), column(1), column(2), column(3)};
  transpose_blocks(four, reinterpret_cast<f32x16(&)[4]>(*entry.data()));
  return entry;
}

}  // namespace tremie::detail
