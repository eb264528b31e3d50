#include "apparatus/verification/extremes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "apparatus/registry/registry.hpp"
#include "apparatus/verification/case.hpp"
#include "libmpm/constitutive/constants.hpp"
#include "rheometer/reference/instrument.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"

namespace tremie::verification {
namespace {

constexpr double rho = 2400.0, g = gravity;
constexpr double cone_volume = 5.498e-3, cone_centroid = 0.1018;  // [m^3], [m] above the floor

const char* const slump_scene = R"(apparatus = "slump_flow"
[mix]
density = "2400 kg/m3"
yield_stress = "54 Pa"
plastic_viscosity = "35.8 Pa.s"
bulk_modulus = "1 MPa"
[test]
duration = "2 s"
[model]
cell = ["20 mm", "10 mm"]
points_per_cell = [3, 3]
[output]
frames = false
)";

const char* const vane_scene = R"(apparatus = "icar_vane"
[mix]
density = "2400 kg/m3"
yield_stress = "54 Pa"
plastic_viscosity = "35.8 Pa.s"
bulk_modulus = "1 MPa"
[test]
speed = "0.25 rev/s"
duration = "5 s"
[model]
space = "couette"
cell = "4 mm"
[output]
frames = false
)";

const char* const cell_scene = R"(apparatus = "cell"
[mix]
density = "2400 kg/m3"
yield_stress = "54 Pa"
plastic_viscosity = "35.8 Pa.s"
[[history]]
duration = "10 s"
from = "0 1/s"
to = "10 1/s"
[[history]]
duration = "10 s"
from = "10 1/s"
to = "0 1/s"
)";

std::string set(const std::string& key, double value, const std::string& unit) {
  return unit.empty() ? fmt::format("{}={:g}", key, value) : fmt::format("{}={:g} {}", key, value, unit);
}

/// Largest value of a column of the series; not-a-number stands for no value there.
double largest(const scene::Outcome& outcome, const std::string& column) {
  double result = std::nan("");
  for (const auto& c : outcome.series)
    if (c.name == column)
      for (double value : c.values) result = std::fmax(result, value);
  return result;
}

/// What holds for every slump: a finite spread, no more kinetic energy than the cone's height gives, volume
/// up to what its own weight compresses, mass, and a concrete too stiff to yield under its weight keeps its
/// shape.
std::string against_slump(const scene::Outcome& o, double tau_y, double K, double cell) {
  const auto spread = scene::find_number(o, "spread_mm");
  if (!spread) return "no spread";
  if (*spread < 150.0) return fmt::format("the spread of {:.0f} mm is less than the cone", *spread);
  const double available = rho * cone_volume * g * cone_centroid;
  if (const double energy = largest(o, "kinetic_energy_J"); !(energy <= available))
    return fmt::format("{:.3g} J of kinetic energy from {:.3g} J", energy, available);
  const double compressed = rho * g * 0.3 / K;
  if (std::abs(o.checks.volume_change) > compressed + 0.005)
    return fmt::format("volume {:+.2g} %", 100.0 * o.checks.volume_change);
  if (std::abs(o.checks.mass_error) > 1e-12) return "mass";
  // A column of height H yields under its weight where rho g H > sqrt(3) tau_y; the cone later than that.
  if (std::sqrt(3.0) * tau_y > rho * g * 0.3 && compressed < 0.02 && *spread > 200.0 + 1e3 * cell)
    return fmt::format("a cone that does not yield spreads to {:.0f} mm", *spread);
  return {};
}

struct SlumpCase {
  double tau_0 = 54.0, mu = 35.8, K = 1e6, lambda = 0.0, cell = 0.02;
  bool creeps = false;  ///< by a regularised law: a stiff cone may spread
};

