#include "libmpm/linear/band_cholesky.hpp"

#include <Eigen/Cholesky>

namespace tremie {

void BandCholesky::reset(int n, int bandwidth) {
  n_ = n;
  below_ = (bandwidth + block - 1) / block * block;
  columns_.resize((n + block - 1) / block);
  for (Eigen::MatrixXd& c : columns_) c.setZero(block + below_, block);
  // Unknowns that only fill up the last block are decoupled.
  for (int i = n; i < static_cast<int>(columns_.size()) * block; ++i) add(i, i, 1.0);
}

bool BandCholesky::factorise() {
  const int n_blocks = static_cast<int>(columns_.size());
  for (int k = 0; k < n_blocks; ++k) {
    auto diagonal = columns_[k].topRows<block>();
    const Eigen::LLT<Eigen::MatrixXd> llt(diagonal);
    if (llt.info() != Eigen::Success) return false;
    diagonal = llt.matrixLLT();
    const int rows = std::min(below_, (n_blocks - 1 - k) * block);
    auto panel = columns_[k].middleRows(block, rows);
    diagonal.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(panel);
#pragma omp parallel for schedule(dynamic) if (rows > 600)
    for (int j = 0; j < rows / block; ++j)
      columns_[k + 1 + j].topRows(rows - j * block).noalias() -=
          panel.bottomRows(rows - j * block) * panel.middleRows(j * block, block).transpose();
  }
  return true;
}

void BandCholesky::solve(Eigen::VectorXd& x) const {
  const int n_blocks = static_cast<int>(columns_.size());
  x.conservativeResizeLike(Eigen::VectorXd::Zero(n_blocks * block));
  for (int k = 0; k < n_blocks; ++k) {
    const int rows = std::min(below_, (n_blocks - 1 - k) * block);
    auto part = x.segment<block>(k * block);
    columns_[k].topRows<block>().triangularView<Eigen::Lower>().solveInPlace(part);
    x.segment((k + 1) * block, rows).noalias() -= columns_[k].middleRows(block, rows) * part;
  }
  for (int k = n_blocks - 1; k >= 0; --k) {
    const int rows = std::min(below_, (n_blocks - 1 - k) * block);
    auto part = x.segment<block>(k * block);
    part.noalias() -= columns_[k].middleRows(block, rows).transpose() * x.segment((k + 1) * block, rows);
    columns_[k].topRows<block>().triangularView<Eigen::Lower>().transpose().solveInPlace(part);
  }
  x.conservativeResize(n_);
}

}  // namespace tremie
