// Material that is elastic below its yield stress: closed forms, the return map of the cell against CVODE, and IDA's Couette
// flow against both.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "rheometer/cell/elastic_ode.hpp"
#include "rheometer/cell/material_cell.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie {
namespace {

constexpr double G = 20e3, tau_0 = 100.0, mu = 5.0, A_thix = 3.0;

Mix paste(const Kinetics& kinetics = RatePowerKinetics{0.5, 0.1}) {
  Mix mix;
  mix.tau_0 = tau_0, mix.mu = mu, mix.G = G;
  mix.thixotropy = Thixotropy{A_thix, kinetics};
  return mix;
}

// 240 s of rest: 820 Pa. Until that stress tau = G gamma to rounding; the structure builds up meanwhile.
TEST(ElasticCell, RisesAlongItsModulusUntilItYields) {
  const double rate = 0.03, yields_at = (tau_0 + 240.0 * A_thix) / (G * rate);
  const CellResult r = run_cell({paste(), 240.0, {{yields_at, rate, rate}}, {}}, ExactBingham{});
  for (const CellSample& s : r.samples) EXPECT_NEAR(*s.shear_stress, G * rate * s.time, 1e-9 * G);
  EXPECT_NEAR(*r.samples.back().strain, 0.041, 1e-12);
  EXPECT_NEAR(*r.samples.back().flocculation, (240.0 + yields_at) * A_thix / tau_0, 1e-12);
}

// The stress turns where G gamma meets the static yield stress, later by the strain that flows while the plastic rate
// grows to the shear rate: tau_y/G <= gamma_peak <= tau_y/G + (mu gamma_dot/G) ln(1000), as the excess relaxes on mu/G; 0.3
// % more for what builds up meanwhile.
TEST(ElasticCell, OvershootsAtTheStaticYieldStressOverG) {
  for (const double rate : {0.003, 0.03, 0.3}) {
    const CellResult r = run_cell({paste(), 240.0, {{0.2 / rate, rate, rate}}, {}}, ExactBingham{});
    const double tau_y = tau_0 + 240.0 * A_thix + A_thix * 0.041 / rate;
    EXPECT_GT(r.peak->strain, (tau_0 + 240.0 * A_thix) / G);
    EXPECT_LT(r.peak->strain, tau_y / G + mu * rate / G * std::log(1000.0) + 3e-3 * tau_y / G);
    EXPECT_NEAR(r.peak->stress / (tau_y + mu * rate), 1.0, 0.01);
    EXPECT_LT(*r.samples.back().shear_stress, 0.95 * r.peak->stress);
  }
}

// Without thixotropy a stopped cell relaxes in closed form: tau - tau_0 falls on mu/G.
TEST(ElasticCell, RelaxesExponentiallyToItsYieldStress) {
  Mix mix = paste();
  mix.thixotropy.reset();
  const double rate = 100.0, t_0 = mu / G;
  const CellResult r =
      run_cell({mix, 0.0, {{0.01, rate, rate}, {5.0 * t_0, 0.0, 0.0}}, t_0 / 200.0}, ExactBingham{});
  double start = 0.0;
  for (const CellSample& s : r.samples) {
    if (s.time < 0.01) continue;
    if (start == 0.0) start = *s.shear_stress - tau_0;
    EXPECT_NEAR((*s.shear_stress - tau_0) / start, std::exp(-(s.time - 0.01) / t_0), 2e-4);
  }
  EXPECT_NEAR(start, mu * rate, 1e-3 * mu * rate);
}

// Start-up, ramp, stop with relaxation, and a start anew, against CVODE: within 1e-4 of the largest stress. A substep is
// held to 1e-6.
TEST(ElasticCell, FollowsCvodeThroughStartStopAndStart) {
  const std::vector<ShearSegment> history{
      {10.0, 0.03, 0.03}, {5.0, 0.03, 10.0}, {30.0, 0.0, 0.0}, {10.0, 0.01, 0.01}};
  RatePowerKinetics modes{0.5, 0.3, 0.0, 1.0, 20.0};
  modes.modes = {{0.7, 1.0}, {0.3, 0.1}};
  for (const Kinetics& kinetics : {Kinetics(RatePowerKinetics{0.5, 0.1}), Kinetics(RousselKinetics{0.03}),
                                   Kinetics(GatedKinetics{0.03, 0.02}), Kinetics(modes)}) {
    const CellResult r = run_cell({paste(kinetics), 240.0, history, {}}, ExactBingham{});
    ASSERT_TRUE(r.stress_error_max && r.flocculation_error_max);
    std::printf("%s: stress within %.2e Pa of CVODE, lambda within %.2e\n",
                std::string(word(kinetics)).c_str(), *r.stress_error_max, *r.flocculation_error_max);
    EXPECT_LT(*r.stress_error_max, 1e-4 * r.peak->stress);
    EXPECT_LT(*r.flocculation_error_max, 1e-3);
  }
}

TEST(ElasticCell, HerschelBulkleyFollowsCvode) {
  for (const double n : {0.5, 1.4}) {
    Mix mix = paste();
    mix.mu = 0.0;
    const CellResult r =
        run_cell({mix, 240.0, {{10.0, 0.03, 3.0}, {10.0, 0.0, 0.0}}, {}}, HerschelBulkley{5.0, n});
    EXPECT_LT(*r.stress_error_max, 1e-4 * r.peak->stress) << n;
  }
}

TEST(ElasticCell, ARigidCellIsWhatItWas) {
  Mix mix = paste();
  mix.G = 0.0;
  const CellResult r = run_cell({mix, 240.0, {{10.0, 0.03, 0.03}}, {}}, ExactBingham{});
  EXPECT_FALSE(r.peak || r.stress_error_max || r.samples.back().strain);
  EXPECT_EQ(*r.samples.front().shear_stress, 0.03 * mu + static_yield_stress(7.2, tau_0));
}

TEST(ElasticCell, RefusesALawThatFlowsBelowItsYieldStress) {
  EXPECT_THROW(run_cell({paste(), 0.0, {{1.0, 1.0, 1.0}}, {}}, Papanastasiou{5.0}), std::invalid_argument);
  Mix mix = paste();
  mix.thixotropy.reset(), mix.tau_0 = 0.0;
  EXPECT_THROW(run_cell({mix, 0.0, {{1.0, 1.0, 1.0}}, {}}, ExactBingham{}), std::invalid_argument);
  EXPECT_THROW(elastic_ode({}, {{100.0, 5.0, 1.0}, -1.0}, 0.0, {}), std::invalid_argument);
}

CouetteFlow couette(double omega, double layer = 0.0) {
  CouetteFlow flow{{tau_0, mu}, {A_thix, RatePowerKinetics{0.5, 0.1}, 7.2, layer}, omega, {}};
  flow.shear_modulus = G;
  return flow;
}

// In a gap of 1e-5 of its radius IDA's material is the cell, sheared evenly where the viscous stress, 50 Pa, is large beside
// the gap's 0.02 Pa: CVODE within 1e-4 of the peak.
TEST(ElasticCouette, ANarrowGapFollowsCvode) {
  const double rate = 1.0, viscosity = 50.0;
  const std::vector<double> times{0.02, 0.04, 0.045, 0.05, 0.1, 0.5, 2.0, 8.0};
  CouetteOptions o;
  o.intervals = 20;
  CouetteFlow flow = couette(rate * evenly_sheared_speed);
  flow.bingham.mu = viscosity;
  const CouetteDecay d = thixotropic_couette(flow, times, evenly_sheared(), o);
  const ShearPiece piece{8.0, [rate](double) { return rate; }};
  const auto exact =
      elastic_ode(std::vector{piece}, {{tau_0, viscosity, 1.0}, G, flow.thixotropy}, 7.2, times);
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_NEAR(d.torque[i], exact.stress[i], 1e-4 * 870.0) << times[i] << " s";
}

// Before it yields: T = 4 pi h G Omega t / (R_i^-2 - R_o^-2). The peak comes at the angle at which that meets the static
// yield stress at the vane, 17.2 mrad here, or little later: the record's own peaks lie at 20 to 30 mrad.
TEST(ElasticCouette, TheTorqueRisesAlongTheModulusToItsPeak) {
  const Instrument vane{0.020, 0.060, 0.050};
  const double omega = 0.115 / 60.0 * 2.0 * std::numbers::pi;
  const double share = 1.0 / std::pow(vane.vane_radius, 2) - 1.0 / std::pow(vane.container_radius, 2);
  const double stiffness = 4.0 * std::numbers::pi * vane.vane_height * G / share;  // [N m/rad]
  const double peak = 820.0 * 2.0 * std::numbers::pi * std::pow(vane.vane_radius, 2) * vane.vane_height;
  std::vector<double> times;
  for (int i = 0; i <= 1000; ++i) times.push_back(0.005 * i);
  const CouetteDecay d = thixotropic_couette(couette(omega, 0.003), times, vane);
  std::size_t top = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (stiffness * omega * times[i] < 0.99 * peak) {
      EXPECT_NEAR(d.torque[i], stiffness * omega * times[i], 1e-5 * peak) << times[i];
    }
    if (d.torque[i] > d.torque[top]) top = i;
  }
  std::printf("peak of %.4f N m at %.1f mrad; %.4f N m and %.1f mrad by G and the static yield stress\n",
              d.torque[top], 1e3 * omega * times[top], peak, 1e3 * peak / stiffness);
  EXPECT_NEAR(d.torque[top] / peak, 1.0, 0.02);
  EXPECT_GE(omega * times[top], peak / stiffness - omega * 0.005);
  EXPECT_LE(omega * times[top], 1.15 * peak / stiffness);
}

// A vane that stops: the torque relaxes to what the yield stress holds, and stays where breakdown takes strain. (Where it
// hardly depends on the rate the last creep goes on breaking down.)
TEST(ElasticCouette, AStoppedVaneKeepsItsYieldTorque) {
  CouetteFlow flow = couette(0.0);
  flow.thixotropy.kinetics = RousselKinetics{0.03};
  flow.omega_of_time = [](double t) { return 0.5 * (1.0 - std::tanh(20.0 * (t - 2.0))); };
  const CouetteDecay d = thixotropic_couette(flow, std::vector{1.5, 6.0, 20.0});
  EXPECT_LT(d.torque[1], d.torque[0]);
  EXPECT_NEAR(d.torque[2] / d.torque[1], 1.0, 0.01);
  EXPECT_GT(shear_stress_at(Instrument{}.vane_radius, d.torque[2], Instrument{}), tau_0);
}

}  // namespace
}  // namespace tremie