Extreme slump(const std::string& family, const std::string& name, const SlumpCase& c,
              std::vector<std::string> overrides) {
  overrides.insert(overrides.begin(),
                   {set("mix.yield_stress", c.tau_0, "Pa"), set("mix.plastic_viscosity", c.mu, "Pa.s"),
                    set("mix.bulk_modulus", c.K, "Pa")});
  const double tau_y = c.creeps ? 0.0 : (1.0 + c.lambda) * c.tau_0, K = c.K, cell = c.cell;
  return {.family = "slump: " + family,
          .name = name,
          .scene = slump_scene,
          .overrides = std::move(overrides),
          .against = [=](const scene::Outcome& o) { return against_slump(o, tau_y, K, cell); },
          .reading = "spread_mm"};
}

void add_regularisation(std::vector<Extreme>& all) {
  for (double tau_0 : {0.0, 54.0, 5000.0}) {
    for (double m : {0.0, 1e-3, 0.1, 5.0, 100.0, 1e4, 1e6})
      all.push_back(slump("m over yield stress", fmt::format("m = {:g} s, {:g} Pa", m, tau_0),
                          {.tau_0 = tau_0, .creeps = true},
                          {"model.yield=papanastasiou", set("model.regularisation", m, "s")}));
    for (double rate : {1e-6, 0.1, 100.0})
      all.push_back(slump("bi-viscous", fmt::format("{:g} 1/s, {:g} Pa", rate, tau_0),
                          {.tau_0 = tau_0, .creeps = true},
                          {"model.yield=bi_viscous", set("model.critical_shear_rate", rate, "1/s")}));
  }
}

void add_yield_and_viscosity(std::vector<Extreme>& all) {
  for (double mu : {0.01, 1.0, 35.8, 1000.0})
    for (double tau_0 : {0.0, 1e-3, 1.0, 10.0, 54.0, 500.0, 5000.0}) {
      all.push_back(slump("yield stress over viscosity", fmt::format("{:g} Pa, {:g} Pa.s", tau_0, mu),
                          {.tau_0 = tau_0, .mu = mu}, {}));
      all.back().monotone_key = fmt::format("{:g}", mu);
      all.back().rank = tau_0;
    }
}

void add_bulk_modulus(std::vector<Extreme>& all) {
  for (double tau_0 : {0.0, 54.0, 5000.0})
    for (double K : {1e4, 3.3e4, 1e5, 1e7, 1e8, 2e9})
      all.push_back(
          slump("bulk modulus", fmt::format("K = {:g} Pa, {:g} Pa", K, tau_0), {.tau_0 = tau_0, .K = K}, {}));
}

void add_flocculation(std::vector<Extreme>& all) {
  for (double alpha : {0.0, 0.01, 1.0, 1e3})
    for (double lambda : {0.0, 1.0, 1e3})
      for (double A_thix : {0.0, 1.3, 100.0})
        for (double rest : {0.0, 86400.0})
          all.push_back(slump(
              "flocculation",
              fmt::format("α = {:g}, λ0 = {:g}, A = {:g} Pa/s, rest {:g} s", alpha, lambda, A_thix, rest),
              {.lambda = alpha > 0.5 ? 0.0 : lambda + A_thix * rest / 54.0},
              {set("mix.thixotropy.destructuration", alpha, ""),
               set("mix.thixotropy.structuration_rate", A_thix, "Pa/s"),
               set("mix.thixotropy.initial_flocculation", lambda, ""), set("test.rest", rest, "s"),
               "test.duration=0.6 s"}));
  all.push_back(slump("flocculation", "thixotropy without a yield stress", {.tau_0 = 0.0},
                      {"mix.thixotropy.structuration_rate=1.3 Pa/s"}));
}

