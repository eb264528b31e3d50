// Points a second and core of explicit steps, beside what the arithmetic on rows of nodes alone would allow, a line each:
//   points_per_second   space and scheme TAB points/s TAB bound
//
// The bound counts operations on rows of four nodes (16 numbers) of gather_rows() and scatter() in transfer/tile_sums.hpp,
// a multiplication with its addition as one, at the rate at which this processor does such operations from registers. Weights,
// places, stresses, transposes and the grid come on top.

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "tests/bench/explicit_set.hpp"

namespace tremie {
namespace {

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Least seconds of a call, over a third of a second or so.
template <class Call>
double least_seconds(Call call) {
  double least = 1e300;
  for (const double end = now() + 0.35; now() < end;) {
    const double start = now();
    call();
    least = std::min(least, now() - start);
  }
  return least;
}

/// Operations on rows a second: ten sums that do not wait for each other.
template <class Real>
double row_operations() {
  using Row = Simd<Real, 16>;
  constexpr int sums = sizeof(Row) / simd_bytes > 2 ? 3 : 5, rounds = 20000;
  volatile Real factor = static_cast<Real>(0.999);
  Row sum[sums];
  for (int k = 0; k < sums; ++k) sum[k] = static_cast<Real>(k + 1) - Row{};
  const Row w = factor - Row{};
  const double seconds = least_seconds([&] {
    for (int i = 0; i < rounds; ++i) {
#pragma GCC unroll 5
      for (int k = 0; k < sums; ++k) sum[k] = sum[k] * w + w;
    }
  });
  for (int k = 1; k < sums; ++k) sum[0] = sum[0] + sum[k];
  factor = sum[0][0];
  return rounds * sums / seconds;
}

/// `operations`: on rows, a point and step.
template <class Real, class Geometry>
void time_steps(const char* name, bool gimp, StressUpdate stress, bool cell_pressure, int operations) {
  bench::Set<Geometry> set(false, gimp, stress, cell_pressure, std::is_same_v<Real, float>);
  const double seconds =
      least_seconds([&] { explicit_step(set.body, YieldLaw(bench::law), set.settings, set.state); });
  std::printf("%s\t%.3g\t%.3g\n", name, static_cast<double>(set.state.points.n) / seconds,
              row_operations<Real>() / operations);
}

}  // namespace
}  // namespace tremie

int main() {
  using namespace tremie;
  omp_set_num_threads(1);
  time_steps<float, ThreeD>("3D, USF, GIMP, single precision", true, StressUpdate::first, true,
                            2 * (22 + 25));
  time_steps<double, ThreeD>("3D, USL, splines, double", false, StressUpdate::last, false, 34 + 32);
  time_steps<double, PlaneStrain>("plane, USL, splines", false, StressUpdate::last, false, 8 + 14);
  time_steps<double, Axisymmetric>("axisymmetric, USL, splines", false, StressUpdate::last, false, 8 + 14);
}
