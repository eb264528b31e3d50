// The interface law of a smooth cylinder's torques that were made with one: side 2 pi R^2 h (tau_i + k_i u), and a bottom disc,
// 2 pi (tau_i R^3/3 + k_i Omega R^4/4), where it touches the same concrete.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/whole_fit/fit_record.hpp"
#include "rheometer/whole_fit/tribometer.hpp"

namespace tremie {
namespace {

constexpr double pi = std::numbers::pi, R = 0.0625, tau_i = 30.0, k_i = 800.0;
const Instrument instrument{R, 0.2, 0.15};

FitInput smooth_cylinder() {
  FitInput in;
  in.instrument = instrument;
  return in;
}

/// `own_speed`: of the concrete at a stress of its wall.
template <class OwnSpeed>
TribometerSeries series_at(double height, double noise, unsigned seed, OwnSpeed own_speed) {
  TribometerSeries s;
  s.fill_height = height;
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 8; ++i) {
    const double u = 0.02 + 0.05 * i, tau = tau_i + k_i * u, omega = u / R + own_speed(tau);
    const double bottom = 2.0 * pi * (tau_i * R * R * R / 3.0 + k_i * omega * R * R * R * R / 4.0);
    s.record.omega.push_back(omega);
    s.record.torque.push_back((2.0 * pi * R * R * height * tau + bottom) * (1.0 + noise * normal(generator)));
    s.record.line.push_back(i + 2);
  }
  return s;
}

double stands(double) { return 0.0; }

/// Bingham's 20 Pa and 30 Pa s in a gap that is sheared whole: Omega = T/(4 pi h mu)(R_i^-2 - R_o^-2) - tau_0/mu ln(R_o/R_i).
double shears(double tau) {
  return tau * R * R / (2.0 * 30.0) * (1.0 / (R * R) - 1.0 / (0.15 * 0.15)) -
         20.0 / 30.0 * std::log(0.15 / R);
}

double value(const FitResult& f, std::size_t k) { return value_of(f, interface_parameters()[k])->value; }

// A bottom of one law is a straight line over the speed, as the fit takes it: no error but the iterations'.
TEST(Tribometer, SeveralFillHeightsTellTheSideFromTheBottom) {
  const FitResult f =
      fit_tribometer({series_at(0.1, 0, 1, stands), series_at(0.2, 0, 1, stands)}, smooth_cylinder());
  EXPECT_NEAR(value(f, 0), tau_i, 1e-4 * tau_i);
  EXPECT_NEAR(value(f, 1), k_i, 1e-4 * k_i);
  EXPECT_TRUE(f.reasons.empty());
  EXPECT_EQ(scene_walls(f),
            "[walls]\ncontact = \"interface\"\ninterface_yield_stress = \"30 Pa\"\ninterface_viscosity = "
            "\"800 Pa.s/m\"\n");
  EXPECT_EQ(law_of(f), nullptr);
}

// The bottom's 2 pi R^3/3 (1 + ...) counts as the side's: R/(3 h) and R/(4 h) too much, 10 and 8 % at 0.2 m.
TEST(Tribometer, OneFillHeightReadsHighAndSaysSo) {
  const FitResult f = fit_tribometer({series_at(0.2, 0, 1, stands)}, smooth_cylinder());
  EXPECT_NEAR(value(f, 0), tau_i * (1.0 + R / 0.6), 1e-4 * tau_i);
  EXPECT_NEAR(value(f, 1), k_i * (1.0 + R / 0.8), 1e-4 * k_i);
  bool told = false;
  for (const std::string& note : f.notes) told = told || note.find("one fill height") != std::string::npos;
  EXPECT_TRUE(told);
}

// 60 bisections leave 1e-18 of the stress; the ends' torque over the speed is then no line, 1e-3 of the whole.
TEST(Tribometer, TheConcretesOwnShearIsTakenOff) {
  FitInput in = smooth_cylinder();
  in.tau_0 = 20.0, in.mu = 30.0;
  const FitResult f = fit_tribometer({series_at(0.1, 0, 1, shears), series_at(0.2, 0, 1, shears)}, in);
  EXPECT_NEAR(value(f, 0), tau_i, 5e-3 * tau_i);
  EXPECT_NEAR(value(f, 1), k_i, 5e-3 * k_i);
  in.mu.reset();
  EXPECT_THROW(fit_tribometer({series_at(0.1, 0, 1, shears)}, in), std::invalid_argument);
}

// 95 % intervals over 200 records with 1 % of noise: 85 % (chance of less: 1e-8) to all.
TEST(Tribometer, IntervalsHoldTheTruth) {
  int inside[2] = {0, 0};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    const FitResult f =
        fit_tribometer({series_at(0.1, 0.01, seed, stands), series_at(0.15, 0.01, 1000 + seed, stands),
                        series_at(0.2, 0.01, 2000 + seed, stands)},
                       smooth_cylinder());
    for (std::size_t k = 0; k < 2; ++k) {
      const auto e = value_of(f, interface_parameters()[k]);
      ASSERT_TRUE(e && e->ci95);
      const double truth = k == 0 ? tau_i : k_i;
      inside[k] += e->ci95->low <= truth && truth <= e->ci95->high;
    }
  }
  EXPECT_GE(inside[0], 170);
  EXPECT_GE(inside[1], 170);
}

// Heights in the wrong order let the torque fall as the cylinder dips deeper.
TEST(Tribometer, FillHeightsInTheWrongOrderAreTold) {
  TribometerSeries shallow = series_at(0.1, 0, 1, stands), deep = series_at(0.2, 0, 1, stands);
  std::swap(shallow.fill_height, deep.fill_height);
  EXPECT_FALSE(fit_tribometer({shallow, deep}, smooth_cylinder()).reasons.empty());
}

TEST(Tribometer, ThroughTheFitOfRecords) {
  FitOptions options;
  options.vane_radius = R, options.container_radius = 0.15;
  options.tribometer = true;
  options.fill_height = "100 mm; 20 cm";
  const std::vector<RecordSource> sources{{.name = "", .record = series_at(0.1, 0, 1, stands).record},
                                          {.name = "", .record = series_at(0.2, 0, 1, stands).record}};
  const RecordFits all = fit_records(sources, options, {TREMIE_REFERENCE_DATA});
  ASSERT_EQ(all.fits.size(), 1u);
  EXPECT_NEAR(value(all.fits.front(), 0), tau_i, 1e-4 * tau_i);
  options.fill_height = "100 mm";
  EXPECT_THROW(fit_records(sources, options, {TREMIE_REFERENCE_DATA}), std::invalid_argument);
  EXPECT_THROW(fill_heights("100"), std::invalid_argument);
  options.tribometer = false;
  EXPECT_THROW(fit_records(sources, options, {TREMIE_REFERENCE_DATA}), std::invalid_argument);
}

}  // namespace
}  // namespace tremie
