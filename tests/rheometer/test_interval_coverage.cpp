// How often the truth lies in the 95 % intervals of fits: 500 made records of each kind (slow), 100 in the reduced run
// (verification). The noise-free curves are closed forms written here; none is the fit's own. Noise of 2 %: white;
// correlated by 0.7 between neighbours (20 readings or more: fewer do not tell it, and count as independent); or white
// with one reading in fifty off by 30 % (a record with more than one in twenty is flagged). Allowed: 90 to 99 % of 500;
// of 100 records, three binomial standard deviations (2.2 % at 95 %) more to each side.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <numbers>
#include <random>
#include <string>

#include "rheometer/fits/fit.hpp"
#include "rheometer/fits/parameters.hpp"

namespace tremie {
namespace {

constexpr int records = TREMIE_COVERAGE_RECORDS;
constexpr double least_share = records >= 500 ? 0.90 : 0.84, most_share = records >= 500 ? 0.99 : 1.0;

enum class Kind { white, correlated, outliers };
constexpr std::pair<Kind, const char*> kinds[] = {
    {Kind::white, "white"}, {Kind::correlated, "correlated"}, {Kind::outliers, "outliers"}};

std::vector<double> errors(std::size_t n, Kind kind, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double rho = kind == Kind::correlated ? 0.7 : 0.0;
  std::vector<double> error(n);
  double state = normal(generator);
  for (double& e : error) {
    e = 0.02 * state;
    state = rho * state + std::sqrt(1.0 - rho * rho) * normal(generator);
    if (kind == Kind::outliers && uniform(generator) < 0.02) e += uniform(generator) < 0.5 ? -0.3 : 0.3;
  }
  return error;
}

struct Counts {
  int told = 0, inside = 0;
};

/// Fits `records` records of the noise-free x and torque and holds the shares to what is allowed. `least_told`: share of the
/// records that have to tell the parameter.
void expect_coverage(const char* what, TorqueRecord exact, const FitInput& input,
                     const std::map<std::string, double>& truth, double least_told = 0.9) {
  for (std::size_t i = 0; i < exact.torque.size(); ++i) exact.line.push_back(static_cast<long>(i) + 2);
  for (const auto& [kind, name] : kinds) {
    if (kind == Kind::correlated && exact.torque.size() < 20) continue;  // no correlation is told of so few
    std::map<std::string, Counts> counts;
    for (int seed = 1; seed <= records; ++seed) {
      TorqueRecord record = exact;
      const std::vector<double> error = errors(exact.torque.size(), kind, static_cast<unsigned>(seed));
      for (std::size_t i = 0; i < error.size(); ++i) record.torque[i] *= 1.0 + error[i];
      const FitResult f = fit(record, input);
      for (const FitParameter& p : fit_parameters()) {
        const auto value = truth.find(p.name);
        const auto e = value_of(f, p);
        if (value == truth.end() || !e || !e->ci95) continue;
        ++counts[p.name].told;
        counts[p.name].inside += e->ci95->low <= value->second && value->second <= e->ci95->high;
      }
    }
    for (const auto& [parameter, value] : truth) {
      const Counts& c = counts[parameter];
      const double share = c.told > 0 ? static_cast<double>(c.inside) / c.told : 0.0;
      std::printf("%-34s %-11s %-20s told %3d of %d, inside %.1f %%\n", what, name, parameter.c_str(), c.told,
                  records, 100.0 * share);
      EXPECT_GE(c.told, least_told * records) << what << ", " << name << ", " << parameter;
      EXPECT_GE(share, least_share) << what << ", " << name << ", " << parameter;
      EXPECT_LE(share, most_share) << what << ", " << name << ", " << parameter;
    }
  }
}

/// Reiner and Riwlin's speed at a torque: (T/(4 pi h))(R_i^-2 - R_s^-2)/mu - (tau_0/mu) ln(R_s/R_i), sheared to
/// R_s = min(R_o, sqrt(T/(2 pi h tau_0))).
double speed_at(double torque, double tau_0, double mu, const Instrument& in) {
  constexpr double pi = std::numbers::pi;
  const double sheared =
      std::min(in.container_radius, std::sqrt(torque / (2.0 * pi * in.vane_height * tau_0)));
  if (sheared <= in.vane_radius) return 0.0;
  return torque / (4.0 * pi * in.vane_height * mu) *
             (1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (sheared * sheared)) -
         tau_0 / mu * std::log(sheared / in.vane_radius);
}

/// Torques over the speeds that they drive: torques are chosen, so that nothing is solved for.
TorqueRecord bingham_in_a_gap(std::size_t n, double tau_0, double mu, const Instrument& in) {
  TorqueRecord record;
  for (std::size_t i = 0; i < n; ++i) {
    const double torque = 0.5 + 3.0 * static_cast<double>(i) / static_cast<double>(n - 1);
    record.torque.push_back(torque);
    record.omega.push_back(speed_at(torque, tau_0, mu, in));
  }
  return record;
}

TEST(Coverage, FlowCurvesOfBinghamInAGap) {
  const Instrument in;
  for (const std::size_t n : {8u, 40u})
    expect_coverage(n == 8 ? "Bingham, 8 readings" : "Bingham, 40 readings",
                    bingham_in_a_gap(n, 54.0, 35.8, in), {},
                    {{"yield_stress", 54.0}, {"plastic_viscosity", 35.8}});
}

TorqueRecord herschel_bulkley(std::size_t n, double tau_0, double k, double index) {
  TorqueRecord record;
  record.sheared_evenly = true;
  for (std::size_t i = 0; i < n; ++i) {
    const double rate = 0.5 * std::pow(200.0, static_cast<double>(i) / static_cast<double>(n - 1));
    record.omega.push_back(rate * evenly_sheared_speed);
    record.torque.push_back(tau_0 + k * std::pow(rate, index));
  }
  return record;
}

TEST(Coverage, FlowCurvesOfHerschelBulkley) {
  FitInput input;
  input.instrument = evenly_sheared();
  input.law = "auto";
  expect_coverage("Herschel-Bulkley, 40 readings", herschel_bulkley(40, 20.0, 8.0, 0.5), input,
                  {{"yield_stress", 20.0}, {"consistency", 8.0}, {"flow_index", 0.5}});
}

/// tau_0 (1 + lambda_0 e^(-alpha gamma_dot t)) + mu gamma_dot at an even rate.
TorqueRecord even_decay(std::size_t n, double rate) {
  TorqueRecord record;
  record.kind = RecordKind::torque_decay;
  record.sheared_evenly = true;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 20.0 * static_cast<double>(i) / static_cast<double>(n - 1);
    record.time.push_back(t);
    record.torque.push_back(54.0 * (1.0 + 3.0 * std::exp(-0.05 * rate * t)) + 10.0 * rate);
  }
  return record;
}

TEST(Coverage, DecaysAtAnEvenRate) {
  FitInput input;
  input.instrument = evenly_sheared();
  input.omega = 4.0 * evenly_sheared_speed;
  input.kinetics = RousselKinetics{};
  input.tau_0 = 54.0, input.mu = 10.0;
  expect_coverage("decay, yield stress known", even_decay(100, 4.0), input,
                  {{"alpha", 0.05}, {"flocculation_start", 3.0}, {"static_yield_stress", 216.0}});
}

}  // namespace
}  // namespace tremie
