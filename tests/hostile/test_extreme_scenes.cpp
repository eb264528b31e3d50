// 1,000 random combinations of stiff and extreme values, by fixed seeds (the verification test: 15), over apparatus,
// spaces, laws, kinetics, schemes, cells: each is right by physics, or is told (exit 3 or 2, with a reason). None may be
// wrong in silence. What physics has against a result: not finite; more volume or less than its own weight compresses;
// mass; more kinetic energy than the fall gives; higher than it was; a cone that does not yield, spread; farther with
// twice the yield stress; another torque with the vane's turn reversed; a torque outside of Reiner and Riwlin's.

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <optional>

#include "apparatus/registry/registry.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "rheometer/reference/instrument.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"
#include "tests/hostile/finite.hpp"
#include "tests/hostile/random_scene.hpp"

namespace tremie {
namespace {

using test::RandomScene;

constexpr double rho = 2400.0, g = 9.81;
constexpr double cone_height = 0.3, column_height = 0.6;
constexpr double cone_volume = 5.498e-3, box_volume = 0.1 * 0.2 * column_height;
constexpr double cone_energy = rho * cone_volume * g * 0.1018;  // its volume and the height of its centre
constexpr double most_cpu = 2.0;                                // [s]; what takes longer is not judged

std::optional<scene::Outcome> run(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto scene = scene::read_text(text, "random.toml", overrides);
  std::atomic<bool> stop{false};
  const double begin = cpu_seconds();
  scene::Observer observer;
  observer.interrupted = &stop;
  observer.on_progress = [&](const scene::Progress&) { stop = cpu_seconds() - begin > most_cpu; };
  scene::Outcome outcome = scene::run(scene, observer);
  if (outcome.status == Status::interrupted) return std::nullopt;
  return outcome;
}

double number_of(const scene::Outcome& outcome, const std::string& name) {
  return scene::find_number(outcome, name).value_or(std::nan(""));
}

double largest(const scene::Outcome& outcome, const std::string& column) {
  double most = -1e300;
  for (const auto& c : outcome.series)
    if (c.name == column)
      for (const double value : c.values) most = std::fmax(most, value);
  return most;
}

std::string said(const char* what, double value, double bound) {
  char text[160];
  std::snprintf(text, sizeof text, "%s: %.5g against %.5g", what, value, bound);
  return text;
}

/// What holds for every body under its weight. What falls and hits is compressed by as much again.
std::string against_body(const RandomScene& s, const scene::Outcome& o, double height) {
  const double compressed = 1.0 - std::exp(-2.0 * rho * g * height / s.K);
  if (s.apparatus != "icar_vane" && std::abs(o.checks.volume_change) > compressed + 0.01)
    return said("volume", o.checks.volume_change, compressed);
  if (std::abs(o.checks.mass_error) > 1e-12) return said("mass", o.checks.mass_error, 1e-12);
  if (o.cost.simulated > s.duration * 1.005) return said("time", o.cost.simulated, s.duration);
  return {};
}

/// What the pressure of its own weight stores in a body [J]; `share`: the mean of (1 - z/H)^2 over its volume.
double stored(const RandomScene& s, double volume, double height, double share) {
  return share * volume * std::pow(rho * g * height, 2) / (2.0 * s.K);
}

std::string against_slump(const RandomScene& s, const scene::Outcome& o) {
  const double spread = number_of(o, "spread_mm"), compressed = rho * g * cone_height / s.K;
  if (!(spread > 150.0)) return said("spread", spread, 200.0);
  const double available = cone_energy + stored(s, cone_volume, cone_height, 0.443);
  if (const double energy = largest(o, "kinetic_energy_J"); energy > 1.02 * available)
    return said("kinetic energy", energy, available);
  if (const double high = largest(o, "height_mm"); high > 1e3 * (1.05 * cone_height + 0.5 * s.cell_up))
    return said("height", high, 1e3 * cone_height);
  const double tau_y = s.tau_0 * (1.0 + (s.thixotropic ? 0.0 : s.lambda));
  const bool stands = s.exact && std::sqrt(3.0) * tau_y > 1.05 * rho * g * cone_height;
  if (stands && compressed < 0.02 && spread > 200.0 + 1e3 * s.cell)
    return said("a cone that stands", spread, 200.0);
  return {};
}

std::string against_box(const RandomScene& s, const scene::Outcome& o) {
  const double h1 = number_of(o, "h1_mm"), energy = largest(o, "kinetic_energy_J");
  if (!(h1 >= 0.0 && h1 < 1e3 * 1.05 * column_height)) return said("h1", h1, 1e3 * column_height);
  const double available =
      rho * box_volume * g * 0.5 * column_height + stored(s, box_volume, column_height, 1.0 / 3.0);
  if (energy > 1.02 * available) return said("kinetic energy", energy, available);
  if (const double front = largest(o, "front_mm"); front > 705.0) return said("front", front, 700.0);
  return {};
}

/// The torque of the gap lies below that of a mix with all the flocculation that it can have, and above the viscous one.
std::string against_couette(const RandomScene& s, const scene::Outcome& o) {
  if (s.herschel_bulkley || s.space != "couette") return {};
  const double torque = std::abs(number_of(o, "torque_end_N_m")), omega = angular_speed(s.speed);
  const double low = reiner_riwlin({s.exact ? s.tau_0 : 0.0, s.mu}, omega).torque;
  if (!(torque > 0.97 * low)) return said("torque, too small", torque, low);
  if (s.thixotropic) return {};
  const double high = reiner_riwlin({s.tau_0, s.mu}, omega).torque;
  if (torque > 1.03 * high) return said("torque, too large", torque, high);
  return {};
}

std::string against(const RandomScene& s, const scene::Outcome& o) {
  if (o.status != Status::completed) return "did not complete and gives no reason";
  if (!is_finite(o.results)) return "a result is not finite";
  const double height = s.apparatus == "l_box" ? column_height : cone_height;
  if (const std::string wrong = against_body(s, o, height); !wrong.empty()) return wrong;
  if (s.apparatus == "slump_flow") return against_slump(s, o);
  return s.apparatus == "l_box" ? against_box(s, o) : against_couette(s, o);
}

/// A second run of the same scene with one thing changed, of which physics knows the sign.
std::string against_twin(const RandomScene& s, const scene::Outcome& o) {
  if (s.apparatus == "icar_vane") {
    const auto back = run(s.text, {"test.speed=-" + std::to_string(s.speed) + " rev/s"});
    if (!back || !back->checks.reasons.empty()) return {};
    const double one = number_of(o, "torque_end_N_m"), other = -number_of(*back, "torque_end_N_m");
    return std::abs(one - other) <= 1e-4 * std::abs(one) ? "" : said("the other way", one, other);
  }
  if (s.apparatus != "slump_flow" || s.thixotropic) return {};
  const double more = s.tau_0 > 0.0 ? 2.0 * s.tau_0 : 200.0;
  const auto stiffer = run(s.text, {"mix.yield_stress=" + std::to_string(more) + " Pa"});
  if (!stiffer || !stiffer->checks.reasons.empty()) return {};
  const double spread = number_of(o, "spread_mm"), less = number_of(*stiffer, "spread_mm");
  return less <= 1.02 * spread + 0.1e3 * s.cell ? "" : said("farther with more yield stress", less, spread);
}

/// "right", "told", "refused", "too slow", or "silent: " and why.
std::string ending_of(const RandomScene& s, bool with_twin) try {
  const auto outcome = run(s.text);
  if (!outcome) return "too slow";
  if (!outcome->checks.reasons.empty()) return "told";
  std::string wrong = against(s, *outcome);
  if (wrong.empty() && with_twin) wrong = against_twin(s, *outcome);
  return wrong.empty() ? "right" : "silent: " + wrong;
} catch (const scene::InputError& error) {
  return "refused";
} catch (const std::exception& error) {
  return std::string("silent: ") + error.what();
}

void judge_scenes(unsigned first, unsigned scenes) {
  std::map<std::string, std::map<std::string, int>> table;
  const char* only = std::getenv("TREMIE_ONLY");  // the number of one
  std::ofstream log;
  if (const char* file = std::getenv("TREMIE_LOG")) log.open(file);
  for (unsigned i = only ? static_cast<unsigned>(std::atoi(only)) : first; only || i < first + scenes; ++i) {
    const RandomScene s = test::SceneGenerator(i)();
    const double begin = cpu_seconds();
    alarm(120);
    const std::string how = ending_of(s, i % 3 == 0);
    alarm(0);
    EXPECT_FALSE(how.starts_with("silent")) << "scene " << i << ", " << how << ":\n" << s.text;
    ++table[s.apparatus + " " + s.space][how.substr(0, how.find(':'))];
    log << i << ' ' << s.apparatus << ' ' << s.space << ' ' << cpu_seconds() - begin << ' ' << how
        << std::endl;
    if (only) break;
  }
  for (const auto& [kind, endings] : table)
    for (const auto& [how, n] : endings) std::cout << kind << ": " << n << ' ' << how << '\n';
}

TEST(ExtremeScenes, Some) { judge_scenes(0, 15); }

// Those of them that were wrong in silence or crashed: two and three points for a cone, the depth behind a gate read from
// whole columns of points, a torque averaged over the start, a last step so short that it rang, cells longer than a blade.
TEST(ExtremeScenes, SomeThatWereWrong) {
  for (const unsigned i : {188u, 190u, 204u, 216u, 303u, 305u, 331u}) {
    const RandomScene s = test::SceneGenerator(i)();
    const std::string how = ending_of(s, false);
    EXPECT_FALSE(how.starts_with("silent")) << "scene " << i << ", " << how << ":\n" << s.text;
  }
}

// A reference that cannot be integrated takes nothing from the run but the check against it.
TEST(ExtremeScenes, SomeReferencesFail) {
  const auto outcome = run(R"(apparatus = "icar_vane"
mix = {yield_stress = "54e-8 Pa", plastic_viscosity = "15.66 Pa.s", thixotropy = {structuration_rate = "0 Pa/s", destructuration = 0.0374, initial_flocculation = 3.456}}
test = {speed = "0.794 rev/s", duration = "10 s"})");
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->status, Status::completed);
  EXPECT_GT(number_of(*outcome, "torque_end_N_m"), 0.0);
  for (const std::string& reason : outcome->checks.reasons)
    EXPECT_NE(reason.find("cannot be checked"), std::string::npos) << reason;
}

TEST(ExtremeScenes, AllFirst) { judge_scenes(0, 250); }
TEST(ExtremeScenes, AllSecond) { judge_scenes(250, 250); }
TEST(ExtremeScenes, AllThird) { judge_scenes(500, 250); }
TEST(ExtremeScenes, AllFourth) { judge_scenes(750, 250); }

}  // namespace
}  // namespace tremie
