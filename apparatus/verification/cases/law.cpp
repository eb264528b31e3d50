// Case 1: the deviatoric stress of every yield law in simple shear, rotated into many frames, against its
// closed form in extended precision.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "apparatus/verification/suite.hpp"
#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/constitutive/stress.hpp"

namespace tremie::verification {
namespace {

using Matrix = Eigen::Matrix3d;

constexpr double tau_0 = 54.0, mu = 35.8;

Matrix full(const SymmetricTensor& a) {
  Matrix m;
  m << a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2];
  return m;
}
SymmetricTensor packed(const Matrix& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)}; }

std::vector<Matrix> rotations(int n) {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  std::vector<Matrix> all{Matrix::Identity()};
  while (static_cast<int>(all.size()) < n) {
    const Eigen::Quaterniond q(normal(engine), normal(engine), normal(engine), normal(engine));
    all.push_back(q.normalized().toRotationMatrix());
  }
  return all;
}

// Shear stress of each law straight from its definition, equations (27), (32) and (33).
long double shear_stress(const ExactBingham&, long double rate) { return mu * rate + tau_0; }
long double shear_stress(const Papanastasiou& law, long double rate) {
  return mu * rate - tau_0 * std::expm1(-static_cast<long double>(law.m) * rate);
}
long double shear_stress(const BiViscous& law, long double rate) {
  return mu * rate + tau_0 * std::min(rate / static_cast<long double>(law.gamma_c), 1.0L);
}

/// Worst error over rates of 1e-9 to 1e6 1/s and over the frames, relative to the stress.
template <class Law>
Series worst_over_frames(const std::string& name, const Law& law, const std::vector<Matrix>& frames) {
  const double start = cpu_seconds();
  double worst = 0.0;
  for (double rate = 1e-9; rate < 2e6; rate *= 10.0) {
    Matrix D = Matrix::Zero(), exact = Matrix::Zero();
    D(0, 1) = D(1, 0) = 0.5 * rate;
    exact(0, 1) = exact(1, 0) = static_cast<double>(shear_stress(law, rate));
    for (const Matrix& Q : frames) {
      const Matrix tau = full(deviatoric_stress(law, mu, tau_0, packed(Q * D * Q.transpose())));
      worst = std::max(worst, (Q.transpose() * tau * Q - exact).norm() / exact.norm());
    }
  }
  return {name, {{"1e-9 to 1e6 1/s", 0.0, worst, cpu_seconds() - start}}};
}

}  // namespace

Case law_case(Depth depth) {
  const auto frames = rotations(depth == Depth::full ? 5000 : 500);
  Problem one{.name = "law",
              .title = "Simple shear in rotated frames",
              .equation = "τ = 2 [μ + s(γ̇)] D', equations (27), (32), (33)",
              .reference = "the laws' definitions in extended precision",
              .norm = "largest |Qᵀ τ Q − τ_exact| / |τ_exact| over rates and frames"};
  one.series = {worst_over_frames("exact Bingham", ExactBingham{0.0}, frames),
                worst_over_frames("Papanastasiou, m = 5 s", Papanastasiou{5.0}, frames),
                worst_over_frames("Papanastasiou, m = 1e6 s", Papanastasiou{1e6}, frames),
                worst_over_frames("bi-viscous, 0.1 1/s", BiViscous{0.1}, frames)};
  bound_errors(one, ": worst error", 1e-12);
  return {1, "The law", {one}};
}

}  // namespace tremie::verification
