#include "rheometer/reference/couette_layer.hpp"

#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

#include <algorithm>
#include <cmath>

namespace tremie {

namespace {

/// int K r dr between two radii on one side of the node: side is 1 where r is beyond it, -1 before it.
double kernel_integral(double low, double high, double node, double layer, double side) {
  const double even = 0.5 * (1.0 + side * node / layer), falling = side / (3.0 * layer);
  const auto value = [&](double r) { return r * r * (even - falling * r); };
  return value(high) - value(low);
}

/// The same from one radius to another, wherever the node is.
double kernel_integral(double from, double to, double node, double layer) {
  const double low = std::max(from, node - layer), high = std::min(to, node + layer);
  double sum = 0.0;
  if (low < std::min(high, node)) sum += kernel_integral(low, std::min(high, node), node, layer, -1.0);
  if (std::max(low, node) < high) sum += kernel_integral(std::max(low, node), high, node, layer, 1.0);
  return sum;
}

}  // namespace

std::vector<LayerMean> layer_means(std::span<const double> x, double layer) {
  std::vector<double> r;
  for (const double at : x) r.push_back(std::exp(at));
  std::vector<LayerMean> means(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    LayerMean& mean = means[i];
    double norm = 0.0;
    for (std::size_t j = 0; j + 1 < x.size(); ++j) {
      const double share = kernel_integral(r[j], r[j + 1], r[i], layer);
      if (!(share > 0.0)) continue;
      if (mean.weight.empty()) mean.first = j;
      mean.weight.push_back(share / (x[j + 1] - x[j]));
      norm += share;
    }
    for (double& w : mean.weight) w /= norm;
  }
  return means;
}

std::size_t reach_of(const std::vector<LayerMean>& means) {
  std::size_t reach = 1;
  for (std::size_t i = 0; i < means.size(); ++i) {
    const std::size_t first = means[i].first, last = first + means[i].weight.size();
    reach = std::max({reach, i > first ? i - first : 0, last > i ? last - i : 0});
  }
  return reach;
}

BandMatrix::BandMatrix(std::size_t n, std::size_t reach)
    : A_(SUNBandMatrix(static_cast<sunindextype>(n), static_cast<sunindextype>(std::min(reach, n - 1)),
                       static_cast<sunindextype>(std::min(reach, n - 1)), context_.get)),
      b_(n, context_),
      x_(n, context_),
      solver_(SUNLinSol_Band(b_.get, A_.get, context_.get)) {}

void BandMatrix::set_to_zero() { SUNMatZero(A_.get); }

double& BandMatrix::at(std::size_t row, std::size_t column) {
  return SUNBandMatrix_Column(
      A_.get, static_cast<sunindextype>(
                  column))[static_cast<std::ptrdiff_t>(row) - static_cast<std::ptrdiff_t>(column)];
}

bool BandMatrix::factor() { return SUNLinSolSetup(solver_.get, A_.get) == 0; }

void BandMatrix::solve(std::span<const double> b, std::span<double> x) {
  std::copy(b.begin(), b.end(), values(b_.get).begin());
  SUNLinSolSolve(solver_.get, A_.get, x_.get, b_.get, 0.0);
  std::copy(values(x_.get).begin(), values(x_.get).end(), x.begin());
}

}  // namespace tremie
