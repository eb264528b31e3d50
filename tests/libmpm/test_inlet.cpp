// Concrete that comes out of a pipe, and what it flows through: the inlet's volume, the annulus beside the pipe, and the
// pressure under a deep pour.

#include <gtest/gtest.h>
#include <omp.h>

#include <numbers>

#include "apparatus/parts/pipe_flow.hpp"
#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/boundary/openings/inlet.hpp"
#include "libmpm/boundary/openings/outlet.hpp"

namespace tremie {
namespace {

using namespace bodies;

constexpr double g = 9.81;

// What the columns let in is the flow to rounding.
TEST(Inlet, LetsInTheFlow) {
  const std::array<Axis, 2> axes{
      Axis{.h = 0.04, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = 10},
      Axis{.h = 0.05, .low = FaceKind::no_slip}};
  Inlet inlet = make_inlet<Axisymmetric>(axes, 3, 8, 6, 0.05 / 3);
  inlet.flow = 0.007;
  double volume = 0.0;
  for (int i = 0; i < 100; ++i)
    let_in(inlet, axes[1], 0.07, [&](const Vec<2>& x, double V, double speed) {
      EXPECT_LE(x[1], 0.4);
      EXPECT_LE(speed, plug_speed(inlet));
      volume += V;
    });
  EXPECT_NEAR(volume + volume_waiting(inlet), 0.007 * 7.0, 1e-15);
  EXPECT_LT(volume_waiting(inlet), std::numbers::pi * 0.12 * 0.12 * 0.05 / 3);
}

/// What the grid's own velocity on the mouth carries, by ten Gauss points a cell on the nodes' splines.
double flux_of_grid(const ImplicitBody<Axisymmetric>& body, const Inlet& inlet) {
  double flux = 0.0;
  const Axis& r = body.grid.axes[0];
  constexpr int n = 200;
  for (int c = 0; c < inlet.cells; ++c)
    for (int k = 0; k < n; ++k) {
      const double s = (k + 0.5) / n;
      const auto N = splines(r, c, s).N;
      for (int i = 0; i < 3; ++i) {
        const int node =
            body.grid.node_map.at({r.first_node(c) + i, body.grid.axes[1].first_node(inlet.face)});
        flux -= N[static_cast<std::size_t>(i)] * body.v[node][1] *
                Axisymmetric::measure({(c + s) * r.h, 0.0}) * r.h / n;
      }
    }
  return flux;
}

// A pot filled from its middle for a minute: what is in it is what the pipe let in, with no more between its points than K
// takes, and no point is lost. The flux on the grid is the flow within its quadrature.
TEST(Inlet, FillsAPot) {
  omp_set_num_threads(1);
  constexpr double h = 0.03, R = 0.24, first = 0.18;
  ImplicitBody<Axisymmetric> body;
  body.mix = concrete(50.0, 20.0, 350e6);
  body.gravity[1] = -g;
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = 8};
  body.grid.axes[1] = {.h = h, .low = FaceKind::no_slip};
  Inlet inlet = make_inlet<Axisymmetric>(body.grid.axes, 2, 4, 6, h / 3);
  seed_box<Axisymmetric>(
      {0.0, 0.0}, {R, first}, {24, 18}, body.mix.density, body.mix.K,
      [&](const Vec<2>& x) { return x[0] > 2 * h || x[1] < 4 * h; },
      [&](const Vec<2>& x) { return body.mix.density * g * (first - x[1]); }, body.points);
  const double start = total_volume(body.points);
  inlet.flow = 3e-4;
  StepSettings settings;
  settings.moving_surface = settings.particle_shifting.on = true;
  double in = 0.0;
  while (body.time < 60.0) {
    place_pipe(inlet, body.grid);
    settings.time_left = std::min(60.0 - body.time, 0.6 * h / plug_speed(inlet));
    ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged) << body.time;
    EXPECT_NEAR(flux_of_grid(body, inlet), inlet.flow, 1e-4 * inlet.flow);
    let_in(inlet, body.grid.axes[1], body.dt, [&](const Vec<2>& x, double V, double speed) {
      add_point<2>(body.points, x, body.mix.density * V, V, 0.0);
      body.points.v.back()[1] = -speed;
    });
    in += inlet.flow * body.dt;
  }
  EXPECT_NEAR((total_volume(body.points) + volume_waiting(inlet)) / (start + in), 1.0, 1e-4);
  for (const Vec<2>& x : body.points.x) EXPECT_TRUE(x[0] > 2 * h || x[1] < 4 * h) << x.transpose();
}

/// Bingham concrete that sinks by the body force f [N/m^3] between an inner and an outer wall: its speed by radius. The shear
/// stress is (f/2)(r - r_1 r_2/r) with a plug from r_1 to r_2 = r_1 + 2 tau_0/f.
struct Annulus {
  double inner, outer, f, tau_0, mu;
  double r_1 = 0.0;