void add_cone_and_grid(std::vector<Extreme>& all) {
  for (double tau_0 : {0.0, 54.0, 5000.0}) {
    for (const char* lift : {"0.001 m/s", "10 m/s", "instant"})
      all.push_back(slump("lift", fmt::format("{}, {:g} Pa", lift, tau_0), {.tau_0 = tau_0},
                          {std::string("test.lift_speed=") + lift}));
    for (const char* cell :
         {"[\"5 mm\", \"5 mm\"]", "[\"50 mm\", \"50 mm\"]", "[\"50 mm\", \"5 mm\"]", "[\"5 mm\", \"50 mm\"]"})
      all.push_back(slump("cells", fmt::format("{}, {:g} Pa", cell, tau_0), {.tau_0 = tau_0, .cell = 0.05},
                          {std::string("model.cell=") + cell, "test.duration=1 s"}));
    all.push_back(slump("cells", fmt::format("one point a cell, {:g} Pa", tau_0), {.tau_0 = tau_0},
                        {"model.points_per_cell=1"}));
  }
  all.push_back(
      slump("cells", "2.5 mm", {}, {"model.cell=2.5 mm", "model.points_per_cell=2", "test.duration=0.2 s"}));
  all.push_back(slump("cells", "one cell of 400 mm: one point", {.cell = 0.4},
                      {"model.cell=400 mm", "model.points_per_cell=1"}));
  for (const char* contact : {"no_slip", "free_slip"})
    all.push_back(slump("floor", contact, {}, {std::string("floor.contact=") + contact}));
  for (double coefficient : {0.0, 1e-6, 0.35, 10.0})
    all.push_back(slump("floor", fmt::format("friction {:g}", coefficient), {},
                        {"floor.contact=friction", set("floor.coefficient", coefficient, "")}));
}

void add_fixed_steps(std::vector<Extreme>& all) {
  for (double tau_0 : {0.0, 54.0, 5000.0})
    for (double mu : {0.01, 35.8})
      for (double dt : {1e-3, 0.02, 0.2, 2.0})
        all.push_back(slump("fixed step", fmt::format("Δt = {:g} s, {:g} Pa, {:g} Pa.s", dt, tau_0, mu),
                            {.tau_0 = tau_0, .mu = mu},
                            {set("model.time_step", dt, "s"), "test.lift_speed=instant"}));
}

/// Linear systems by iteration in single precision. A cone that does not yield spreads by 4 mm at most.
void add_space(std::vector<Extreme>& all) {
  for (double K : {3.3e4, 1e6, 2e9})
    for (double mu : {1.0, 35.8, 1000.0})
      for (double tau_0 : {54.0, 500.0, 5000.0}) {
        all.push_back(slump("in space", fmt::format("K = {:g} Pa, {:g} Pa.s, {:g} Pa", K, mu, tau_0),
                            {.tau_0 = tau_0, .mu = mu, .K = K, .cell = 0.004},
                            {"model.space=quarter", "model.cell=15 mm", "model.points_per_cell=2"}));
        all.back().monotone_key = fmt::format("in space {:g} {:g}", K, mu);
        all.back().rank = tau_0;
      }
}

/// The torque lies between those of the mix without and with all of its flocculation, by Reiner-Riwlin.
std::string against_torque(const scene::Outcome& o, const Bingham& bingham, double lambda, double speed) {
  const auto torque = scene::find_number(o, "torque_end_N_m");
  if (!torque) return "no torque";
  const double omega = angular_speed(std::abs(speed));
  const double low = reiner_riwlin(bingham, omega).torque;
  const double high = reiner_riwlin({(1.0 + lambda) * bingham.tau_0, bingham.mu}, omega).torque;
  const double magnitude = std::abs(*torque);
  if (magnitude < 0.98 * low - 1e-9 || magnitude > 1.02 * high + 1e-9)
    return fmt::format("{:.4g} N m outside of {:.4g} to {:.4g}", magnitude, low, high);
  return {};
}

