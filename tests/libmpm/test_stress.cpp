// Verification case 1: the stress of every yield law against closed forms and independently computed numbers.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <random>
#include <vector>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/constitutive/stress.hpp"

namespace tremie {
namespace {

using Matrix = Eigen::Matrix3d;

Matrix full(const SymmetricTensor& a) {
  Matrix m;
  m << a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2];
  return m;
}
SymmetricTensor packed(const Matrix& m) { return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(0, 2)}; }

/// Rotations spread over the whole group, the same in every run.
std::vector<Matrix> rotations() {
  std::mt19937 engine(7);
  std::normal_distribution<double> normal;
  std::vector<Matrix> all{Matrix::Identity()};
  for (int i = 0; i < 50; ++i) {
    Eigen::Quaterniond q(normal(engine), normal(engine), normal(engine), normal(engine));
    all.push_back(q.normalized().toRotationMatrix());
  }
  return all;
}

Matrix simple_shear(double rate) {
  Matrix D = Matrix::Zero();
  D(0, 1) = D(1, 0) = 0.5 * rate;
  return D;
}

/// The stress of the flow D, in many frames: rotated back it must be `expected`. 1e-12: round-off of ten
/// operations.
template <class Law>
void expect_in_every_frame(const Law& law, double mu, double tau_y, const Matrix& D, const Matrix& expected) {
  for (const Matrix& Q : rotations()) {
    const Matrix tau = full(deviatoric_stress(law, mu, tau_y, packed(Q * D * Q.transpose())));
    EXPECT_LE((Q.transpose() * tau * Q - expected).cwiseAbs().maxCoeff(), 1e-12 * expected.norm());
  }
}

// tau = tau_0 + mu gamma_dot in simple shear: published values for tau_0 = 54 Pa, mu = 35.8 Pa s.
TEST(Stress, BinghamSimpleShear) {
  const std::vector<std::pair<double, double>> table{
      {0.5, 71.9}, {1.0, 89.8}, {5.0, 233.0}, {12.43, 498.994}};
  for (const auto& [rate, shear] : table)
    expect_in_every_frame(ExactBingham{0.0}, 35.8, 54.0, simple_shear(rate), 2.0 * simple_shear(shear));
}

// Planar extension at rate e: gamma_dot = 2 e, stress +-(2 mu e + tau_0).
TEST(Stress, BinghamPlanarExtension) {
  for (const auto& [rate, stress] : std::vector<std::pair<double, double>>{{0.5, 89.8}, {1.0, 125.6}})
    expect_in_every_frame(ExactBingham{0.0}, 35.8, 54.0,
                          rate * Eigen::Vector3d(1, -1, 0).asDiagonal().toDenseMatrix(),
                          stress * Eigen::Vector3d(1, -1, 0).asDiagonal().toDenseMatrix());
}

// Uniaxial extension at rate e: D' = e diag(1, -1/2, -1/2), gamma_dot = sqrt(3) e: the hoop and normal terms
// count.
TEST(Stress, BinghamUniaxialExtension) {
  const double rate = 0.7, axial = 2.0 * (35.8 + 54.0 / (std::sqrt(3.0) * rate)) * rate;
  expect_in_every_frame(ExactBingham{0.0}, 35.8, 54.0,
                        rate * Eigen::Vector3d(1, -0.5, -0.5).asDiagonal().toDenseMatrix(),
                        axial * Eigen::Vector3d(1, -0.5, -0.5).asDiagonal().toDenseMatrix());
}

// Newton's smoothing takes at most tau_0 epsilon^2 / (2 gamma_dot^2) off the stress, never more.
TEST(Stress, BinghamSmoothingIsBounded) {
  const ExactBingham law;
  for (double rate = 1e-4; rate < 1e3; rate *= 10.0) {
    const double missing = 54.0 - law.secant(rate, 54.0) * rate;
    EXPECT_GE(missing, -1e-12);
    EXPECT_LE(missing, 54.0 * 0.5 * law.epsilon * law.epsilon / (rate * rate) + 1e-12);
  }
}