  double integral(double r, double sign) const {  // of (f/2 (r - r_1 r_2/r) + sign tau_0)/mu
    const double product = r_1 * (r_1 + 2.0 * tau_0 / f);
    return (0.25 * f * r * r - 0.5 * f * product * std::log(r) + sign * tau_0 * r) / mu;
  }
  double inner_speed(double r) const { return integral(inner, 1.0) - integral(r, 1.0); }
  double outer_speed(double r) const { return integral(outer, -1.0) - integral(r, -1.0); }
  void solve() {
    double low = inner, high = outer - 2.0 * tau_0 / f;
    for (int i = 0; i < 100; ++i) {
      r_1 = 0.5 * (low + high);
      (inner_speed(r_1) < outer_speed(r_1 + 2.0 * tau_0 / f) ? low : high) = r_1;
    }
  }
  double speed(double r) const {
    const double r_2 = r_1 + 2.0 * tau_0 / f;
    return r < r_1 ? inner_speed(r) : r > r_2 ? outer_speed(r) : inner_speed(r_1);
  }
};

/// Concrete that sinks beside a pipe, far from its mouth, on 16 cells from pipe to wall, a third of the gap a plug: within 2 % of
/// the largest speed everywhere, and of the flow. Exact: of the walls, the body force, tau_0 and mu.
template <class Geometry, class Exact>
void sinks_as(const char* name, Exact make_exact) {
  omp_set_num_threads(1);
  constexpr double h = 0.04, inner = 4 * h, outer = 20 * h;
  ImplicitBody<Geometry> body;
  body.mix = concrete(54.0, 35.8, 350e6);
  const double f = 2.0 * 54.0 / (0.3 * (outer - inner));
  body.gravity[1] = -f / body.mix.density;
  body.grid.axes[0] = {
      .h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = 20, .repeated_knots = {4}};
  body.grid.axes[1] = {.h = h, .periodic = true, .n_cells = 3};
  body.grid.blocks = {{{0, 0}, {4, 3}, [](const Vec<2>&) { return Vec<2>(0.0, 0.0); }}};
  fill_box<Geometry>(body, {inner, 0.0}, {outer, 3 * h}, 2);
  StepSettings settings;
  settings.fixed_dt = 1.0;
  settings.admm.tolerance = 1e-4;
  for (int i = 0; i < 60; ++i) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  const auto exact = make_exact(inner, outer, f, 54.0, 35.8);
  double most = 0.0, flow = 0.0, exact_flow = 0.0, worst = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p) {
    const double r = body.points.x[p][0], V = body.points.volume(p);
    most = std::max(most, exact.speed(r));
    worst = std::max(worst, std::abs(-body.points.v[p][1] - exact.speed(r)));
    flow -= V * body.points.v[p][1], exact_flow += V * exact.speed(r);
  }
  std::printf("%s: largest error %.2f %% of the plug's speed, flow %+.2f %%\n", name, 100.0 * worst / most,
              100.0 * (flow / exact_flow - 1.0));
  EXPECT_LE(worst, 0.02 * most);
  EXPECT_NEAR(flow / exact_flow, 1.0, 0.02);
}

// Beside the pipe of a pile concrete flows as between two cylinders.
TEST(Inlet, FlowBesideThePipeIsThatOfAnAnnulus) {
  sinks_as<Axisymmetric>("annulus", [](double inner, double outer, double f, double tau_0, double mu) {
    Annulus exact{inner, outer, f, tau_0, mu};
    exact.solve();
    return exact;
  });
}

/// The same between two plates (Poiseuille): the shear stress is f y from the middle of the slit.
struct Slit {
  double inner, outer, f, tau_0, mu;
  double speed(double x) const {
    const double a = 0.5 * (outer - inner), y = std::max(std::abs(x - inner - a), tau_0 / f);
    return (0.5 * f * (a * a - y * y) - tau_0 * (a - y)) / mu;
  }
};

// Beside the pipe of a panel, a slot across its width, it flows as between two plates.
TEST(Inlet, FlowBesideThePipeOfAPanelIsThatOfASlit) {
  sinks_as<PlaneStrain>("slit", [](double inner, double outer, double f, double tau_0, double mu) {
    return Slit{inner, outer, f, tau_0, mu};
  });
}

// 16 m of concrete of 350 MPa, seeded with the pressure of three quarters of its weight: in seconds the pressure on the base is
// that of the weight within 0.2 %. By ADMM alone: Newton's method, which stands in where ADMM does not converge, leaves it where
// it began.
TEST(Inlet, PressureUnderAPileIsHydrostatic) {
  omp_set_num_threads(1);
  constexpr double h = 0.1, depth = 16.0;
  ImplicitBody<Axisymmetric> body;
  body.mix = concrete(54.0, 35.8, 350e6);
  body.gravity[1] = -g;
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::free_slip, .n_cells = 4};
  body.grid.axes[1] = {.h = h, .low = FaceKind::free_slip};
  fill_box<Axisymmetric>(body, {0.0, 0.0}, {4 * h, depth}, 2,
                         [&](const Vec<2>& x) { return 0.75 * body.mix.density * g * (depth - x[1]); });
  StepSettings settings;
  settings.moving_surface = true;
  settings.method = YieldMethod::admm;
  while (body.time < 10.0) ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged);
  double sum = 0.0, weight = 0.0;
  for (std::size_t p = 0; p < body.points.size(); ++p)
    if (body.points.x[p][1] < h)
      sum += body.points.mass[p] * pressure(body.points.ln_J[p], body.mix.K) /
             (body.mix.density * g * (depth - body.points.x[p][1])),
          weight += body.points.mass[p];
  std::printf("pressure on the base %+.3f %% off\n", 100.0 * (sum / weight - 1.0));
  EXPECT_NEAR(sum / weight, 1.0, 2e-3);
}

