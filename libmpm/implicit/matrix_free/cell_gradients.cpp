#include "libmpm/implicit/matrix_free/cell_gradients.hpp"

namespace tremie {

void CellBatches::lay_out(const ActiveGrid<3>& grid) {
  n_cells_ = grid.n_cells();
  const int n_nodes = grid.n_nodes();
  for (int d = 0; d < 3; ++d) inverse_h_[d] = 1.0 / grid.axes[d].h;
  const int n = (n_cells_ + batch_size - 1) / batch_size;
  lines_ = !grid.axes[2].periodic;
  const int kept = kept_nodes(), step = 27 / kept;
  tremie::resize_for_overwrite(nodes_, static_cast<std::size_t>(n) * kept);
  tremie::resize_for_overwrite(ends_, static_cast<std::size_t>(n));
#pragma omp parallel for schedule(static)
  for (int b = 0; b < n; ++b)
    for (int l = 0; l < batch_size; ++l) {
      const int c =
          std::min(b * batch_size + l, n_cells_ - 1);  // lanes beyond the last cell repeat it, unheard
      for (int j = 0; j < kept; ++j) nodes_[b * kept + j][l] = grid.cell_nodes[c][step * j];
      for (int d = 0; d < 3; ++d) {
        const Axis& a = grid.axes[d];
        const int i = grid.cell_index[c][d];
        ends_[b].low[d][l] = a.interpolates_low(i) ? 2.0f : 1.0f;
        ends_[b].high[d][l] = a.interpolates_high(i) ? 2.0f : 1.0f;
      }
    }
  node_begin_.assign(n_nodes + 1, 0);
  for (const auto& nodes : grid.cell_nodes)
    for (int i : nodes) ++node_begin_[i + 1];
  for (int i = 0; i < n_nodes; ++i) node_begin_[i + 1] += node_begin_[i];
  tremie::resize_for_overwrite(node_entry_, static_cast<std::size_t>(n_cells_) * 27);
  std::vector<int> next(node_begin_.begin(), node_begin_.end() - 1);
  for (int c = 0; c < n_cells_; ++c)
    for (int k = 0; k < 27; ++k) node_entry_[next[grid.cell_nodes[c][k]]++] = c * of_cell + k;
  reduction_.lay_out(grid, batch_size);
}

template <class Scalar>
void CellBatches::gradients(int batch, const Scalar* v, QuadratureTensors<Scalar>& out) const {
  constexpr auto near = static_cast<Scalar>(near_), far = static_cast<Scalar>(far_);
  constexpr auto near2 = static_cast<Scalar>(0.5 * near_ * near_),
                 far2 = static_cast<Scalar>(0.5 * far_ * far_);
  const Factors<Scalar> ends = factors<Scalar>(batch);
  const auto& inverse_h = ends.inverse_h;
  Lanes<Scalar> u[3][27];
  const Nodes* nodes = &nodes_[batch * kept_nodes()];
  for (int k = 0; k < 27; ++k) {
    const int* first = nodes[lines_ ? k / 3 : k].data();
    load_nodes(v + (lines_ ? node_stride<Scalar> * (k % 3) : 0), first, u[0][k], u[1][k], u[2][k]);
  }
  for (int d = 0; d < 3; ++d) {
    Lanes<Scalar> X[2][9], dX[2][9];
    for (int j = 0; j < 9; ++j) {
      const Lanes<Scalar> a = ends.low[0] * (u[d][j] - u[d][9 + j]),
                          c = ends.high[0] * (u[d][18 + j] - u[d][9 + j]);
      X[0][j] = u[d][9 + j] + near2 * a + far2 * c;
      X[1][j] = u[d][9 + j] + far2 * a + near2 * c;
      dX[0][j] = inverse_h[0] * (far * c - near * a);
      dX[1][j] = inverse_h[0] * (near * c - far * a);
    }
    for (int p = 0; p < 2; ++p) {
      Lanes<Scalar> XY[2][3], XdY[2][3], dXY[2][3];
      for (int k = 0; k < 3; ++k) {
        const Lanes<Scalar> a = ends.low[1] * (X[p][k] - X[p][3 + k]),
                            c = ends.high[1] * (X[p][6 + k] - X[p][3 + k]);
        XY[0][k] = X[p][3 + k] + near2 * a + far2 * c;
        XY[1][k] = X[p][3 + k] + far2 * a + near2 * c;
        XdY[0][k] = inverse_h[1] * (far * c - near * a);
        XdY[1][k] = inverse_h[1] * (near * c - far * a);
        const Lanes<Scalar> da = ends.low[1] * (dX[p][k] - dX[p][3 + k]),
                            dc = ends.high[1] * (dX[p][6 + k] - dX[p][3 + k]);
        dXY[0][k] = dX[p][3 + k] + near2 * da + far2 * dc;
        dXY[1][k] = dX[p][3 + k] + far2 * da + near2 * dc;
      }
      for (int q = 0; q < 2; ++q) {
        const int lo = p + 2 * q, hi = lo + 4;
        const auto value = [&](const Lanes<Scalar>* w, Lanes<Scalar>& low, Lanes<Scalar>& high) {
          const Lanes<Scalar> a = ends.low[2] * (w[0] - w[1]), c = ends.high[2] * (w[2] - w[1]);
          low = w[1] + near2 * a + far2 * c;
          high = w[1] + far2 * a + near2 * c;
        };
        value(dXY[q], out.g[d][0][lo], out.g[d][0][hi]);
        value(XdY[q], out.g[d][1][lo], out.g[d][1][hi]);
        const Lanes<Scalar> a = ends.low[2] * (XY[q][0] - XY[q][1]), c = ends.high[2] * (XY[q][2] - XY[q][1]);
        out.g[d][2][lo] = inverse_h[2] * (far * c - near * a);
        out.g[d][2][hi] = inverse_h[2] * (near * c - far * a);
      }
    }
  }
}

template <class Scalar>
void CellBatches::scatter(int batch, const QuadratureTensors<Scalar>& T, Scalar* to) const {
  constexpr auto near = static_cast<Scalar>(near_), far = static_cast<Scalar>(far_);
  constexpr auto near2 = static_cast<Scalar>(0.5 * near_ * near_),
                 far2 = static_cast<Scalar>(0.5 * far_ * far_);
  const Factors<Scalar> ends = factors<Scalar>(batch);
  const auto& inverse_h = ends.inverse_h;
  Lanes<Scalar> u[3][27];
  // A value's adjoint gives a, c and u1 their shares of X0, X1; a slope's those of D0, D1.
  const auto adjoint = [](const Lanes<Scalar>& low, const Lanes<Scalar>& high, const Lanes<Scalar>& a,
                          const Lanes<Scalar>& c, const Lanes<Scalar>& sum, Lanes<Scalar>& u0,
                          Lanes<Scalar>& u1, Lanes<Scalar>& u2) {
    u0 = low * a;
    u2 = high * c;
    u1 = sum - u0 - u2;
  };
  for (int d = 0; d < 3; ++d) {
    Lanes<Scalar> X[2][9], dX[2][9];
    for (int p = 0; p < 2; ++p) {
      Lanes<Scalar> XY[2][3], XdY[2][3], dXY[2][3];
      for (int q = 0; q < 2; ++q) {
        const int lo = p + 2 * q, hi = lo + 4;
        const auto value = [&](const Lanes<Scalar>& x0, const Lanes<Scalar>& x1, Lanes<Scalar>* w) {
          adjoint(ends.low[2], ends.high[2], near2 * x0 + far2 * x1, far2 * x0 + near2 * x1, x0 + x1, w[0],
                  w[1], w[2]);
        };
        value(T.g[d][0][lo], T.g[d][0][hi], dXY[q]);
        value(T.g[d][1][lo], T.g[d][1][hi], XdY[q]);
        const Lanes<Scalar> d0 = inverse_h[2] * T.g[d][2][lo], d1 = inverse_h[2] * T.g[d][2][hi];
        adjoint(ends.low[2], ends.high[2], -near * d0 - far * d1, far * d0 + near * d1, Lanes<Scalar>::Zero(),
                XY[q][0], XY[q][1], XY[q][2]);
      }
      for (int k = 0; k < 3; ++k) {
        const Lanes<Scalar> d0 = inverse_h[1] * XdY[0][k], d1 = inverse_h[1] * XdY[1][k];
        const Lanes<Scalar>&x0 = XY[0][k], &x1 = XY[1][k];
        adjoint(ends.low[1], ends.high[1], near2 * x0 + far2 * x1 - near * d0 - far * d1,
                far2 * x0 + near2 * x1 + far * d0 + near * d1, x0 + x1, X[p][k], X[p][3 + k], X[p][6 + k]);
        const Lanes<Scalar>&y0 = dXY[0][k], &y1 = dXY[1][k];
        adjoint(ends.low[1], ends.high[1], near2 * y0 + far2 * y1, far2 * y0 + near2 * y1, y0 + y1, dX[p][k],
                dX[p][3 + k], dX[p][6 + k]);
      }
    }
    for (int j = 0; j < 9; ++j) {
      const Lanes<Scalar> d0 = inverse_h[0] * dX[0][j], d1 = inverse_h[0] * dX[1][j];
      const Lanes<Scalar>&x0 = X[0][j], &x1 = X[1][j];
      adjoint(ends.low[0], ends.high[0], near2 * x0 + far2 * x1 - near * d0 - far * d1,
              far2 * x0 + near2 * x1 + far * d0 + near * d1, x0 + x1, u[d][j], u[d][9 + j], u[d][18 + j]);
    }
  }
  const int n = std::min(batch_size, n_cells_ - batch * batch_size);
  const Nodes* nodes = &nodes_[batch * kept_nodes()];
  for (int k = 0; k < 27; ++k) {
    for (int d = 0; d < 3 && n < batch_size; ++d) u[d][k].tail(batch_size - n).setZero();
    const int* first = nodes[lines_ ? k / 3 : k].data();
    add_lanes(u[0][k], u[1][k], u[2][k], first, to + (lines_ ? 4 * (k % 3) : 0));
  }
}

template void CellBatches::gradients(int, const float*, QuadratureTensors<float>&) const;
template void CellBatches::gradients(int, const double*, QuadratureTensors<double>&) const;
template void CellBatches::scatter(int, const QuadratureTensors<float>&, float*) const;
template void CellBatches::scatter(int, const QuadratureTensors<double>&, double*) const;

}  // namespace tremie
