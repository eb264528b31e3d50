// A rested paste sheared slowly: where breakdown hardly depends on the rate, shear localises at the vane, and the fall of
// the torque hangs on the intervals. With a length of the material (Thixotropy::layer) it converges.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "rheometer/reference/couette_layer.hpp"
#include "rheometer/reference/flocculation_ode.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie {
namespace {

// The paste's vane and speed (reference_data/rheocem), a paste of its order: 820 Pa at rest, 1 Pa s.
const Instrument vane{0.020, 0.060, 0.050};
const double slow = 0.115 / 60.0 * 2.0 * std::numbers::pi;

CouetteFlow paste(double layer, double mu = 1.0, RatePowerKinetics kinetics = {0.5, 0.1}) {
  CouetteFlow flow{{100.0, mu}, {3.0, std::move(kinetics), 7.2}, slow, {}};
  flow.thixotropy.layer = layer;
  return flow;
}

std::vector<double> even_times(double end, int n) {
  std::vector<double> times;
  for (int i = 0; i <= n; ++i) times.push_back(end * i / n);
  return times;
}

CouetteDecay on(int intervals, const CouetteFlow& flow) {
  CouetteOptions o;
  o.intervals = intervals;
  return thixotropic_couette(flow, even_times(10.0, 400), vane, o);
}

/// Time until half of the excess over the dynamic yield stress is lost [s].
double half_time(const CouetteDecay& d) {
  const double end = 100.0 * 2.0 * std::numbers::pi * std::pow(vane.vane_radius, 2) * vane.vane_height;
  const double half = 0.5 * (d.torque[0] + end);
  for (std::size_t i = 1; i < d.time.size(); ++i)
    if (d.torque[i] <= half)
      return d.time[i] - (half - d.torque[i]) / (d.torque[i - 1] - d.torque[i]) * (d.time[i] - d.time[i - 1]);
  return NAN;
}

// The mean of the radius itself. Around r it is r + l^2/6r; at the wall r = 1, int K r^2 dr = l (1/2 + l/3 + l^2/12) over int
// K r dr = l (1/2 + l/6); to second order of the intervals.
TEST(CouetteLayer, MeansOfALinearRate) {
  std::vector<double> x;
  for (int i = 0; i <= 400; ++i) x.push_back(0.25 * i / 400.0);
  const double layer = 0.05;
  const auto means = layer_means(x, layer);
  const auto mean = [&](std::size_t i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < means[i].weight.size(); ++k) {
      const std::size_t j = means[i].first + k;
      sum += means[i].weight[k] * (x[j + 1] - x[j]) * 0.5 * (std::exp(x[j]) + std::exp(x[j + 1]));
    }
    return sum;
  };
  const auto weighted = [&](double r) {  // int K r^2 dr / int K r dr around r, whole kernel
    return r + layer * layer / (6.0 * r);
  };
  EXPECT_NEAR(mean(200), weighted(std::exp(x[200])), 3e-6);
  EXPECT_NEAR(mean(0), (0.5 + layer / 3.0 + layer * layer / 12.0) / (0.5 + layer / 6.0), 3e-6);
}

// Shear that is thin beside the layer turns the vane at Omega whatever its thickness, so lambda at the vane follows CVODE at
// the constant rate Omega R / (layer (1/2 + layer/6R)). The layer is 3 mm, the shear some 0.1 mm thick: 1 % of the torque.
TEST(CouetteLayer, TheVanesTorqueFollowsCvodeAtTheMeanRate) {
  const double layer = 0.003, R = vane.vane_radius;
  const CouetteFlow flow = paste(layer, 0.1);
  const double rate = slow * R / (layer * (0.5 + layer / (6.0 * R)));
  const std::vector<double> times{0.5, 1.0, 2.0, 4.0};
  const ShearPiece piece{4.0, [rate](double) { return rate; }};
  const auto exact = flocculation_ode(std::vector{piece}, flow.thixotropy, 100.0, 7.2, times);
  CouetteOptions o;
  o.intervals = 800;
  const CouetteDecay d = thixotropic_couette(flow, times, vane, o);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double stress = shear_stress_at(R, d.torque[i], vane);
    EXPECT_NEAR(stress / ((1.0 + exact.lambda[i]) * 100.0), 1.0, 0.01) << times[i] << " s";
  }
}