void add_vane(std::vector<Extreme>& all) {
  for (double tau_0 : {0.0, 1e-3, 54.0, 5000.0})
    for (double mu : {0.01, 35.8, 1000.0})
      for (double speed : {0.01, 0.25, 5.0})
        all.push_back(
            {.family = "vane: yield stress, viscosity, speed",
             .name = fmt::format("{:g} Pa, {:g} Pa.s, {:g} rev/s", tau_0, mu, speed),
             .scene = vane_scene,
             .overrides = {set("mix.yield_stress", tau_0, "Pa"), set("mix.plastic_viscosity", mu, "Pa.s"),
                           set("test.speed", speed, "rev/s")},
             .against =
                 [=](const scene::Outcome& o) {
                   return against_torque(o, {tau_0, mu}, 0.0, speed);
                 },
             .reading = "torque_end_N_m"});
  for (double alpha : {0.0, 0.01, 1e3})
    for (double lambda : {1.0, 1e3})
      all.push_back({.family = "vane: flocculation",
                     .name = fmt::format("α = {:g}, λ0 = {:g}", alpha, lambda),
                     .scene = vane_scene,
                     .overrides = {"mix.thixotropy.structuration_rate=1.3 Pa/s",
                                   set("mix.thixotropy.destructuration", alpha, ""),
                                   set("mix.thixotropy.initial_flocculation", lambda, "")},
                     .against =
                         [=](const scene::Outcome& o) {
                           return against_torque(o, {54.0, 35.8}, lambda + 1.3 * 5.0 / 54.0, 0.25);
                         },
                     .reading = "torque_end_N_m"});
}

/// The stress of a law is monotone in the shear rate at its yield stress: no more than Bingham's at the
/// largest rate and flocculation, and the update close to CVODE.
std::string against_cell(const scene::Outcome& o, double tau_y, double mu, double rate) {
  const double stress = largest(o, "shear_stress_Pa");
  if (!(stress <= (mu * rate + tau_y) * (1.0 + 1e-9)))
    return fmt::format("{:.6g} Pa, more than {:.6g}", stress, mu * rate + tau_y);
  const auto error = scene::find_number(o, "flocculation_error_max");
  if (error && *error > 0.01 * std::max(tau_y / 54.0, 1.0)) return fmt::format("λ is {:.2g} off", *error);
  return {};
}

void add_cell(std::vector<Extreme>& all) {
  for (double m : {1e-3, 5.0, 1e4, 1e6})
    for (double tau_0 : {0.0, 54.0, 5000.0})
      all.push_back({.family = "cell: m over yield stress",
                     .name = fmt::format("m = {:g} s, {:g} Pa", m, tau_0),
                     .scene = cell_scene,
                     .overrides = {"model.yield=papanastasiou", set("model.regularisation", m, "s"),
                                   set("mix.yield_stress", tau_0, "Pa")},
                     .against = [=](const scene::Outcome& o) { return against_cell(o, tau_0, 35.8, 10.0); }});
  for (double alpha : {0.0, 0.01, 1e3})
    for (double lambda : {0.0, 1e3})
      for (double A_thix : {0.0, 100.0})
        for (const char* kinetics : {"gated", "roussel"})
          all.push_back(
              {.family = "cell: flocculation",
               .name = fmt::format("α = {:g}, λ0 = {:g}, A = {:g} Pa/s, {}", alpha, lambda, A_thix, kinetics),
               .scene = cell_scene,
               .overrides = {set("mix.thixotropy.destructuration", alpha, ""),
                             set("mix.thixotropy.initial_flocculation", lambda, ""),
                             set("mix.thixotropy.structuration_rate", A_thix, "Pa/s"),
                             fmt::format("mix.thixotropy.kinetics={}", kinetics)},
               .against = [=](const scene::Outcome& o) {
                 return against_cell(o, (1.0 + lambda + A_thix * 20.0 / 54.0) * 54.0, 35.8, 10.0);
               }});
}