// Buckingham and Reiner's closed form, from a plug that fills nearly the whole pipe to none.
TEST(PipeFlow, OfBinghamIsBuckinghamReiner) {
  constexpr double R = 0.125, mu = 35.8, tau_0 = 54.0;
  for (const double phi : {0.95, 0.5, 0.1, 0.001}) {
    const double G = 2.0 * tau_0 / (phi * R), Q = std::numbers::pi * std::pow(R, 4) * G / (8.0 * mu) *
                                                  (1.0 - 4.0 / 3.0 * phi + std::pow(phi, 4) / 3.0);
    EXPECT_NEAR(pipe_pressure_gradient(Q, R, ExactBingham{}, mu, tau_0) / G, 1.0, 1e-6) << phi;
  }
  EXPECT_DOUBLE_EQ(pipe_pressure_gradient(0.0, R, ExactBingham{}, mu, tau_0), 2.0 * tau_0 / R);
}

// A pipe fed at a rate: the pressure gradient, over radii of the pipe that see neither the plug at the inlet nor the open end, is
// Buckingham and Reiner's within 2 %. Volume in, out and waiting is that of the body within a thousandth.
TEST(Inlet, AFedPipeIsBuckinghamReiner) {
  omp_set_num_threads(1);
  constexpr int across = 8;
  constexpr double R = 0.1, h = R / across, length = 0.8, tau_0 = 50.0, mu = 20.0, flow = 3e-3;
  ImplicitBody<Axisymmetric> body;
  body.mix = concrete(tau_0, mu, 50e6);
  body.grid.axes[0] = {.h = h, .low = FaceKind::free_slip, .high = FaceKind::no_slip, .n_cells = across};
  body.grid.axes[1] = {.h = h};
  Inlet inlet = make_inlet<Axisymmetric>(body.grid.axes, across - 1, 64, 3 * across, h / 3);
  inlet.flow = flow;
  const double G = pipe_pressure_gradient(flow, R, ExactBingham{}, mu, tau_0);
  fill_box<Axisymmetric>(body, {0.0, 0.0}, {R, length}, 3, [&](const Vec<2>& x) { return G * x[1]; });
  const double start = total_volume(body.points);
  const Outlet<2> outlet{{0.0, -1.0}, 0.0};
  Outflow left;
  StepSettings settings;
  settings.particle_shifting.on = true;
  double in = 0.0;
  while (body.time < 8.0) {
    place_pipe(inlet, body.grid);
    settings.time_left = std::min(8.0 - body.time, 0.4 * h / plug_speed(inlet));
    ASSERT_TRUE(implicit_step(body, ExactBingham{}, settings).converged) << body.time;
    let_in(inlet, body.grid.axes[1], body.dt, [&](const Vec<2>& x, double V, double speed) {
      add_point<2>(body.points, x, body.mix.density * V, V, 0.0);
      body.points.v.back()[1] = -speed;
    });
    let_out(outlet, body.points, left);
    in += inlet.flow * body.dt;
  }
  EXPECT_NEAR((total_volume(body.points) + volume_waiting(inlet) + left.volume) / (start + in), 1.0, 1e-3);
  double V = 0.0, z = 0.0, p = 0.0, zz = 0.0, zp = 0.0;  // of a straight line by least squares
  for (std::size_t i = 0; i < body.points.size(); ++i) {
    const double at = body.points.x[i][1], v = body.points.volume(i);
    if (at < 2.0 * R || at > length - 2.5 * R) continue;
    const double of = pressure(body.points.ln_J[i], body.mix.K);
    V += v, z += v * at, p += v * of, zz += v * at * at, zp += v * at * of;
  }
  const double slope = (V * zp - z * p) / (V * zz - z * z);
  std::printf("pressure gradient %.0f Pa/m, closed form %.0f\n", slope, G);
  EXPECT_NEAR(slope / G, 1.0, 0.02);
}

// A power law without a yield stress: Q = pi R^3 n/(3n + 1) (G R/(2 k))^(1/n). The integral's rule is good to 1e-5 there.
TEST(PipeFlow, OfAPowerLaw) {
  constexpr double R = 0.1, k = 12.0, n = 0.6, G = 4000.0;
  HerschelBulkley law;
  law.k = k, law.n = n;
  const double Q = std::numbers::pi * R * R * R * n / (3.0 * n + 1.0) * std::pow(0.5 * G * R / k, 1.0 / n);
  EXPECT_NEAR(pipe_pressure_gradient(Q, R, law, 0.0, 0.0) / G, 1.0, 1e-5);
}

}  // namespace
}  // namespace tremie
