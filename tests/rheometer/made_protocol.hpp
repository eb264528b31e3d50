#pragma once

// A record of a material that follows rate_power kinetics, sheared evenly: a decay at 20 1/s, then start-ups at 1 1/s after
// rests. Integrated by the classical Runge-Kutta method of order four, with nothing of libmpm or of the fit:
//
//   d lambda_i/dt = share_i A_thix/tau_0 - factor_i k gamma_dot^a lambda_i,   tau = (1 + sum lambda_i) tau_0 + mu gamma_dot,
//
// elastic with the modulus G until that stress is reached, when nothing breaks down. Noise in proportion to the stress.

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "rheometer/records/sections.hpp"
#include "rheometer/reference/instrument.hpp"

namespace tremie::made {

struct Mode {
  double share, factor;
};

struct Material {
  double k = 0.3, a = 0.1;
  std::vector<Mode> modes = {{1.0, 1.0}};
  double tau_0 = 50.0, mu = 2.0, A_thix = 2.0, G = 1000.0, lambda_start = 8.0;
};

struct Noise {
  double deviation = 0.01, correlation = 0.0;  ///< relative; of successive readings
};

class Recorder {
 public:
  Recorder(const Material& m, const Noise& noise, unsigned seed) : m_(m), noise_(noise), generator_(seed) {
    for (const Mode& mode : m.modes) lambda_.push_back(mode.share * m.lambda_start);
  }

  /// Rows every `every` s for `duration` s; a rest where gamma_dot is 0.
  void shear(double gamma_dot, double duration, double every) {
    double elastic = 0.0;
    const int steps = 10;
    for (int i = 1; i <= static_cast<int>(std::lround(duration / every)); ++i) {
      for (int j = 0; j < steps; ++j) {
        elastic += m_.G * gamma_dot * every / steps;
        advance(elastic < flow_stress(gamma_dot) ? 0.0 : gamma_dot, every / steps);
      }
      now_ += every;
      record_.time.push_back(now_);
      record_.omega.push_back(gamma_dot * evenly_sheared_speed);
      record_.torque.push_back(gamma_dot > 0.0 ? std::min(elastic, flow_stress(gamma_dot)) * noise() : 0.0);
      record_.line.push_back(static_cast<long>(record_.line.size()) + 2);
    }
  }

  ProtocolRecord take() {
    record_.sheared_evenly = true;
    return std::move(record_);
  }

 private:
  double flow_stress(double gamma_dot) const {
    double lambda = 0.0;
    for (const double l : lambda_) lambda += l;
    return (1.0 + lambda) * m_.tau_0 + m_.mu * gamma_dot;
  }

  void advance(double gamma_dot, double dt) {
    const double broken = gamma_dot > 0.0 ? m_.k * std::pow(gamma_dot, m_.a) : 0.0;
    for (std::size_t i = 0; i < lambda_.size(); ++i) {
      const double build = m_.modes[i].share * m_.A_thix / m_.tau_0;
      const auto rate = [&](double l) { return build - m_.modes[i].factor * broken * l; };
      const double k1 = rate(lambda_[i]), k2 = rate(lambda_[i] + 0.5 * dt * k1),
                   k3 = rate(lambda_[i] + 0.5 * dt * k2), k4 = rate(lambda_[i] + dt * k3);
      lambda_[i] += dt / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
    }
  }

  double noise() {
    const double fresh = normal_(generator_), rho = noise_.correlation;
    error_ = started_ ? rho * error_ + std::sqrt(1.0 - rho * rho) * fresh : fresh;
    started_ = true;
    return 1.0 + noise_.deviation * error_;
  }

  Material m_;
  Noise noise_;
  std::mt19937_64 generator_;
  std::normal_distribution<double> normal_;
  std::vector<double> lambda_;
  ProtocolRecord record_;
  double now_ = 0.0, error_ = 0.0;
  bool started_ = false;
};

inline ProtocolRecord record_of(const Material& m, const Noise& noise, unsigned seed) {
  Recorder recorder(m, noise, seed);
  recorder.shear(20.0, 30.0, 0.1);
  for (const double rest : {60.0, 120.0, 240.0}) {
    recorder.shear(0.0, rest, 1.0);
    recorder.shear(1.0, 30.0, 0.1);
  }
  return recorder.take();
}

}  // namespace tremie::made
