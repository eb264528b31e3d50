#pragma once

// The linear system of a step in 3D, by preconditioned conjugate gradients without a matrix.

#include <vector>

#include "libmpm/implicit/problem/yield_problem.hpp"
#include "libmpm/implicit/schur/preconditioner.hpp"
#include "libmpm/linear/conjugate_gradients.hpp"

namespace tremie {

/// Adds what walls inside the grid do to the field x.
template <class Vector>
void add_penalty_products(std::span<const PointTerm<3>> terms, const CellNodes<3>& cell_nodes,
                          const Vector& x, Vector& out) {
  using Scalar = typename Vector::Scalar;
  constexpr int stride = node_stride<Scalar>;
  for (const PointTerm<3>& t : terms) {
    Vec<3> u = Vec<3>::Zero();
    for (int k = 0; k < 27; ++k)
      u += t.N[k] * x.template segment<3>(stride * cell_nodes[t.cell][k]).template cast<double>();
    u = t.penalty * u;
    for (int k = 0; k < 27; ++k)
      out.template segment<3>(stride * cell_nodes[t.cell][k]) += (t.N[k] * u).template cast<Scalar>();
  }
}

/// Adds the force f at a contact to its nodes; four numbers a node.
template <class Scalar>
void add_at_contact(const ContactPoint<3>& c, const std::array<int, 27>& nodes, double f, Scalar* to) {
  using Four = Eigen::Matrix<Scalar, 4, 1>;
  Four force;
  force << (f * c.normal).cast<Scalar>(), Scalar(0);
  for (std::size_t i = 0, k = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const Four line = static_cast<Scalar>(c.along[0][i] * c.along[1][j]) * force;
      for (std::size_t l = 0; l < 3; ++l, ++k)
        Eigen::Map<Four>(to + 4 * static_cast<std::ptrdiff_t>(nodes[k])) +=
            static_cast<Scalar>(c.along[2][l]) * line;
    }
}

/// Normal velocity at a contact of the field x, four numbers a node.
inline double normal_velocity(const ContactPoint<3>& c, const std::array<int, 27>& nodes, const float* x) {
  Eigen::Vector4f u = Eigen::Vector4f::Zero();
  for (std::size_t i = 0, k = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      Eigen::Vector4f line = Eigen::Vector4f::Zero();
      for (std::size_t l = 0; l < 3; ++l, ++k)
        line += static_cast<float>(c.along[2][l]) *
                Eigen::Map<const Eigen::Vector4f>(x + 4 * static_cast<std::ptrdiff_t>(nodes[k]));
      u += static_cast<float>(c.along[0][i] * c.along[1][j]) * line;
    }
  return c.normal.dot(u.head<3>().cast<double>());
}

/// Calls use(contact) for the closed ones with a moving wall in a chunk of cells; they are in the cells'
/// order.
template <class Use>
void for_each_contact(const std::vector<ContactPoint<3>>& contact, const NodeReduction& reduction, int chunk,
                      Use use) {
  auto c = std::lower_bound(contact.begin(), contact.end(), reduction.first_cell(chunk),
                            [](const ContactPoint<3>& point, int cell) { return point.cell < cell; });
  for (; c != contact.end() && c->cell < reduction.last_cell(chunk); ++c)
    if (c->active) use(*c);
}

void add_penalty_blocks(std::span<const PointTerm<3>> terms, const CellNodes<3>& cell_nodes,
                        std::vector<Mat<3, 3>>& blocks);

/// Inverts node blocks in place; what a wall prescribes becomes zero.
void invert_blocks(const std::vector<char>& fixed, std::vector<Mat<3, 3>>& G);

/// Strain rate q at quadrature point k as ThreeD has it, and the divergence.
template <class Scalar>
void strain_at(const QuadratureTensors<Scalar>& G, int k, Lanes<Scalar> (&q)[5], Lanes<Scalar>& div) {
  const Lanes<Scalar>&xx = G.g[0][0][k], &yy = G.g[1][1][k], &zz = G.g[2][2][k];
  const Lanes<Scalar> plane = xx + yy;
  q[0] = xx - yy;
  q[1] = (plane - Scalar(2) * zz) * static_cast<Scalar>(inv_sqrt3);
  q[2] = G.g[0][1][k] + G.g[1][0][k];
  q[3] = G.g[1][2][k] + G.g[2][1][k];
  q[4] = G.g[0][2][k] + G.g[2][0][k];
  div = plane + zz;
}

/// The tensor whose adjoint is that of the deviatoric stress s, with a pull p in all directions: T = s + p I.
template <class Scalar>
void stress_at(const Lanes<Scalar> (&s)[5], const Lanes<Scalar>& p, int k, QuadratureTensors<Scalar>& T) {
  const Lanes<Scalar> half = s[1] * static_cast<Scalar>(inv_sqrt3);
  T.g[0][0][k] = p + half + s[0];
  T.g[1][1][k] = p + half - s[0];
  T.g[2][2][k] = p - Scalar(2) * half;
  T.g[0][1][k] = T.g[1][0][k] = s[2];
  T.g[1][2][k] = T.g[2][1][k] = s[3];
  T.g[0][2][k] = T.g[2][0][k] = s[4];
}

/// Volumes of a batch of cells, lane by lane; 0 where a lane has no cell.
template <class Scalar>
struct BatchVolumes {
  Lanes<Scalar> V[8], inverse_cell;
};

inline BatchVolumes<double> batch_volumes(const Quadrature<ThreeD>& quad, int batch) {
  BatchVolumes<double> own;
  for (int l = 0; l < batch_size; ++l) {
    const std::size_t c = static_cast<std::size_t>(batch) * batch_size + static_cast<std::size_t>(l);
    const bool there = c < quad.V.size();
    for (std::size_t k = 0; k < 8; ++k) own.V[k][l] = there ? quad.V[c][k] : 0.0;
    own.inverse_cell[l] = there && quad.V_cell[c] > 0.0 ? 1.0 / quad.V_cell[c] : 0.0;
  }
  return own;
}

class MatrixFreeSystem {
 public:
  /// Lays out the cells.
  void set_up(YieldProblem<ThreeD>& problem, double most_band_operations);
  /// Everything that does not change within a step, and the preconditioner; `eta_system` is the viscosity of the
  /// system's deviatoric part [Pa s]. False where it is not definite.
  bool prepare(YieldProblem<ThreeD>& problem, double eta_system);

