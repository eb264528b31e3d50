#pragma once

// Sixteen cells side by side: vectors of the nodes to lanes of cells and back.

#include <Eigen/Core>
#include <cstddef>
#include <cstring>
#include <type_traits>

namespace tremie {

inline constexpr int batch_size = 16;
template <class Scalar>
using Lanes = Eigen::Array<Scalar, batch_size, 1>;

/// Components of a nodal vector field: in single precision padded to four, the last one 0.
template <class Scalar>
inline constexpr int node_stride = std::is_same_v<Scalar, float> ? 4 : 3;
template <class Scalar>
using NodeValue = Eigen::Matrix<Scalar, node_stride<Scalar>, 1>;

namespace detail {

using Four [[gnu::vector_size(16)]] = float;
using Eight [[gnu::vector_size(32)]] = float;
using Sixteen [[gnu::vector_size(64)]] = float;

inline Four load_four(const float* v, int node) {
  Four f;
  std::memcpy(&f, v + 4 * static_cast<std::ptrdiff_t>(node), sizeof f);
  return f;
}

/// Lanes j, 4 + j, 8 + j and 12 + j.
inline Sixteen four_lanes(const float* v, const int* node, int j) {
  const Eight low =
      __builtin_shufflevector(load_four(v, node[j]), load_four(v, node[4 + j]), 0, 1, 2, 3, 4, 5, 6, 7);
  const Eight high =
      __builtin_shufflevector(load_four(v, node[8 + j]), load_four(v, node[12 + j]), 0, 1, 2, 3, 4, 5, 6, 7);
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

inline Sixteen lower_pairs(const Sixteen& a, const Sixteen& b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 4, 20, 5, 21, 8, 24, 9, 25, 12, 28, 13, 29);
}
inline Sixteen upper_pairs(const Sixteen& a, const Sixteen& b) {
  return __builtin_shufflevector(a, b, 2, 18, 3, 19, 6, 22, 7, 23, 10, 26, 11, 27, 14, 30, 15, 31);
}
inline Sixteen lower_halves(const Sixteen& a, const Sixteen& b) {
  return __builtin_shufflevector(a, b, 0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29);
}
inline Sixteen upper_halves(const Sixteen& a, const Sixteen& b) {
  return __builtin_shufflevector(a, b, 2, 3, 18, 19, 6, 7, 22, 23, 10, 11, 26, 27, 14, 15, 30, 31);
}

inline Sixteen of_lanes(const Lanes<float>& a) {
  Sixteen s;
  std::memcpy(&s, a.data(), sizeof s);
  return s;
}
inline void to_lanes(const Sixteen& s, Lanes<float>& a) { std::memcpy(a.data(), &s, sizeof s); }

inline void store_four_lanes(const Sixteen& s, int j, float* out, std::ptrdiff_t stride) {
  float value[16];
  std::memcpy(value, &s, sizeof s);
  for (int i = 0; i < 4; ++i) std::memcpy(out + 4 * stride * (4 * i + j), value + 4 * i, sizeof(Four));
}

}  // namespace detail

/// The vectors of one node a lane.
inline void load_nodes(const float* v, const int* node, Lanes<float>& x, Lanes<float>& y, Lanes<float>& z) {
  using namespace detail;
  const Sixteen a = four_lanes(v, node, 0), b = four_lanes(v, node, 1), c = four_lanes(v, node, 2),
                d = four_lanes(v, node, 3);
  const Sixteen ab = lower_pairs(a, b), cd = lower_pairs(c, d);
  to_lanes(lower_halves(ab, cd), x);
  to_lanes(upper_halves(ab, cd), y);
  to_lanes(lower_halves(upper_pairs(a, b), upper_pairs(c, d)), z);
}
inline void load_nodes(const double* v, const int* node, Lanes<double>& x, Lanes<double>& y,
                       Lanes<double>& z) {
  for (int l = 0; l < batch_size; ++l) {
    const double* at = v + 3 * static_cast<std::ptrdiff_t>(node[l]);
    x[l] = at[0], y[l] = at[1], z[l] = at[2];
  }
}

/// One vector a lane to places 0, stride, 2 stride, ... of out.
inline void store_lanes(const Lanes<float>& x, const Lanes<float>& y, const Lanes<float>& z, float* out,
                        std::ptrdiff_t stride) {
  using namespace detail;
  const Sixteen none = {}, a = of_lanes(x), b = of_lanes(y), c = of_lanes(z);
  const Sixteen ab = lower_pairs(a, b), cd = lower_pairs(c, none);
  const Sixteen high_ab = upper_pairs(a, b), high_cd = upper_pairs(c, none);
  store_four_lanes(lower_halves(ab, cd), 0, out, stride);
  store_four_lanes(upper_halves(ab, cd), 1, out, stride);
  store_four_lanes(lower_halves(high_ab, high_cd), 2, out, stride);
  store_four_lanes(upper_halves(high_ab, high_cd), 3, out, stride);
}
inline void store_lanes(const Lanes<double>& x, const Lanes<double>& y, const Lanes<double>& z, double* out,
                        std::ptrdiff_t stride) {
  for (int l = 0; l < batch_size; ++l, out += 3 * stride) out[0] = x[l], out[1] = y[l], out[2] = z[l];
}

}  // namespace tremie
