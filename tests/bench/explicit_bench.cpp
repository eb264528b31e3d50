// Nanoseconds a point of the explicit kernels, by space, with and without flocculation:
//   explicit_bench [--benchmark_filter=…]; the counter is "points/s".

#include <benchmark/benchmark.h>
#include <omp.h>

#include "libmpm/explicit/pass.hpp"
#include "tests/bench/explicit_set.hpp"

namespace tremie {
namespace {

using bench::law;

/// With the counter "points/s".
template <class Geometry>
struct Set : bench::Set<Geometry> {
  using bench::Set<Geometry>::Set;
  void count(benchmark::State& run) const {
    run.counters["points/s"] = benchmark::Counter(static_cast<double>(this->state.points.n),
                                                  benchmark::Counter::kIsIterationInvariantRate);
  }
};

/// One pass over the points, without the grid: what pass names.
template <class Geometry, detail::Pass pass, bool thixotropic>
void pass_of(benchmark::State& run) {
  omp_set_num_threads(1);
  Set<Geometry> set(thixotropic, false, StressUpdate::last, false);
  const detail::PassInput input{1e-9, 1e-9};
  for (auto _ : run)
    detail::pass_over_points<pass, double>(set.body.mix, law, set.settings, input, set.state);
  set.count(run);
}

template <class Geometry>
void sort_alone(benchmark::State& run) {
  Set<Geometry> set(true, false, StressUpdate::last, false);
  constexpr int D = Geometry::dim;
  auto& grid = set.state.grid;
  for (auto _ : run)
    lay_tiles<double, D>(
        grid, sort_into_tiles<D>(grid.axes, set.state.shape.stencil_shift(), set.state.points), false);
  set.count(run);
}

/// range(0): threads.
template <class Geometry, bool thixotropic, bool gimp, StressUpdate stress, bool cell_pressure,
          bool single = false>
void whole_step(benchmark::State& run) {
  omp_set_num_threads(static_cast<int>(run.range(0)));
  Set<Geometry> set(thixotropic, gimp, stress, cell_pressure, single);
  for (auto _ : run) explicit_step(set.body, law, set.settings, set.state);
  set.count(run);
}

/// range(0): cells a direction. A run of one size alone tells by its peak memory what a point needs.
template <bool gimp, StressUpdate stress, bool single = false>
void step_by_size(benchmark::State& run) {
  omp_set_num_threads(1);
  Set<ThreeD> set(bench::block<ThreeD>(true, static_cast<int>(run.range(0))), gimp, stress, true, single);
  for (auto _ : run) explicit_step(set.body, law, set.settings, set.state);
  set.count(run);
}

constexpr auto last = StressUpdate::last, first = StressUpdate::first;
constexpr detail::Pass points_to_grid = detail::first_momenta;

BENCHMARK(pass_of<ThreeD, points_to_grid, false>)->Name("3D/points to grid");
BENCHMARK(pass_of<ThreeD, detail::motion_pass, false>)->Name("3D/grid to points and back");
BENCHMARK(pass_of<ThreeD, detail::stress_pass, false>)->Name("3D/stress pass");
BENCHMARK(pass_of<ThreeD, detail::whole_pass, false>)->Name("3D/whole pass");
BENCHMARK(sort_alone<ThreeD>)->Name("3D/sort");
BENCHMARK(whole_step<ThreeD, false, false, last, false>)
    ->Name("3D/USL, splines, pressure by the point")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK(whole_step<ThreeD, false, false, last, false, true>)
    ->Name("3D/USL, splines, pressure by the point, single")
    ->Arg(1);
BENCHMARK(whole_step<ThreeD, false, false, last, true>)->Name("3D/USL, splines")->Arg(1);
BENCHMARK(whole_step<ThreeD, false, false, last, true, true>)->Name("3D/USL, splines, single")->Arg(1);
BENCHMARK(whole_step<ThreeD, true, false, last, true>)->Name("3D/USL, splines, thixotropic")->Arg(1);
BENCHMARK(whole_step<ThreeD, false, true, first, true>)->Name("3D/USF, GIMP")->Arg(1)->Arg(2)->UseRealTime();
BENCHMARK(whole_step<ThreeD, true, true, first, true>)->Name("3D/USF, GIMP, thixotropic")->Arg(1);
BENCHMARK(whole_step<ThreeD, false, true, first, true, true>)
    ->Name("3D/USF, GIMP, single")
    ->Arg(1)
    ->Arg(2)
    ->UseRealTime();
BENCHMARK(whole_step<ThreeD, true, true, first, true, true>)
    ->Name("3D/USF, GIMP, thixotropic, single")
    ->Arg(1);
BENCHMARK(whole_step<PlaneStrain, false, false, last, false>)
    ->Name("plane/USL, splines, pressure by the point")
    ->Arg(1);
BENCHMARK(whole_step<PlaneStrain, true, false, last, true>)->Name("plane/USL, splines, thixotropic")->Arg(1);
BENCHMARK(whole_step<Axisymmetric, false, false, last, false>)
    ->Name("axisymmetric/USL, splines, pressure by the point")
    ->Arg(1);
BENCHMARK(whole_step<Axisymmetric, true, false, last, true>)
    ->Name("axisymmetric/USL, splines, thixotropic")
    ->Arg(1);
BENCHMARK(step_by_size<false, last>)->Name("3D/size, USL, splines, thixotropic")->Arg(12)->Arg(24)->Arg(48);
BENCHMARK(step_by_size<true, first, true>)
    ->Name("3D/size, USF, GIMP, thixotropic, single")
    ->Arg(12)
    ->Arg(24)
    ->Arg(48);
BENCHMARK(step_by_size<true, first>)->Name("3D/size, USF, GIMP, thixotropic")->Arg(12)->Arg(24)->Arg(48);

}  // namespace
}  // namespace tremie

BENCHMARK_MAIN();
