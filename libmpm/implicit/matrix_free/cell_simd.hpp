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

/// Four numbers at a node, or three and anything.
inline Simd<float, 4> load_vector(const float* v, int node) {
  return load<Simd<float, 4>>(v + 4 * static_cast<std::ptrdiff_t>(node));
}
inline Simd<double, 4> load_vector(const double* v, int node) {
  const double* from = v + 3 * static_cast<std::ptrdiff_t>(node);
#ifdef __AVX512VL__
  return _mm256_maskz_loadu_pd(7, from);
#else
  return Simd<double, 4>{from[0], from[1], from[2], 0.0};
#endif
}

}  // namespace detail

/// The vectors of one node a lane.
template <class Scalar>
void load_nodes(const Scalar* v, const int* node, Lanes<Scalar>& x, Lanes<Scalar>& y, Lanes<Scalar>& z) {
  constexpr int n = std::is_same_v<Scalar, float> ? 16 : 8;  // side by side
  for (int first = 0; first < batch_size; first += n) {
    Simd<Scalar, n> lanes[4];
    const auto vector = [&](int lane) { return detail::load_vector(v, node[first + lane]); };
    for (int i = 0; i < 4; ++i) {
      if constexpr (n == 8)
        lanes[i] = join(vector(i), vector(4 + i));
      else
        lanes[i] = join(join(vector(i), vector(4 + i)), join(vector(8 + i), vector(12 + i)));
    }
    transpose(lanes);
    store(lanes[0], x.data() + first), store(lanes[1], y.data() + first), store(lanes[2], z.data() + first);
  }
}

/// Adds a vector a lane to the nodes, which have four numbers each.
template <class Scalar>
void add_lanes(const Lanes<Scalar>& x, const Lanes<Scalar>& y, const Lanes<Scalar>& z, const int* node,
               Scalar* buffer) {
  constexpr int n = std::is_same_v<Scalar, float> ? 16 : 8;
  using V = Simd<Scalar, n>;
  for (int first = 0; first < batch_size; first += n) {
    V lanes[4] = {load<V>(x.data() + first), load<V>(y.data() + first), load<V>(z.data() + first), V{}};
    transpose(lanes);
    const auto add = [&](const auto& vector, int lane) {
      add_to_node(vector, buffer + 4 * static_cast<std::ptrdiff_t>(node[first + lane]));
    };
    for (int i = 0; i < 4; ++i) {
      const auto low = half_of<false>(lanes[i]), high = half_of<true>(lanes[i]);
      if constexpr (n == 8) {
        add(low, i), add(high, 4 + i);
      } else {
        add(half_of<false>(low), i), add(half_of<true>(low), 4 + i);
        add(half_of<false>(high), 8 + i), add(half_of<true>(high), 12 + i);
      }
    }
  }
}

}  // namespace tremie
