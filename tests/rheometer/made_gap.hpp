#pragma once

// A whole test of a thixotropic Herschel-Bulkley material between a cylinder and its container, made from the equations
// alone, with nothing of libmpm or of the fit:
//
//   T/(2 pi r^2 h) = (1 + lambda) tau_0 + k gamma_dot^n where it yields,   int gamma_dot/r dr = Omega,
//   d lambda/dt = A_thix/tau_0 - alpha lambda gamma_dot.
//
// Radii stand closer at the vane (ln r - ln R_i as i^2), the integral is the trapezoidal rule, the torque is found by bisection, and lambda goes
// on by Heun's method. A test is a ramp down of the broken material; after each rest lambda is A_thix rest/tau_0; a
// start-up rises with the modulus G before it flows. Noise in proportion to the torque.

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "rheometer/records/sections.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::made {

struct GapMaterial {
  double tau_0 = 40.0, k = 15.0, n = 0.55, A_thix = 0.8, alpha = 0.03, G = 400.0;
};

class Gap {
 public:
  Gap(const GapMaterial& m, const Instrument& in, std::size_t nodes) : m_(m), in_(in), lambda_(nodes, 0.0) {
    const double width = std::log(in.container_radius / in.vane_radius);
    const auto x = [&](std::size_t i) {
      const double share = static_cast<double>(i) / static_cast<double>(nodes - 1);
      return width * share * share;
    };
    for (std::size_t i = 0; i < nodes; ++i) {
      radius_.push_back(in.vane_radius * std::exp(x(i)));
      weight_.push_back(0.5 * (x(std::min(i + 1, nodes - 1)) - x(i > 0 ? i - 1 : 0)));
    }
  }

  void set(double lambda) { std::fill(lambda_.begin(), lambda_.end(), lambda); }

  double torque(double omega) const { return torque(lambda_, omega); }

  void advance(double omega, double dt) {
    std::vector<double> first = rates(lambda_, omega), predicted = lambda_;
    for (std::size_t i = 0; i < lambda_.size(); ++i) predicted[i] += dt * first[i];
    const std::vector<double> second = rates(predicted, omega);
    for (std::size_t i = 0; i < lambda_.size(); ++i) lambda_[i] += 0.5 * dt * (first[i] + second[i]);
  }

 private:
  double shear_rate(double torque, std::size_t i, double lambda) const {
    const double stress = torque / (2.0 * std::numbers::pi * radius_[i] * radius_[i] * in_.vane_height);
    return std::pow(std::max(0.0, stress - (1.0 + lambda) * m_.tau_0) / m_.k, 1.0 / m_.n);
  }

  double torque(const std::vector<double>& lambda, double omega) const {
    const auto speed = [&](double T) {
      double sum = 0.0;
      for (std::size_t i = 0; i < radius_.size(); ++i) sum += weight_[i] * shear_rate(T, i, lambda[i]);
      return sum;
    };
    double low = 0.0, high = 1.0;
    while (speed(high) < omega) high *= 2.0;
    for (int i = 0; i < 50; ++i) {
      const double middle = 0.5 * (low + high);
      (speed(middle) < omega ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }

  std::vector<double> rates(const std::vector<double>& lambda, double omega) const {
    const double T = torque(lambda, omega);
    std::vector<double> result;
    for (std::size_t i = 0; i < lambda.size(); ++i)
      result.push_back(m_.A_thix / m_.tau_0 - m_.alpha * lambda[i] * shear_rate(T, i, lambda[i]));
    return result;
  }

  GapMaterial m_;
  Instrument in_;
  std::vector<double> radius_, weight_, lambda_;
};

/// Torque of the vane over the cylinder's, by speed and by the cylinder's torque; for a cylinder 1.
using TorqueFactor = std::function<double(double omega, double torque)>;

struct GapTest {
  GapMaterial material;
  Instrument instrument;
  double noise = 0.002;
  unsigned seed = 1;
  std::vector<double> growth_rests = {60.0, 120.0, 240.0};  ///< start-ups after them at 0.025 rev/s
  double decay_rest = 240.0;                                ///< before the decay at 0.25 rev/s; 0: no decay
  bool flow_curve = true;
  TorqueFactor factor = [](double, double) { return 1.0; };
  std::size_t nodes = 240;
  double elastic_factor = 1.0;  ///< the same while the material is strained elastically
};

inline ProtocolRecord record_of(const GapTest& test) {
  Gap gap(test.material, test.instrument, test.nodes);
  std::mt19937_64 generator(test.seed);
  std::normal_distribution<double> normal;
  ProtocolRecord r;
  double now = 0.0;
  const auto row = [&](double dt, double omega, double torque) {
    r.time.push_back(now += dt);
    r.omega.push_back(omega);
    r.torque.push_back(omega > 0.0 ? torque * (1.0 + test.noise * normal(generator)) : 0.0);
    r.line.push_back(static_cast<long>(r.line.size()) + 2);
  };
  const auto of_vane = [&](double omega, double torque) { return torque * test.factor(omega, torque); };
  if (test.flow_curve)
    for (int i = 0; i <= 120; ++i) {
      const double omega = angular_speed(0.5 - 0.48 * i / 120.0);
      row(0.5, omega, of_vane(omega, gap.torque(omega)));
    }
  const auto shear = [&](double rest, double omega, double duration, bool elastic) {
    for (int i = 0; i < 20; ++i) row(rest / 20.0, 0.0, 0.0);
    gap.set(test.material.A_thix * rest / test.material.tau_0);
    const Instrument& in = test.instrument;
    const double stiffness =
        4.0 * std::numbers::pi * in.vane_height * test.material.G /
        (1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (in.container_radius * in.container_radius));
    double angle = 0.0;
    constexpr double every = 0.05;
    for (double t = 0.0; t < duration; t += every) {
      const double flowing = gap.torque(omega);
      if (elastic && stiffness * (angle += omega * every) < flowing) {
        row(every, omega, test.elastic_factor * stiffness * angle);
        continue;
      }
      row(every, omega, of_vane(omega, flowing));
      for (int j = 0; j < 2; ++j) gap.advance(omega, every / 2.0);
    }
  };
  for (const double rest : test.growth_rests) shear(rest, angular_speed(0.025), 15.0, true);
  if (test.decay_rest > 0.0) shear(test.decay_rest, angular_speed(0.25), 20.0, false);
  return r;
}

}  // namespace tremie::made
