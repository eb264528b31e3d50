#pragma once

// A batch of cells side by side: vectors of the nodes to lanes of cells and back.

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "libmpm/grid/node_reduction.hpp"
#include "libmpm/parallel/simd.hpp"

#ifdef __AVX512VL__
#include <immintrin.h>
#endif

namespace tremie {

inline constexpr int batch_size = 16;
template <class Scalar>
using Lanes = Eigen::Array<Scalar, batch_size, 1>;

/// Components of a nodal vector field: in single precision padded to four, the last one 0.
template <class Scalar>
inline constexpr int node_stride = std::is_same_v<Scalar, float> ? 4 : 3;

namespace detail {

inline f32x4 load_four(const float* v, int node) {
  f32x4 f;
  std::memcpy(&f, v + 4 * static_cast<std::ptrdiff_t>(node), sizeof f);
  return f;
}

/// Lanes j, 4 + j, 8 + j and 12 + j.
inline f32x16 four_lanes(const float* v, const int* node, int j) {
  const f32x8 low =
      __builtin_shufflevector(load_four(v, node[j]), load_four(v, node[4 + j]), 0, 1, 2, 3, 4, 5, 6, 7);
  const f32x8 high =
      __builtin_shufflevector(load_four(v, node[8 + j]), load_four(v, node[12 + j]), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

inline f32x16 lower_pairs(const f32x16& a, const f32x16& b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
inline f32x16 upper_pairs(const f32x16& a, const f32x16& b) {
  return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
inline f32x16 lower_halves(const f32x16& a, const f32x16& b) {
  return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}
inline f32x16 upper_halves(const f32x16& a, const f32x16& b) {
  return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}

inline f32x16 of_lanes(const Lanes<float>& a) {
  f32x16 s;
  std::memcpy(&s, a.data(), sizeof s);
  return s;
}
inline void to_lanes(const f32x16& s, Lanes<float>& a) { std::memcpy(a.data(), &s, sizeof s); }

/// Lanes j, 4 + j, 8 + j and 12 + j.
inline void add_four_lanes(const f32x16& s, const int* node, int j, float* buffer) {
  f32x4 value[4];
  std::memcpy(value, &s, sizeof s);
  for (int i = 0; i < 4; ++i)
    add_to_node(value[i], buffer + 4 * static_cast<std::ptrdiff_t>(node[4 * i + j]));
}

/// Three numbers and anything.
inline f64x4 load_three(const double* from) {
#ifdef __AVX512VL__
  return _mm256_maskz_loadu_pd(7, from);
#else
  return f64x4{from[0], from[1], from[2], 0.0};
#endif
}
/// Lanes j and 4 + j.
inline f64x8 two_lanes(const double* v, const int* node, int j) {
  return __builtin_shufflevector(load_three(v + 3 * static_cast<std::ptrdiff_t>(node[j])),
                                 load_three(v + 3 * static_cast<std::ptrdiff_t>(node[4 + j])), 0, 1, 2, 3, 4,
                                 5, 6, 7);
}
inline void to_lanes(const f64x8& s, double* a) { std::memcpy(a, &s, sizeof s); }
inline f64x8 of_lanes(const double* a) {
  f64x8 s;
  std::memcpy(&s, a, sizeof s);
  return s;
}
/// The vectors of eight nodes.
inline void load_eight(const double* v, const int* node, double* x, double* y, double* z) {
  const f64x8 a = two_lanes(v, node, 0), b = two_lanes(v, node, 1), c = two_lanes(v, node, 2),
              d = two_lanes(v, node, 3);
  const f64x8 xz_ab = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14),
              xz_cd = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14),
              y_ab = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15),
              y_cd = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  to_lanes(__builtin_shufflevector(xz_ab, xz_cd, 0, 1, 8, 9, 4, 5, 12, 13), x);
  to_lanes(__builtin_shufflevector(y_ab, y_cd, 0, 1, 8, 9, 4, 5, 12, 13), y);
  to_lanes(__builtin_shufflevector(xz_ab, xz_cd, 2, 3, 10, 11, 6, 7, 14, 15), z);
}
/// Lanes j and 4 + j.
inline void add_two_lanes(const f64x8& s, const int* node, int j, double* buffer) {
  f64x4 value[2];
  std::memcpy(value, &s, sizeof s);
  for (int i = 0; i < 2; ++i)
    add_to_node(value[i], buffer + 4 * static_cast<std::ptrdiff_t>(node[4 * i + j]));
}
inline void add_eight(const double* x, const double* y, const double* z, const int* node, double* buffer) {
  const f64x8 none = {}, a = of_lanes(x), b = of_lanes(y), c = of_lanes(z);
  const f64x8 even = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14),
              odd = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15),
              even_z = __builtin_shufflevector(c, none, 0, 8, 2, 10, 4, 12, 6, 14),
              odd_z = __builtin_shufflevector(c, none, 1, 9, 3, 11, 5, 13, 7, 15);
  add_two_lanes(__builtin_shufflevector(even, even_z, 0, 1, 8, 9, 4, 5, 12, 13), node, 0, buffer);
  add_two_lanes(__builtin_shufflevector(odd, odd_z, 0, 1, 8, 9, 4, 5, 12, 13), node, 1, buffer);
  add_two_lanes(__builtin_shufflevector(even, even_z, 2, 3, 10, 11, 6, 7, 14, 15), node, 2, buffer);
  add_two_lanes(__builtin_shufflevector(odd, odd_z, 2, 3, 10, 11, 6, 7, 14, 15), node, 3, buffer);
}

}  // namespace detail

