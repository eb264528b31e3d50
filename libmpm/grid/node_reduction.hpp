#pragma once

// Adds up at the nodes what cells give them, without locks and with bits that do not depend on the threads.
//
// The cells are cut into chunks, as many as the body asks for. Each chunk adds what its cells give, in their
// order, to a buffer of its own for the nodes that it sees; then each node adds up its chunks, two or three of
// them. Cells are in lexicographic order, so that a chunk sees a range of nodes; where the first axis is
// periodic the last chunk's begins with the first node, and the buffer of all of them is larger.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "libmpm/grid/active_grid.hpp"
#include "libmpm/parallel/buffers.hpp"
#include "libmpm/parallel/simd.hpp"

namespace tremie {

/// Room for what chunks of cells give their nodes, four numbers each, in either precision: they are not
/// needed at the same time.
class ReductionBuffer {
 public:
  void resize_for_overwrite(std::size_t nodes) {
    tremie::resize_for_overwrite(room_, nodes * 4 * sizeof(double) / sizeof(Line) + 1);
  }
  template <class Scalar>
  Scalar* values() {
    return reinterpret_cast<Scalar*>(room_.data());  // bytes in which numbers come to be when written
  }
  template <class Scalar>
  const Scalar* values() const {
    return reinterpret_cast<const Scalar*>(room_.data());
  }

 private:
  struct alignas(64) Line {
    std::byte bytes[64];
  };
  std::vector<Line> room_;
};

/// Adds a vector of four numbers to a node's in such a buffer.
template <class Four, class Scalar>
void add_to_node(const Four& value, Scalar* at) {
  static_assert(sizeof(Four) == 4 * sizeof(Scalar));
  store(load<Four>(at) + value, at);
}

class NodeReduction {
 public:
  /// Cuts the cells of a grid into chunks that begin at multiples of `unit`.
  void lay_out(const ActiveGrid<3>& grid, int unit = 1);

  int size() const { return static_cast<int>(chunks_.size()); }
  int first_cell(int chunk) const { return chunks_[chunk].first_cell; }
  int last_cell(int chunk) const { return chunks_[chunk].last_cell; }
  void resize_for_overwrite(ReductionBuffer& buffer) const { buffer.resize_for_overwrite(buffer_nodes_); }

  /// Where a chunk's nodes are added to: node i at 4 i. Cleared before.
  template <class Scalar>
  Scalar* clear(int chunk, ReductionBuffer& buffer) const {
    const Chunk& s = chunks_[chunk];
    Scalar* to = buffer.values<Scalar>() + 4 * s.place;
    std::fill(to + 4 * std::ptrdiff_t{s.first_node}, to + 4 * std::ptrdiff_t{s.last_node}, Scalar(0));
    return to;
  }
  /// The first n numbers of what node i was given.
  template <class Scalar, int n>
  Eigen::Matrix<Scalar, n, 1> sum_at(int i, const ReductionBuffer& buffer) const {
    using Value = Eigen::Matrix<Scalar, n, 1>;
    const Scalar* from = buffer.values<Scalar>();
    Value sum = Value::Zero();
    for (auto s = static_cast<std::size_t>(first_chunk_[i]); s < chunks_.size() && chunks_[s].first_node <= i;
         ++s)
      sum += Eigen::Map<const Value>(from + 4 * (chunks_[s].place + i));
    return sum;
  }
  /// Calls give(chunk, to) for every chunk, which adds what its cells give, and take(node) for every node
  /// when all of them have. To be called by all threads of a parallel region.
  template <class Scalar, class Give, class Take>
  void sweep_in_region(ReductionBuffer& buffer, Give give, Take take) const {
    const int n_nodes = static_cast<int>(first_chunk_.size());
#pragma omp for schedule(static)
    for (int s = 0; s < size(); ++s) give(s, clear<Scalar>(s, buffer));
#pragma omp for schedule(static)
    for (int i = 0; i < n_nodes; ++i) take(i);
  }

 private:
  static constexpr int least_cells = 256, least_planes = 2, most_chunks = 64;
  /// Cells [first_cell, last_cell), and the nodes [first_node, last_node) around them.
  struct Chunk {
    int first_cell, last_cell, first_node, last_node;
    std::ptrdiff_t place;  ///< of node 0 in the buffer, if it were among them
  };
  std::vector<Chunk> chunks_;
  std::vector<int> first_chunk_;  ///< that sees each node
  std::size_t buffer_nodes_ = 0;  ///< of all chunks
};

/// take(node, sum) for every node of a grid, with the sum of the four numbers that its cells give it: give(c, to) adds
/// those of cell c to node i at to + 4 i.
template <class Give, class Take>
void sum_over_cells(const ActiveGrid<3>& grid, Give give, Take take) {
  NodeReduction reduction;
  reduction.lay_out(grid);
  ReductionBuffer buffer;
  reduction.resize_for_overwrite(buffer);
  const auto give_chunk = [&](int chunk, double* to) {
    for (int c = reduction.first_cell(chunk); c < reduction.last_cell(chunk); ++c) give(c, to);
  };
#pragma omp parallel
  reduction.sweep_in_region<double>(buffer, give_chunk,
                                    [&](int i) { take(i, reduction.sum_at<double, 4>(i, buffer)); });
}

/// A power of two chunks, so that two, four or eight threads share them evenly.
inline void NodeReduction::lay_out(const ActiveGrid<3>& grid, int unit) {
  const int n_cells = grid.n_cells(), n_nodes = grid.n_nodes(), units = (n_cells + unit - 1) / unit;
  int n = 1;
  while (2 * n <= most_chunks && 2 * n * least_cells <= n_cells &&
         2 * n * least_planes <= grid.cell_map.extent[0])
    n *= 2;
  chunks_.resize(n);
#pragma omp parallel for schedule(static)
  for (int s = 0; s < n; ++s) {
    const auto begin = [&](int k) {
      return std::min(n_cells, unit * static_cast<int>(std::int64_t{units} * k / n));
    };
    Chunk chunk{begin(s), begin(s + 1), n_nodes, 0, 0};
    for (int c = chunk.first_cell; c < chunk.last_cell; ++c)
      for (int i : grid.cell_nodes[c]) {
        chunk.first_node = std::min(chunk.first_node, i);
        chunk.last_node = std::max(chunk.last_node, i + 1);
      }
    chunks_[s] = chunk;
  }
  // Neither end lies behind an earlier chunk's, so that the chunks of a node follow each other.
  for (std::size_t s = chunks_.size() - 1; s > 0; --s)
    chunks_[s - 1].first_node = std::min(chunks_[s - 1].first_node, chunks_[s].first_node);
  for (std::size_t s = 1; s < chunks_.size(); ++s)
    chunks_[s].last_node = std::max(chunks_[s].last_node, chunks_[s - 1].last_node);
  tremie::resize_for_overwrite(first_chunk_, static_cast<std::size_t>(n_nodes));
  std::ptrdiff_t place = 0;
  int next = 0;
  for (int s = 0; s < n; ++s) {
    Chunk& chunk = chunks_[s];
    chunk.place = place - chunk.first_node;
    place += chunk.last_node - chunk.first_node;
    for (; next < chunk.last_node; ++next) first_chunk_[next] = s;
  }
  buffer_nodes_ = static_cast<std::size_t>(place);
}

}  // namespace tremie
