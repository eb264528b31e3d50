#pragma once

// The mean shear rate over a length of the material, by which structure breaks down where mix.thixotropy.layer is given,
// and the linear algebra that it asks of the Couette reference. Private to rheometer/reference.
//
//   mean(r_i) = int K gamma_dot r dr / int K r dr,   K = max(0, 1 - |r - r_i|/layer),   over the gap.

#include <cstddef>
#include <span>
#include <vector>

#include "rheometer/reference/sundials_support.hpp"

namespace tremie {

/// The mean at one node: weights of int gamma_dot dx over the intervals from `first` on; interval i lies between the
/// nodes i and i + 1.
struct LayerMean {
  std::size_t first = 0;
  std::vector<double> weight;
};

/// One for each node x = ln(r/R_i), ascending; `layer` over R_i, greater than 0. The shear rate counts as even in an
/// interval.
std::vector<LayerMean> layer_means(std::span<const double> x, double layer);

/// The most nodes that a mean reaches to either side.
std::size_t reach_of(const std::vector<LayerMean>& means);

/// A band matrix of n rows with `reach` entries on either side of the diagonal, and its factors.
class BandMatrix {
 public:
  BandMatrix(std::size_t n, std::size_t reach);
  void set_to_zero();
  double& at(std::size_t row, std::size_t column);
  /// False where it is singular; at() is meaningless afterwards.
  bool factor();
  /// x = A^-1 b, after factor().
  void solve(std::span<const double> b, std::span<double> x);

 private:
  SundialsContext context_;
  SundialsMatrix A_;
  SundialsVector b_, x_;
  SundialsLinearSolver solver_;
};

}  // namespace tremie
