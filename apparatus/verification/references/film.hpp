#pragma once

// A Bingham film down an inclined plane and plane Poiseuille flow: steady flows v(y) along x whose shear
// stress is known, tau = rho g_x (surface - y), from the free surface of the film or the middle of the
// channel. Exact yield: gamma_dot = max(0, tau - tau_0)/mu and v a parabola up to the plug. Regularised
// (Papanastasiou): tau(gamma_dot) = mu gamma_dot + tau_0 (1 - e^(-m gamma_dot)), equation (33), solved for
// gamma_dot and summed.

#include <omp.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/implicit/step.hpp"
#include "libmpm/particles/seeding.hpp"

namespace tremie::verification::film {

inline constexpr double tau_0 = 54.0, mu = 35.8, rho = 2400.0, height = 0.1;

/// One of the two flows: where the shear stress vanishes and what drives it. Both have 144 Pa on the floor.
struct Flow {
  bool film = true;
  double surface() const { return film ? height : 0.5 * height; }
  double g_x() const { return film ? 0.6 : 1.2; }
  double shear_stress(double y) const { return rho * g_x() * (surface() - y); }
  double plug_from() const { return surface() - tau_0 / (rho * g_x()); }
  double mirrored(double y) const { return film ? y : std::min(y, height - y); }
};

inline double exact_velocity(const Flow& flow, double y) {
  const double z = std::min(flow.mirrored(y), flow.plug_from()), top = flow.plug_from();
  return rho * flow.g_x() / (2.0 * mu) * z * (2.0 * top - z);
}

/// The regularised profile: gamma_dot(y) by bisection, its integral by Gauss' rule on 4000 intervals.
class RegularisedProfile {
 public:
  RegularisedProfile(const Flow& flow, double m) : flow_(flow), m_(m), sum_(n_ + 1, 0.0) {
    for (int i = 0; i < n_; ++i) sum_[i + 1] = sum_[i] + integral(i * step(), (i + 1) * step());
  }
  double operator()(double y) const {
    const double z = flow_.mirrored(y);
    const int i = std::min(n_ - 1, static_cast<int>(z / step()));
    return sum_[i] + integral(i * step(), z);
  }

 private:
  double step() const { return flow_.surface() / n_; }
  double rate(double y) const {
    const double tau = flow_.shear_stress(y);
    double low = 0.0, high = tau / mu;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (mu * middle - tau_0 * std::expm1(-m_ * middle) < tau ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
  double integral(double a, double b) const {
    const double c = 0.5 * (a + b), w = 0.5 * (b - a), off = w * std::sqrt(0.6);
    return w / 9.0 * (5.0 * rate(c - off) + 8.0 * rate(c) + 5.0 * rate(c + off));
  }
  static constexpr int n_ = 4000;
  Flow flow_;
  double m_;
  std::vector<double> sum_;
};

/// The steady solution at a point.
struct Sample {
  double y, v, gamma_dot, weight;
};

/// Runs to the steady state, `cells` over the height, and samples the velocity at three Gauss points a cell.
/// Steps of 0.1 s for 6 s: the slowest decay is exp(-3.7 t/s), so 1e-8 of the start is left.
/// `converged` is that of the last step: the start is of no interest.
template <class Law>
std::vector<Sample> steady_state(const Flow& flow, const Law& law, YieldMethod method, int cells,
                                 bool& converged) {
  omp_set_num_threads(1);
  ImplicitBody<PlaneStrain> body;
  body.mix.tau_0 = tau_0, body.mix.mu = mu, body.mix.K = 1e6, body.mix.density = rho;
  body.gravity = {flow.g_x(), flow.film ? -9.79 : 0.0};
  const double h = height / cells;
  body.grid.axes[0] = {.h = 0.02, .periodic = true, .n_cells = 2};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip};
  if (!flow.film) body.grid.axes[1].high = FaceKind::no_slip, body.grid.axes[1].n_cells = cells;
  seed_box<PlaneStrain>(
      {0.0, 0.0}, {0.04, height}, {4, 2 * cells}, rho, body.mix.K, [](const auto&) { return true; },
      [&](const auto& x) { return -rho * body.gravity[1] * (height - x[1]); }, body.points);
  StepSettings settings;
  settings.method = method;
  settings.fixed_dt = 0.1;
  settings.admm.tolerance = 1e-6;  // far below the smallest discretisation error looked for
  settings.admm.max_iterations = 20000;
  settings.newton.tolerance = 1e-8;
  StepReport last;
  for (int i = 0; i < 60; ++i) last = implicit_step(body, law, settings);
  converged = last.converged;

  std::vector<Sample> samples;
  for (int c = 0; c < body.grid.n_cells(); ++c)
    for (int k = 0; k < 3; ++k) {
      const Vec<2> s(0.31, 0.5 + (k - 1) * 0.5 * std::sqrt(0.6));
      const Stencil<2> st = stencil<2>(body.grid.axes, body.grid.cell_index[c], s);
      Sample sample{position_in_cell<2>(body.grid.axes, body.grid.cell_index[c], s)[1], 0.0, 0.0,
                    k == 1 ? 8.0 / 18.0 : 5.0 / 18.0};
      for (int i = 0; i < 9; ++i) {
        sample.v += st.N[i] * body.v[body.grid.cell_nodes[c][i]][0];
        sample.gamma_dot += st.g[i][1] * body.v[body.grid.cell_nodes[c][i]][0];
      }
      if (sample.y < height) samples.push_back(sample);
    }
  return samples;
}

/// L2 error of the profile, relative to the L2 norm of the profile itself.
template <class Profile>
double relative_error(const std::vector<Sample>& samples, Profile profile) {
  double error = 0.0, norm = 0.0;
  for (const Sample& p : samples) {
    error += p.weight * std::pow(p.v - profile(p.y), 2);
    norm += p.weight * std::pow(profile(p.y), 2);
  }
  return std::sqrt(error / norm);
}

}  // namespace tremie::verification::film