void add_rate_power(std::vector<Extreme>& all) {
  const auto add = [&](const std::string& name, std::vector<std::string> overrides) {
    overrides.insert(overrides.end(),
                     {"mix.thixotropy.kinetics=rate_power", "mix.thixotropy.initial_flocculation=5",
                      "mix.thixotropy.structuration_rate=1.3 Pa/s"});
    all.push_back({.family = "cell: breakdown by a power of the rate",
                   .name = name,
                   .scene = cell_scene,
                   .overrides = std::move(overrides),
                   .against = [](const scene::Outcome& o) {
                     return against_cell(o, (6.0 + 1.3 * 20.0 / 54.0) * 54.0, 35.8, 10.0);
                   }});
  };
  for (const double k : {0.0, 1e-6, 1e6})
    for (const double a : {0.0, 0.03, 1.0})
      for (const char* others :
           {"", "critical_shear_rate=1e-6 1/s", "critical_shear_rate=100 1/s", "saturation=0.5"}) {
        std::vector<std::string> overrides{set("mix.thixotropy.breakdown_rate", k, "1/s"),
                                           set("mix.thixotropy.rate_exponent", a, "")};
        if (*others) overrides.push_back(fmt::format("mix.thixotropy.{}", others));
        add(fmt::format("k = {:g} 1/s, a = {:g} {}", k, a, others), overrides);
      }
  for (const char* modes : {"[[0.5, 1e-9], [0.5, 1e9]]", "[[0.25, 1], [0.25, 1], [0.25, 1], [0.25, 1]]"})
    add(fmt::format("modes {}", modes), {fmt::format("mix.thixotropy.modes={}", modes)});
}

scene::Outcome run_scene(const Extreme& extreme, double limit, bool& too_slow) {
  const auto scene = scene::read_text(extreme.scene, extreme.name, extreme.overrides, /*command*/ "");
  std::atomic<bool> stop{false};
  const double start = cpu_seconds();
  scene::Observer observer;
  observer.interrupted = &stop;
  observer.on_progress = [&](const scene::Progress&) { stop = cpu_seconds() - start > limit; };
  scene::Outcome outcome = scene::run(scene, observer);
  too_slow = outcome.status == Status::interrupted;
  return outcome;
}

}  // namespace

std::vector<Extreme> extremes() {
  std::vector<Extreme> all;
  add_regularisation(all);
  add_yield_and_viscosity(all);
  add_bulk_modulus(all);
  add_flocculation(all);
  add_cone_and_grid(all);
  add_fixed_steps(all);
  add_space(all);
  add_vane(all);
  add_cell(all);
  add_rate_power(all);
  return all;
}

Verdict judge(const Extreme& extreme, double limit) {
  Verdict verdict;
  const double start = cpu_seconds();
  try {
    bool too_slow = false;
    const scene::Outcome outcome = run_scene(extreme, limit, too_slow);
    if (!extreme.reading.empty()) verdict.reading = scene::find_number(outcome, extreme.reading);
    if (too_slow) {
      verdict.ending = Ending::too_slow;
    } else if (!outcome.checks.reasons.empty()) {
      verdict.ending = Ending::flagged;
      verdict.why = outcome.checks.reasons.front();
    } else if (outcome.status != Status::completed) {
      verdict.ending = Ending::silent_wrong;
      verdict.why = "did not complete and gives no reason";
    } else if (const std::string against = extreme.against(outcome); !against.empty()) {
      verdict.ending = Ending::silent_wrong;
      verdict.why = against;
    }
  } catch (const scene::InputError& error) {
    verdict.ending = Ending::no_meaning;
    verdict.why = error.what();
  }
  verdict.cpu = cpu_seconds() - start;
  return verdict;
}

void judge_monotony(const std::vector<Extreme>& cases, std::vector<Verdict>& verdicts) {
  std::map<std::string, std::vector<std::size_t>> groups;
  for (std::size_t i = 0; i < cases.size(); ++i)
    if (!cases[i].monotone_key.empty() && verdicts[i].ending == Ending::right && verdicts[i].reading)
      groups[cases[i].family + cases[i].monotone_key].push_back(i);
  for (auto& [key, members] : groups) {
    std::sort(members.begin(), members.end(), [&](auto a, auto b) { return cases[a].rank < cases[b].rank; });
    for (std::size_t k = 1; k < members.size(); ++k) {
      Verdict &before = verdicts[members[k - 1]], &now = verdicts[members[k]];
      if (*now.reading <= 1.02 * *before.reading) continue;
      now.ending = Ending::silent_wrong;
      now.why = fmt::format("{} {:.0f} where a lower rank has {:.0f}", cases[members[k]].reading,
                            *now.reading, *before.reading);
    }
  }
}

}  // namespace tremie::verification
