// Rested concrete in a slow vane (Couette and plane sections): with mix.thixotropy.layer the start-up converges with the
// cells, and the section is the radial equations integrated by IDA.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie::icar_vane {
namespace {

constexpr double tau_0 = 54.0, lambda_0 = 1.3 * 240.0 / tau_0;

/// Mix A after 240 s in the ICAR at 0.115 rpm, half-way between breakdown by time and by strain: 366 Pa, sheared 2.2 mm wide.
Scene slow(double cell, double layer) {
  Scene scene;
  scene.model.space = SpaceKind::couette;
  scene.model.cell = {cell, cell};
  scene.model.points_per_cell = {3, 3};
  scene.mix.tau_0 = tau_0, scene.mix.mu = 35.8;
  scene.mix.thixotropy = Thixotropy{1.3, RatePowerKinetics{1.0, 0.5}, 0.0, layer};
  scene.rest = 240.0;
  scene.speed = 0.115 / 60.0;
  scene.duration = 3.0;
  return scene;
}

struct StartUp {
  double peak = 0.0, half_time = 0.0;  ///< [N m]; until half of the excess over tau_0 is lost [s]
};

StartUp start_up_of(const Scene& scene) {
  const Outcome o = run(scene);
  const double end = tau_0 * 2.0 * std::numbers::pi * std::pow(scene.vane.radius, 2) * scene.vane.height;
  StartUp s{o.results.torque_peak, NAN};
  const double half = 0.5 * (s.peak + end);
  for (std::size_t i = 1; i < o.series.size(); ++i) {
    const Sample &a = o.series[i - 1], &b = o.series[i];
    if (!(a.torque > half && b.torque <= half)) continue;
    s.half_time = a.time + (a.torque - half) / (a.torque - b.torque) * (b.time - a.time);
    break;
  }
  return s;
}

// Cells of 4, 2 and 1 mm, a layer of 10 mm: on 2 mm peak and half time are within 1 % of the finest, on 4 mm, two and a half
// to the layer, within 4 %. Without it half of the torque's excess is lost a quarter earlier on 2 mm than on 4 mm, and earlier
// again on 1 mm, although the concrete is sheared 2.2 mm wide at the start.
TEST(VaneLayer, AStartUpConvergesInTheCells) {
  std::vector<StartUp> with, without;
  for (const double cell : {0.004, 0.002, 0.001}) {
    with.push_back(start_up_of(slow(cell, 0.010)));
    without.push_back(start_up_of(slow(cell, 0.0)));
    std::printf("cells of %g mm: peak %.4f N m, half time %.3f s with the layer; %.4f N m, %.3f s without\n",
                1e3 * cell, with.back().peak, with.back().half_time, without.back().peak,
                without.back().half_time);
  }
  for (const int i : {0, 1}) {
    EXPECT_NEAR(with[i].peak / with[2].peak, 1.0, i == 0 ? 0.04 : 0.01);
    EXPECT_NEAR(with[i].half_time / with[2].half_time, 1.0, i == 0 ? 0.04 : 0.01);
  }
  EXPECT_GT(without[0].half_time / without[1].half_time, 1.15);
  EXPECT_GT(without[1].half_time / without[2].half_time, 1.05);
}

// The torque over time of the radial equations with the same mean (IDA), within 2 % of the peak from 0.2 s on.
TEST(VaneLayer, TheSectionFollowsTheRadialEquations) {
  const Scene scene = slow(0.001, 0.010);
  const Outcome o = run(scene);
  std::vector<double> times;
  for (const Sample& s : o.series)
    if (s.time > 0.2) times.push_back(s.time);
  CouetteFlow flow{{tau_0, 35.8}, *scene.mix.thixotropy, 0.0, {}};
  flow.thixotropy.initial_flocculation = lambda_0;
  const double omega = angular_speed(scene.speed);
  flow.omega_of_time = [omega](double t) { return omega * start_up(t); };
  const CouetteDecay d = thixotropic_couette(flow, times);
  double worst = 0.0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    const Sample& s = o.series[o.series.size() - times.size() + i];
    worst = std::max(worst, std::abs(s.torque - d.torque[i]) / d.torque[0]);
  }
  std::printf("largest difference from IDA: %.4f of the peak\n", worst);
  EXPECT_LT(worst, 0.02);
  EXPECT_TRUE(o.checks.reasons.empty()) << o.checks.reasons.front();
}

// Blades: the share of its peak that the torque of a plane section has after 1.5 s, on cells of 5 and 3.5 mm, agrees within
// 0.5 % with a layer of 15 mm (0.2 % measured), and without it not within 0.8 % (1.1 %). The peaks differ by 1.3 %, the
// blades' error of first order.
TEST(VaneLayer, BladesConvergeAsWell) {
  const auto share = [](double cell, double layer) {
    Scene scene = slow(cell, layer);
    scene.model.space = SpaceKind::plane;
    scene.model.points_per_cell = {2, 2};
    scene.duration = 1.5;
    const Outcome o = run(scene);
    return o.series.back().torque / o.results.torque_peak;
  };
  const double with = share(0.005, 0.015) / share(0.0035, 0.015) - 1.0;
  const double without = share(0.005, 0.0) / share(0.0035, 0.0) - 1.0;
  std::printf("blades, share of the peak: %+.4f from 3.5 to 5 mm with the layer, %+.4f without\n", with,
              without);
  EXPECT_LT(std::abs(with), 0.005);
  EXPECT_GT(std::abs(without), 0.008);
}

}  // namespace
}  // namespace tremie::icar_vane