/// The vectors of one node a lane.
inline void load_nodes(const float* v, const int* node, Lanes<float>& x, Lanes<float>& y, Lanes<float>& z) {
  using namespace detail;
  const f32x16 a = four_lanes(v, node, 0), b = four_lanes(v, node, 1), c = four_lanes(v, node, 2),
               d = four_lanes(v, node, 3);
  const f32x16 ab = lower_pairs(a, b), cd = lower_pairs(c, d);
  to_lanes(lower_halves(ab, cd), x);
  to_lanes(upper_halves(ab, cd), y);
  to_lanes(lower_halves(upper_pairs(a, b), upper_pairs(c, d)), z);
}
inline void load_nodes(const double* v, const int* node, Lanes<double>& x, Lanes<double>& y,
                       Lanes<double>& z) {
  for (int l = 0; l < batch_size; l += 8)
    detail::load_eight(v, node + l, x.data() + l, y.data() + l, z.data() + l);
}

/// Adds a vector a lane to the nodes, which have four numbers each.
inline void add_lanes(const Lanes<float>& x, const Lanes<float>& y, const Lanes<float>& z, const int* node,
                      float* buffer) {
  using namespace detail;
  const f32x16 none = {}, a = of_lanes(x), b = of_lanes(y), c = of_lanes(z);
  const f32x16 ab = lower_pairs(a, b), cd = lower_pairs(c, none);
  const f32x16 high_ab = upper_pairs(a, b), high_cd = upper_pairs(c, none);
  add_four_lanes(lower_halves(ab, cd), node, 0, buffer);
  add_four_lanes(upper_halves(ab, cd), node, 1, buffer);
  add_four_lanes(lower_halves(high_ab, high_cd), node, 2, buffer);
  add_four_lanes(upper_halves(high_ab, high_cd), node, 3, buffer);
}
inline void add_lanes(const Lanes<double>& x, const Lanes<double>& y, const Lanes<double>& z, const int* node,
                      double* buffer) {
  for (int l = 0; l < batch_size; l += 8)
    detail::add_eight(x.data() + l, y.data() + l, z.data() + l, node + l, buffer);
}

}  // namespace tremie
