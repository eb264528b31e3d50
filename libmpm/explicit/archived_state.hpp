#pragma once

// What goes on from one explicit step to the next: a body that is read back steps to the same bits.

#include "libmpm/body/archive.hpp"
#include "libmpm/explicit/state.hpp"

namespace tremie {

template <class Half>
inline constexpr bool stored_plainly<SimdPair<Half>> = true;
template <class Real, int D>
inline constexpr bool stored_plainly<NodeCube<Real, D>> = true;

template <int D>
void visit(Archive& archive, LanePoints<D>& points) {
  for (auto* arrays : {&points.x, &points.v})
    for (std::vector<f64x8>& array : *arrays) archive(array);
  for (std::vector<f64x8>& array : points.C) archive(array);
  archive(points.mass, points.V0, points.ln_J, points.lambda, points.gamma_dot, points.id, points.n);
  for (std::vector<f64x8>& part : points.lambda_parts) archive(part);
}

/// The axes are the scene's.
template <int D>
void visit(Archive& archive, TileGrid<D>& grid) {
  archive(grid.tiles, grid.blocks, grid.v, grid.v_start);
  for (auto* buffers : {&grid.sums, &grid.impulses}) archive(std::get<0>(*buffers), std::get<1>(*buffers));
}

template <int D>
void visit(Archive& archive, Holding<D>& holding) {
  archive(holding.of_tile, holding.cells, holding.drift);
}

template <class Geometry>
void visit(Archive& archive, ExplicitState<Geometry>& state) {
  archive(state.points, state.grid, state.next_dt, state.drift, state.max_speed, state.lambda_max,
          state.limits);
  archive(state.holding, state.near_wall, state.wall_drift, state.sorts);
}

/// The body's points are those on the tiles; as many parts of lambda as the scene's kinetics have.
template <class Geometry>
void visit_explicit(Archive& archive, Body<Geometry>& body, ExplicitState<Geometry>& state) {
  if (const auto& t = body.mix.thixotropy) state.points.lambda_parts.resize(part_shares(t->kinetics).size());
  archive(body.time, body.dt, state);
  if (archive.reads()) write_back(state, body);
}

}  // namespace tremie