  /// A x in single precision, four numbers a node. Prescribed components of x are zero, and those of the
  /// result too.
  void multiply(const YieldProblem<ThreeD>& problem, const Eigen::VectorXf& x, Eigen::VectorXf& out);
  /// Adds A^-1 R to v as conjugate_gradients() does it, (r, P^-1 r) in watts.
  double solve(const YieldProblem<ThreeD>& problem, const Eigen::VectorXd& R, const PcgTolerances& goal,
               std::vector<Vec<3>>& v);
  /// Mean shear rate of every cell over its quadrature points, and the volume mean of all [1/s].
  void shear_rates(const YieldProblem<ThreeD>& problem, const std::vector<Vec<3>>& v,
                   std::vector<double>& of_cell, double& mean) const;

  /// Gives back the memory of a large body until the next set_up(); false if it is none.
  bool release() {
    if (!preconditioner.release()) return false;
    batches = {};
    forces = {};
    tremie::release(weights_);
    free_.resize(0), free_diagonal_.resize(0);
    return true;
  }

  CellBatches batches;
  ReductionBuffer forces;                        ///< buffers for what chunks of cells give their nodes
  SchurComplementPreconditioner preconditioner;  ///< of the last prepare(); free for others between solves
  long long products = 0;

 private:
  /// What add_node_stiffness_admm() adds to.
  struct Diagonal {
    Eigen::VectorXd& value;
    void add_diagonal(int node, int d, double x) { value[3 * node + d] += x; }
  };
  std::vector<Mat<3, 3>> node_blocks(const YieldProblem<ThreeD>& problem,
                                     const Eigen::VectorXd& diagonal) const;

  double eta_system_ = 0.0;
  Eigen::VectorXf free_,
      free_diagonal_;  ///< 1 and the diagonal where nothing is prescribed, else 0; by fours
  std::vector<BatchVolumes<float>> weights_;
};

}  // namespace tremie
