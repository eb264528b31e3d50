#pragma once

// Quadrature of a container that is full of concrete, in cylindrical coordinates (steady_flow.hpp).

#include <array>
#include <vector>

#include "libmpm/geometry/cylindrical.hpp"
#include "libmpm/implicit/problem/quadrature.hpp"

namespace tremie {

/// Of full cells: rows at every quadrature point, cell by cell.
template <>
struct Quadrature<Cylindrical> {
  static constexpr int D = 3, n_strain = 5, n_places = 8, n_local = 27;
  using StrainRows = std::array<Mat<n_strain, D>, n_local>;
  using DivergenceRows = std::array<Vec<D>, n_local>;

  std::vector<std::array<StrainRows, n_places>> B;  ///< strain rows [1/m]
  std::vector<DivergenceRows> b;                    ///< rows of the cell's mean divergence [1/m]
  std::vector<std::array<double, n_places>> V;      ///< [m^3]
  std::vector<std::array<double, n_places>> tau_y;  ///< [Pa]
  std::vector<double> V_cell;                       ///< sum of V [m^3]
  std::vector<double> p;                            ///< pressure without divergence [Pa]
  std::vector<std::array<Vec<D>, n_places>> place = {};

  const DivergenceRows& divergence_rows(int c) const { return b[static_cast<std::size_t>(c)]; }
};

}  // namespace tremie
