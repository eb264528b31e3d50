#pragma once

// The ways to integrate lambda that are compared. Forward Euler is here for comparison alone; no program uses it.

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "rheometer/reference/flocculation_ode.hpp"
#include "rheometer/reference/kinetics_equations.hpp"

namespace tremie::study {

inline constexpr double tau_0 = 54.0;

/// A history and the kinetics that it is run with; `times` are those at which lambda is compared.
struct Case {
  std::string name, title;
  std::vector<ShearPiece> history;
  Thixotropy thixotropy;
  double lambda_0 = 5.0;
  std::vector<double> times;
  double largest_dt = 1.0;
};

/// What a step of any of the methods is given: the rate at its ends, and the history itself.
struct Step {
  const ShearPiece& piece;
  double start, g0, g1, dt;  ///< start: since the start of the piece
};

/// The material points' update, which knows the ends of a step.
inline double one_step(const Thixotropy& t, double lambda, const Step& s) {
  return flocculation_step(lambda, t, tau_0, s.g0, s.g1, s.dt);
}

/// The update of a history whose rate is known inside the step.
inline double one_step_along(const Thixotropy& t, double lambda, const Step& s) {
  return flocculation_step_along(lambda, t, tau_0, s.piece.rate, s.start, s.g0, s.g1, s.dt);
}

inline double one_step_of_euler(const Thixotropy& t, double lambda, const Step& s) {
  const bool flowing = s.g0 >= gate(t.kinetics).value_or(0.0);
  return lambda +
         s.dt * kinetics_equations::rate_of_lambda(t.kinetics, t.A_thix / tau_0, lambda, s.g0, flowing);
}

/// lambda at the case's times, in equal steps of about dt between them. Times and pieces end together.
template <class Method>
std::vector<double> march(const Case& c, double dt, Method method) {
  std::vector<double> result;
  result.reserve(c.times.size());
  double lambda = c.lambda_0, piece_start = 0.0, now = 0.0, g0 = c.history.front().rate(0.0);
  std::size_t piece = 0;
  for (const double end : c.times) {
    while (now - piece_start >= c.history[piece].duration * (1.0 - 1e-12)) {
      piece_start += c.history[piece++].duration;
      g0 = c.history[piece].rate(now - piece_start);
    }
    const int n = std::max(1, static_cast<int>(std::lround((end - now) / dt)));
    const double h = (end - now) / n;
    const ShearPiece& p = c.history[piece];
    for (int i = 1; i <= n; ++i) {
      const double start = now - piece_start + (i - 1) * h, g1 = p.rate(start + h);
      lambda = method(c.thixotropy, lambda, Step{p, start, g0, g1, h});
      g0 = g1;
    }
    now = end;
    result.push_back(lambda);
  }
  return result;
}

/// lambda at the case's times by ARKODE: explicit Runge-Kutta of order 4, or implicit of order 4 where
/// `stiff`; steps adapted to the tolerance, gate crossings found as roots.
std::vector<double> by_arkode(const Case& c, double tolerance, bool stiff);

/// lambda after steps of dt between the rates given, by CVODE as a simulation would have to use it: one
/// integrator, started anew in every step, in which the rate is linear.
double by_cvode_step_by_step(const Case& c, double tolerance, double dt, std::span<const double> rates);

}  // namespace tremie::study
