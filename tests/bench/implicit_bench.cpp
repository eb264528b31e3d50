// Nanoseconds a point of the implicit kernels, by space, with and without flocculation:
//   implicit_bench [--benchmark_filter=…]; the counter is "points/s", and "cells/s" for those that go by
//   cells.
//
// A block of concrete, 2 points a cell in each direction, that slumps under its own weight on a floor between
// planes of symmetry; the kernels are timed after its first two steps.

#include <benchmark/benchmark.h>
#include <omp.h>

#include <optional>

#include "apparatus/verification/references/bodies.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie {
namespace {

constexpr double dt = 0.02;

/// About 14,000 points.
template <class Geometry>
struct Set {
  static constexpr int D = Geometry::dim;
  ImplicitBody<Geometry> body;
  StepSettings settings;
  std::optional<YieldProblem<Geometry>> problem;
  std::vector<double> gamma_dot;  ///< of the cells

  explicit Set(bool thixotropic) {
    omp_set_num_threads(1);
    const double h = 0.015;
    const int cells = D == 3 ? 12 : 60;
    body.mix = test::concrete(54.0, 35.8, 1e6);
    body.gravity[Geometry::up] = -9.81;
    for (Axis& a : body.grid.axes) a = {.h = h, .low = FaceKind::free_slip};
    if (D == 3) body.grid.axes[0].low = body.grid.axes[1].low = FaceKind::symmetry;
    body.grid.axes[Geometry::up].low = FaceKind::no_slip;
    test::fill_box<Geometry>(body, Vec<D>::Zero(), Vec<D>::Constant(cells * h), 2,
                             [&](const auto& x) { return 2400.0 * 9.81 * (cells * h - x[Geometry::up]); });
    if (thixotropic) {
      body.mix.thixotropy = Thixotropy{1.3, 0.01};
      body.points.lambda.assign(body.points.size(), 1.0);
      body.points.gamma_dot.assign(body.points.size(), 0.0);
    }
    settings.fixed_dt = dt;
    settings.particle_shifting.on = true;
    for (int i = 0; i < 2; ++i) implicit_step(body, ExactBingham{}, settings);
    const auto old = body.grid.cell_map;
    const auto old_nodes = body.grid.node_map;
    activate(body.grid, body.points.x);
    point_to_grid(body.grid, body.points, body.nodes);
    detail::carry_over_admm_state(old, ExactBingham{}, settings, body);
    lay_out_quadrature<Geometry>(body.grid, body.points, body.mix.tau_0, body.mix.K, body.quadrature);
    const auto v = body.nodes.v;
    detail::pose(body, ExactBingham{}, settings, {}, v, old_nodes, dt, problem);
    if constexpr (D == 3) {
      body.matrix_free.set_up(*problem, settings.admm.most_band_operations);
      body.matrix_free.prepare(*problem, 2.5 * body.mix.mu);
    } else {
      body.system.set_pattern(body.grid);
    }
    detail::shear_rates(*problem, settings, body, gamma_dot);
  }
  void count(benchmark::State& run) const {
    const auto rate = benchmark::Counter::kIsIterationInvariantRate;
    run.counters["points/s"] = benchmark::Counter(static_cast<double>(body.points.size()), rate);
    run.counters["cells/s"] = benchmark::Counter(static_cast<double>(body.grid.n_cells()), rate);
  }
};

template <class Geometry>
void sort_points(benchmark::State& run) {
  Set<Geometry> set(false);
  for (auto _ : run) activate(set.body.grid, set.body.points.x);
  set.count(run);
}

template <class Geometry>
void to_grid(benchmark::State& run) {
  Set<Geometry> set(false);
  for (auto _ : run) point_to_grid(set.body.grid, set.body.points, set.body.nodes);
  set.count(run);
}

/// Over no time, so that the points stay where they are.
template <class Geometry>
void to_points(benchmark::State& run) {
  Set<Geometry> set(false);
  auto& b = set.body;
  for (auto _ : run) grid_to_point(b.grid, b.v, b.v, set.settings.transfer, 0.0, b.points, b.motion);
  set.count(run);
}

template <class Geometry>
void rates_at_points(benchmark::State& run) {
  Set<Geometry> set(false);
  std::vector<double> rate;
  for (auto _ : run) shear_rate_at_points<Geometry>(set.body.grid, set.body.v, set.body.points, rate);
  set.count(run);
}

/// Shear rates at the points and the flocculation state.
template <class Geometry>
void flocculation(benchmark::State& run) {
  Set<Geometry> set(true);
  for (auto _ : run) detail::update_flocculation(set.body, 1e-9, set.body.points);
  set.count(run);
}

template <class Geometry, bool thixotropic>
void quadrature(benchmark::State& run) {
  Set<Geometry> set(thixotropic);
  auto& b = set.body;
  for (auto _ : run) lay_out_quadrature<Geometry>(b.grid, b.points, b.mix.tau_0, b.mix.K, b.quadrature);
  set.count(run);
}

/// Strain rates and the law at the Gauss places: one pass of ADMM, with the forces that it gives.
template <class Geometry>
void law(benchmark::State& run) {
  Set<Geometry> set(false);
  auto& b = set.body;
  const double r = 1.5 * b.mix.mu;
  if constexpr (Geometry::dim == 3) {
    Eigen::VectorXd R;
    for (auto _ : run)
      detail::pass_over_cells(*set.problem, ExactBingham{}, set.settings.admm, {r, b.mix.mu}, b.v, true,
                              b.matrix_free, b.admm_state.packed, R);
  } else {
    const auto stress = [&](int c, int k, const Vec<Geometry::n_strain>& q) -> Vec<Geometry::n_strain> {
      return b.mix.mu * q + b.admm_state.stress[c][k] + r * (q - b.admm_state.rate[c][k]);
    };
    for (auto _ : run) {
      detail::update_stress_and_rate(*set.problem, ExactBingham{}, set.settings.admm, r, b.v, b.admm_state);
      benchmark::DoNotOptimize(residual(*set.problem, b.v, stress));
    }
  }
  set.count(run);
}

/// Nodal vectors for the solver in space: free components alone.
Eigen::VectorXf some_field(const Set<ThreeD>& set) {
  Eigen::VectorXf x = Eigen::VectorXf::Zero(4 * set.body.grid.n_nodes());
  for (int i = 0; i < set.body.grid.n_nodes(); ++i)
    for (int d = 0; d < 3; ++d)
      if (!set.problem->fixed[static_cast<std::size_t>(3 * i + d)])
        x[4 * i + d] = std::sin(1.7f * static_cast<float>(3 * i + d));
  return x;
}

void product(benchmark::State& run) {
  Set<ThreeD> set(false);
  const Eigen::VectorXf x = some_field(set);
  Eigen::VectorXf out;
  for (auto _ : run) set.body.matrix_free.multiply(*set.problem, x, out);
  set.count(run);
}

/// range(0): whether the pressures' matrix has a factor.
void precondition(benchmark::State& run) {
  Set<ThreeD> set(false);
  auto& system = set.body.matrix_free;
  system.set_up(*set.problem, run.range(0) ? 1e12 : 0.0);
  system.prepare(*set.problem, 2.5 * set.body.mix.mu);
  const Eigen::VectorXf x = some_field(set);
  Eigen::VectorXf out;
  for (auto _ : run) system.preconditioner.apply(system.batches, set.body.grid, x, system.forces, out);
  set.count(run);
}

void prepare(benchmark::State& run) {
  Set<ThreeD> set(false);
  auto& system = set.body.matrix_free;
  system.set_up(*set.problem, run.range(0) ? 1e12 : 0.0);
  for (auto _ : run) system.prepare(*set.problem, 2.5 * set.body.mix.mu);
  set.count(run);
}

/// In a section: assembling and factorising the matrix, or one solve with the factor.
template <class Geometry, bool factorise>
void direct(benchmark::State& run) {
  Set<Geometry> set(false);
  auto& b = set.body;
  const auto stiffness = [&](int, int) { return 4.0 * b.mix.mu; };
  const auto set_up = [&] {
    assemble(*set.problem, stiffness, b.system);
    b.system.fix(set.problem->fixed);
    b.system.factorise();
  };
  set_up();
  const Eigen::VectorXd R = Eigen::VectorXd::Ones(b.grid.n_nodes() * 2);
  for (auto _ : run)
    if constexpr (factorise)
      set_up();
    else
      benchmark::DoNotOptimize(b.system.solve(R));
  set.count(run);
}

template <class Geometry>
void particle_shifting_cells(benchmark::State& run) {
  Set<Geometry> set(false);
  for (auto _ : run)
    benchmark::DoNotOptimize(detail::particle_shift(*set.problem, set.settings, set.gamma_dot, set.body));
  set.count(run);
}

template <class Geometry, bool thixotropic>
void whole_step(benchmark::State& run) {
  Set<Geometry> set(thixotropic);
  const Points<Geometry::dim> start = set.body.points;
  for (auto _ : run) {
    run.PauseTiming();
    set.body.points = start;
    run.ResumeTiming();
    implicit_step(set.body, ExactBingham{}, set.settings);
  }
  set.count(run);
}

#define IN_EVERY_SPACE(kernel, name)                   \
  BENCHMARK(kernel<ThreeD>)->Name("3D/" name);         \
  BENCHMARK(kernel<PlaneStrain>)->Name("plane/" name); \
  BENCHMARK(kernel<Axisymmetric>)->Name("axisymmetric/" name)
#define WITH_AND_WITHOUT(kernel, name)                                       \
  BENCHMARK(kernel<ThreeD, false>)->Name("3D/" name);                        \
  BENCHMARK(kernel<ThreeD, true>)->Name("3D/" name ", thixotropic");         \
  BENCHMARK(kernel<PlaneStrain, false>)->Name("plane/" name);                \
  BENCHMARK(kernel<PlaneStrain, true>)->Name("plane/" name ", thixotropic"); \
  BENCHMARK(kernel<Axisymmetric, false>)->Name("axisymmetric/" name);        \
  BENCHMARK(kernel<Axisymmetric, true>)->Name("axisymmetric/" name ", thixotropic")

IN_EVERY_SPACE(sort_points, "sort");
IN_EVERY_SPACE(to_grid, "points to grid");
IN_EVERY_SPACE(to_points, "grid to points");
IN_EVERY_SPACE(rates_at_points, "shear rates at points");
IN_EVERY_SPACE(flocculation, "shear rates at points and lambda");
WITH_AND_WITHOUT(quadrature, "quadrature");
IN_EVERY_SPACE(law, "strain rates and law");
IN_EVERY_SPACE(particle_shifting_cells, "evening out");
WITH_AND_WITHOUT(whole_step, "whole step");
BENCHMARK(product)->Name("3D/product with A");
BENCHMARK(precondition)->Name("3D/preconditioner, factor")->Arg(1)->Arg(0);
BENCHMARK(prepare)->Name("3D/prepare, factor")->Arg(1)->Arg(0);
BENCHMARK(direct<PlaneStrain, true>)->Name("plane/assemble and factorise");
BENCHMARK(direct<PlaneStrain, false>)->Name("plane/solve");
BENCHMARK(direct<Axisymmetric, true>)->Name("axisymmetric/assemble and factorise");
BENCHMARK(direct<Axisymmetric, false>)->Name("axisymmetric/solve");

}  // namespace
}  // namespace tremie

BENCHMARK_MAIN();