// An independent program's numbers, printed with ten digits: hence 1e-9.
TEST(Stress, PapanastasiouIndependentNumbers) {
  const SymmetricTensor D{-0.001171875,        0.0010546875,        -0.00234375,
                          -0.5 * 0.0010546875, -0.5 * 0.0003515625, -0.5 * 0.003515625};
  EXPECT_NEAR(shear_rate(D), 0.0050513114, 5e-11);
  const SymmetricTensor tau = deviatoric_stress(Papanastasiou{10.0}, 50.0, 50.0, D);
  EXPECT_NEAR(tau[3], -0.5669806933, 1e-9);
  EXPECT_NEAR(tau[4], -0.1889935644, 1e-9);
  EXPECT_NEAR(tau[5], -1.8899356444, 1e-9);
  EXPECT_NEAR(tau[0] + tau[1] + tau[2], 0.0, 1e-12);
}

TEST(Stress, PapanastasiouSimpleShear) {
  for (double m : {0.5, 5.0, 100.0, 1e6})
    for (double rate : {1e-6, 1e-3, 0.1, 1.0, 50.0}) {
      const double shear = 35.8 * rate - 54.0 * std::expm1(-m * rate);
      expect_in_every_frame(Papanastasiou{m}, 35.8, 54.0, simple_shear(rate), 2.0 * simple_shear(shear));
    }
}

// Below the critical rate the viscosity is mu + tau_0 / gamma_c, above it the flow is a Bingham one.
TEST(Stress, BiViscousSimpleShear) {
  const BiViscous law{0.1};
  expect_in_every_frame(law, 35.8, 54.0, simple_shear(0.04), 2.0 * simple_shear((35.8 + 540.0) * 0.04));
  expect_in_every_frame(law, 35.8, 54.0, simple_shear(2.0), 2.0 * simple_shear(54.0 + 35.8 * 2.0));
}

// Volume change alone makes no deviatoric stress, and adding it changes none.
TEST(Stress, DilatationDoesNotMatter) {
  const Matrix D = simple_shear(0.8);
  for (double rate : {-3.0, 1e-3, 40.0})
    expect_in_every_frame(Papanastasiou{20.0}, 10.0, 30.0, D + rate * Matrix::Identity(),
                          2.0 * simple_shear(8.0 + 30.0 * (1.0 - std::exp(-16.0))));
}

// gamma_dot -> 0: the viscosity tends to mu + m tau_0 with the relative error m gamma_dot / 2, and nothing is
// 0/0.
TEST(Stress, RestLimit) {
  for (double m : {5.0, 100.0, 1e6})
    for (double x = 1e-12; x < 1e-3; x *= 10.0) {
      const double viscosity = Papanastasiou{m}.secant(x / m, 54.0);
      EXPECT_NEAR(viscosity / (54.0 * m), 1.0 - 0.5 * x, x * x + 1e-14);
    }
  for (double s : deviatoric_stress(Papanastasiou{1e6}, 35.8, 54.0, {})) EXPECT_EQ(s, 0.0);
  for (double s : deviatoric_stress(BiViscous{}, 35.8, 54.0, {})) EXPECT_EQ(s, 0.0);
  for (double s : deviatoric_stress(ExactBingham{}, 35.8, 54.0, {})) EXPECT_EQ(s, 0.0);
}

// gamma_dot -> infinity: every law carries tau_0 + mu gamma_dot.
TEST(Stress, FastLimit) {
  const auto carried = [](const auto& law) { return law.secant(1e8, 54.0) * 1e8; };
  EXPECT_NEAR(carried(ExactBingham{}), 54.0, 1e-10);
  EXPECT_NEAR(carried(Papanastasiou{5.0}), 54.0, 1e-10);
  EXPECT_NEAR(carried(Papanastasiou{1e6}), 54.0, 1e-10);
  EXPECT_NEAR(carried(BiViscous{}), 54.0, 1e-10);
}

}  // namespace
}  // namespace tremie