// Three grids: the peak agrees within 1 %, and with the layer the half time within 2 and 1 %, at half of the intervals with
// less than half of the difference. Without it the half time
// moves as the rate in the first interval does: structure that is gone at the vane and whole one interval of h behind it
// makes the stress fall as 1/h there, so that the rate grows as h^-1/2 and its power as h^(-a/2), 19 % at half of h and a =
// 0.5, 3.5 % at a = 0.1.
TEST(CouetteLayer, AStartUpConvergesWithIt) {
  std::vector<double> peak, with, without;
  for (const int n : {50, 100, 200}) {
    const CouetteDecay d = on(n, paste(0.003, 1.0, {1.0, 0.5}));
    peak.push_back(d.torque[0]);
    with.push_back(half_time(d));
    without.push_back(half_time(on(n, paste(0.0, 1.0, {1.0, 0.5}))));
    std::printf("%d intervals: peak %.5f N m, half time %.4f s with a layer of 3 mm, %.4f s without\n", n,
                peak.back(), with.back(), without.back());
  }
  EXPECT_NEAR(peak[0] / peak[2], 1.0, 0.01);
  EXPECT_NEAR(peak[1] / peak[2], 1.0, 0.01);
  EXPECT_NEAR(with[0] / with[2], 1.0, 0.02);
  EXPECT_NEAR(with[1] / with[2], 1.0, 0.01);
  EXPECT_LT(std::abs(with[1] - with[2]), 0.5 * std::abs(with[0] - with[2]));
  EXPECT_GT(without[0] / without[1], 1.05);
  EXPECT_GT(without[1] / without[2], 1.05);
}

// In a gap of 1e-5 of its radius the shear is even: a layer ten times as wide changes nothing but rounding and IDA's
// tolerance.
TEST(CouetteLayer, EvenShearIsItsOwnMean) {
  CouetteFlow flow{{54.0, 35.8}, {1.3, RatePowerKinetics{0.3, 0.4}, 5.8}, 3.0 * evenly_sheared_speed, {}};
  CouetteOptions o;
  o.intervals = 20;
  const std::vector<double> times{0.0, 1.0, 10.0};
  const CouetteDecay point = thixotropic_couette(flow, times, evenly_sheared(), o);
  flow.thixotropy.layer = 10.0 * evenly_sheared_gap;
  const CouetteDecay mean = thixotropic_couette(flow, times, evenly_sheared(), o);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(mean.torque[i] / point.torque[i], 1.0, 1e-5);
}

// Two modes with one factor are one mode: the elimination of the parts, to the integrator's tolerance.
TEST(CouetteLayer, EqualModesAreOne) {
  CouetteFlow one = paste(0.003), two = one;
  std::get<RatePowerKinetics>(two.thixotropy.kinetics).modes = {{0.3, 1.0}, {0.7, 1.0}};
  const CouetteDecay a = on(50, one), b = on(50, two);
  for (const std::size_t i : {40u, 100u, 400u}) EXPECT_NEAR(b.torque[i] / a.torque[i], 1.0, 1e-5);
}

// A gate on the mean rate, which shear of 2 mm beside the vane passes within a layer of 5 mm: each node breaks down where
// the mean is above the gate, so that the torque lies between those without a gate and with none broken down.
TEST(CouetteLayer, TheGateIsOnTheMeanRate) {
  CouetteFlow flow{{54.0, 35.8}, {1.3, GatedKinetics{0.0358}, 5.78}, angular_speed(0.25), {}};
  flow.thixotropy.layer = 0.005;
  const std::vector<double> times{0.0, 5.0};
  const CouetteDecay mean = thixotropic_couette(flow, times);
  flow.thixotropy.layer = 0.0;
  const CouetteDecay point = thixotropic_couette(flow, times);
  EXPECT_GT(mean.gate_crossings, 0);
  EXPECT_NEAR(mean.torque[0] / point.torque[0], 1.0, 1e-9);
  EXPECT_NEAR(mean.torque[1] / point.torque[1], 1.0, 0.03);  // a layer of a third of the sheared width
  EXPECT_NE(mean.torque[1], point.torque[1]);
}

TEST(CouetteLayer, RefusesALengthThatIsNone) {
  EXPECT_THROW(on(10, paste(-1.0)), std::invalid_argument);
  EXPECT_THROW(on(10, paste(INFINITY)), std::invalid_argument);
}

}  // namespace
}  // namespace tremie
