// What a scene may say, and what it is told when it says something else. Every fault names file, line and
// key.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <sstream>

#include "apparatus/parts/cone/cone_test.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/registry/usual_ranges.hpp"
#include "apparatus/scene/resolved.hpp"
#include "tests/apparatus/complaint.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie::scene {
namespace {

const std::string mix_a = R"(apparatus = "slump_flow"
[mix]
yield_stress = "54 Pa"
plastic_viscosity = "35.8 Pa.s"
)";

const std::string thixotropic = mix_a + "[mix.thixotropy]\nstructuration_rate = \"1.3 Pa/s\"\n";

using test::complaint;
using test::says;

const cone::Scene& slump(const Scene& scene) { return std::any_cast<const cone::Scene&>(scene.test); }

/// The notes on a slump flow of Mix A with these values set, each with this part.
int notes_with(const std::vector<std::string>& overrides, const std::string& part) {
  int n = 0;
  for (const auto& note : read_text(mix_a, "a.toml", overrides).notes)
    n += note.find(part) != std::string::npos ? 1 : 0;
  return n;
}

TEST(SceneReader, AValueThatNoConcreteHasIsNotedOnceWithItsLikelySlip) {
  EXPECT_TRUE(read_text(mix_a, "a.toml").notes.empty());
  EXPECT_TRUE(
      read_text(thixotropic, "a.toml", {"test.rest=240 s", "mix.yield_stress=1.5 kPa"}).notes.empty());
  EXPECT_EQ(notes_with({"mix.yield_stress=54 kPa"}, "54 kPa is unusual"), 1);
  EXPECT_EQ(notes_with({"mix.yield_stress=54 kPa"}, "kPa may stand for Pa"), 1);
  EXPECT_EQ(notes_with({"mix.density=2.4 kg/m3"}, "kg/m3 may stand for g/cm3"), 1);
  EXPECT_EQ(notes_with({"mix.plastic_viscosity=35.8 mPa.s"}, "mPa.s may stand for Pa.s"), 1);
  EXPECT_EQ(notes_with({"cone.height=300 cm"}, "cm may stand for mm"), 1);
  EXPECT_EQ(notes_with({"test.lift_speed=15 m/s"}, "m/s may stand for cm/s"), 1);
  EXPECT_EQ(notes_with({"measured.spread=590 cm"}, "cm may stand for mm"), 1);
}

TEST(SceneReader, TheDefaultsOfEveryApparatusAreUsual) {
  for (const Apparatus& apparatus : all_apparatus())
    for (const UsualRange& range : usual_ranges()) {
      const std::string key = range.key;
      const Section* section = find_section(apparatus.keys.schema, key.substr(0, key.rfind('.')));
      const Key* about = section ? find_key(*section, key.substr(key.rfind('.') + 1)) : nullptr;
      if (!about || about->fallback.empty() || about->fallback[0] == '[') continue;
      const double value = parse_quantity(about->fallback, about->dimension);
      EXPECT_TRUE(value == 0.0 || (value >= range.low && value <= range.high))
          << apparatus.keys.name << " " << key;
    }
}

// 2400 kg/m3 times 9.81 m/s2 times 0.3 m are 7.06 kPa: 1 - exp(-7.06/50) = 13.2 %; below 2 % nothing is said.
TEST(SceneReader, WhatASoftMixLosesByItsWeightIsNoted) {
  EXPECT_EQ(notes_with({"mix.bulk_modulus=50 kPa"}, "compress the foot by 13 %"), 1);
  EXPECT_EQ(notes_with({"mix.bulk_modulus=400 kPa"}, "bulk_modulus"), 0);
  EXPECT_EQ(notes_with({"preset=paper"}, "33.3 kPa is soft"), 1);
}

TEST(SceneReader, DefaultsAreTheDocumentedOnes) {
  const Scene scene = read_text(thixotropic, "a.toml");
  const auto& s = slump(scene);
  EXPECT_EQ(s.mix.tau_0, 54.0);
  EXPECT_EQ(s.mix.mu, 35.8);
  EXPECT_EQ(s.mix.density, 2400.0);
  EXPECT_EQ(s.mix.K, 1e6);
  EXPECT_EQ(s.mix.thixotropy->A_thix, 1.3);
  const auto* kinetics = std::get_if<RatePowerKinetics>(&s.mix.thixotropy->kinetics);
  ASSERT_TRUE(kinetics);
  EXPECT_EQ(kinetics->breakdown, 0.334);
  EXPECT_EQ(kinetics->rate_exponent, 0.1);
  EXPECT_FALSE(kinetics->gate());
  EXPECT_EQ(kinetics->exponent, 1.0);
  EXPECT_EQ(s.rest, 0.0);
  EXPECT_EQ(s.duration, 30.0);
  EXPECT_EQ(s.lift_speed, 0.15);
  EXPECT_TRUE(std::holds_alternative<NoSlip>(s.floor.contact));
  EXPECT_EQ(s.model.space, SpaceKind::axisymmetric);
  EXPECT_TRUE(std::holds_alternative<ExactBingham>(s.model.law));
  EXPECT_EQ(s.model.cell, (std::array{0.01, 0.005}));
  EXPECT_EQ(s.model.points_per_cell, (std::array{4, 4}));
  EXPECT_FALSE(s.model.time_step.has_value());
  EXPECT_FALSE(slump(read_text(mix_a, "a.toml")).mix.thixotropy.has_value());
}

/// The kinetics that a scene with these keys in [mix.thixotropy] has.
std::string kinetics_of(const std::string& keys, const std::vector<std::string>& overrides = {}) {
  return std::string(
      word(slump(read_text(thixotropic + keys, "a.toml", overrides)).mix.thixotropy->kinetics));
}

TEST(SceneReader, KineticsFollowFromTheirKeys) {
  EXPECT_EQ(kinetics_of(""), "rate_power");
  EXPECT_EQ(kinetics_of("destructuration = 0.03\n"), "gated");
  EXPECT_EQ(kinetics_of("destructuration = 0.03\nbreakdown_rate = \"1 1/s\"\n"), "rate_power");
  EXPECT_EQ(kinetics_of("breakdown_rate = \"1 1/s\"\n", {"mix.thixotropy.destructuration=0.03"}), "gated");
  EXPECT_EQ(kinetics_of("breakdown_rate = \"1 1/s\"\n", {"mix.thixotropy.kinetics=roussel"}), "roussel");
  EXPECT_EQ(kinetics_of("", {"preset=paper"}), "gated");
  // Who names kinetics and gives another's key in one place contradicts himself.
  EXPECT_TRUE(says(complaint(thixotropic + "kinetics = \"roussel\"\nrate_exponent = 0.2\n"),
                   {"bad.toml:8", "rate_exponent", "has no meaning with kinetics = \"roussel\""}));
  EXPECT_TRUE(says(complaint(thixotropic + "kinetics = \"power\"\n"), {"exponent", "missing key"}));
  // Who gives keys of two kinetics and names neither is told which one counts; a mix's file may hold both.
  const auto note = [](const std::string& text) {
    const auto notes = read_text(text, "a.toml").notes;
    return notes.empty() ? "" : notes.front();
  };
  EXPECT_TRUE(
      says(note(thixotropic + "destructuration = 0.03\nbreakdown_rate = \"1 1/s\"\n"),
           {"a.toml:7: mix.thixotropy.destructuration has no meaning with kinetics = \"rate_power\""}));
  EXPECT_EQ(note("apparatus = \"slump_flow\"\nmix = \"mix_a\"\n"), "");
}

TEST(SceneReader, ModesAreSharesAndFactors) {
  const auto modes = [](const std::string& value) {
    return complaint(thixotropic + "modes = " + value + "\n");
  };
  EXPECT_EQ(modes("[[0.6, 1.0], [0.4, 0.1]]"), "");
  EXPECT_TRUE(says(modes("[[0.6, 1.0], [0.6, 0.1]]"), {"modes", "sum is 1.2"}));
  EXPECT_TRUE(says(modes("[[0.0, 1.0], [1.0, 0.1]]"), {"modes", "greater than 0"}));
  EXPECT_TRUE(says(modes("[0.6, 1.0]"), {"modes", "array of pairs"}));
  EXPECT_TRUE(
      says(modes("[[0.1,1],[0.1,1],[0.1,1],[0.1,1],[0.1,1],[0.1,1],[0.4,1]]"), {"modes", "at most 6"}));
}

TEST(SceneReader, EverySceneOfTheTreeIsValid) {
  int read_scenes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(TREMIE_SCENES)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("cell")) continue;  // no apparatus: `tremie cell` reads it
    EXPECT_NO_THROW(estimate(read(entry.path()))) << entry.path();
    ++read_scenes;
  }
  EXPECT_GE(read_scenes, 13);
  EXPECT_EQ(slump(read(std::filesystem::path(TREMIE_SCENES) / "slump_flow_mix_b_rest240.toml")).rest, 240.0);
}

TEST(SceneReader, UnknownKeyNamesTheNearest) {
  EXPECT_TRUE(says(complaint(mix_a + "yield_stres = \"54 Pa\"\n"),
                   {"bad.toml:5: mix.yield_stres: unknown key", "\"yield_stress\"", "density"}));
  EXPECT_TRUE(says(complaint(mix_a + "[modle]\n"), {"bad.toml:5: modle", "\"model\""}));
  EXPECT_TRUE(says(complaint("duration = \"3 s\"\n" + mix_a), {"bad.toml:1: duration", "belongs in [test]"}));
}

// A table that is misspelt is named beside what is missing without it, and with every other fault.
TEST(SceneReader, AMisspeltTableIsNamedBesideWhatIsMissing) {
  const std::string what =
      complaint("apparatus = \"slump_flow\"\n[mixx]\nyield_stress = \"54 Pa\"\n[test]\nduration = \"3\"\n");
  EXPECT_TRUE(says(what, {"bad.toml:2: mixx: unknown key; did you mean \"mix\"?",
                          "bad.toml:1: mix: missing key", "bad.toml:5: test.duration", "\"3 s\""}));
  EXPECT_TRUE(
      says(complaint("aparatus = \"slump_flow\"\nmix = \"mix_a\"\n"),
           {"bad.toml:1: aparatus: unknown key; did you mean \"apparatus\"?", "apparatus: missing key"}));
  EXPECT_TRUE(says(complaint(mix_a + "[test]\nrest = 240\nlift_speed = 15\n"),
                   {"rest = \"240 s\"", "lift_speed = \"15 cm/s\""}));
}

TEST(SceneReader, MissingKey) {
  EXPECT_TRUE(says(complaint("apparatus = \"slump_flow\"\n[mix]\nyield_stress = \"54 Pa\"\n"),
                   {"bad.toml:2: mix.plastic_viscosity: missing key", "Pa.s"}));
  // A key that is there with a wrong value is told once, and what it would have replaced is not missed.
  EXPECT_EQ(
      complaint("apparatus = \"slump_flow\"\n[mix]\nyield_stress = \"54 Pa\"\nconsistency = \"20 Pa.s\"\n"
                "flow_index = 0.5\ndensity = \"2400 kg/m3\"\n")
          .find("missing"),
      std::string::npos);
  EXPECT_TRUE(says(complaint("apparatus = \"slump_flow\"\n"), {"bad.toml:1: mix: missing key", "mix_a"}));
  EXPECT_TRUE(says(complaint("mix = \"mix_a\"\n"), {"bad.toml:1: apparatus: missing key", "slump_flow"}));
  EXPECT_TRUE(says(complaint(mix_a + "[mix.thixotropy]\n"),
                   {"bad.toml:5: mix.thixotropy.structuration_rate: missing"}));
}

TEST(SceneReader, BareNumberShowsHowToWriteIt) {
  EXPECT_TRUE(says(complaint(mix_a + "density = 2400\n"),
                   {"bad.toml:5: mix.density: 2400 is a bare number", "density = \"2400 kg/m3\""}));
  EXPECT_TRUE(
      says(complaint(mix_a + "[test]\nrest = 240.0\n"), {"bad.toml:6: test.rest", "rest = \"240 s\""}));
}

TEST(SceneReader, WrongUnit) {
  EXPECT_TRUE(
      says(complaint(mix_a + "density = \"2400 kg\"\n"), {"bad.toml:5: mix.density", "wrong unit", "kg/m3"}));
  EXPECT_TRUE(says(complaint(mix_a + "density = \"2,4 kg/dm3\"\n"),
                   {"bad.toml:5: mix.density", "decimal comma", "2.4 kg/dm3"}));
}

TEST(SceneReader, OutOfRange) {
  EXPECT_TRUE(
      says(complaint(thixotropic, {"mix.yield_stress=-54 Pa"}), {"mix.yield_stress", "at least 0 Pa"}));
  EXPECT_TRUE(says(complaint(mix_a + "[cone]\nheight = \"0 mm\"\n"),
                   {"bad.toml:6: cone.height", "greater than 0 m"}));
  EXPECT_TRUE(
      says(complaint(mix_a + "[model]\ncell = \"0 mm\"\n"), {"bad.toml:6: model.cell", "greater than 0 m"}));
  EXPECT_TRUE(says(complaint(mix_a + "[model]\npoints_per_cell = 0\n"),
                   {"bad.toml:6: model.points_per_cell", "at least 1"}));
  EXPECT_TRUE(says(complaint(mix_a + "[model]\ncell = \"1 m\"\n"),
                   {"bad.toml:6: model.cell", "larger than the cone"}));
  EXPECT_TRUE(says(complaint(mix_a + "[model]\ncell = \"1e-9 m\"\n"), {"bad.toml:6: model.cell", "points"}));
  EXPECT_TRUE(says(complaint("schema = 2\n" + mix_a), {"bad.toml:1: schema"}));
}

TEST(SceneReader, NotANumber) {
  EXPECT_TRUE(says(complaint(mix_a + "density = \"nan kg/m3\"\n"),
                   {"bad.toml:5: mix.density", "not a finite number"}));
  EXPECT_TRUE(says(complaint(mix_a + "density = nan\n"), {"bad.toml:5: mix.density", "not a finite number"}));
  EXPECT_TRUE(says(complaint(thixotropic + "destructuration = inf\n"),
                   {"bad.toml:7: mix.thixotropy.destructuration", "not a finite number"}));
}

TEST(SceneReader, YieldStressOfZeroHasNoFlocculation) {
  EXPECT_TRUE(says(complaint(thixotropic, {"mix.yield_stress=0 Pa"}), {"mix.yield_stress", "thixotropy"}));
  EXPECT_EQ(complaint(mix_a, {"mix.yield_stress=0 Pa"}), "");
  EXPECT_EQ(complaint(thixotropic, {"mix.yield_stress=0 Pa", "mix.thixotropy=false"}), "");
}

TEST(SceneReader, Contradictions) {
  EXPECT_TRUE(says(complaint(mix_a + "[floor]\ncontact = \"no_slip\"\ncoefficient = 0.3\n"),
                   {"bad.toml:7: floor.coefficient", "friction"}));
  EXPECT_TRUE(
      says(complaint(mix_a + "[floor]\ncoefficient = 0.3\n"), {"bad.toml:6: floor.coefficient", "friction"}));
  EXPECT_TRUE(says(complaint(mix_a + "[model]\nregularisation = \"5 s\"\n"),
                   {"bad.toml:6: model.regularisation", "papanastasiou"}));
  EXPECT_TRUE(
      says(complaint(mix_a + "bulk_modulus = \"1 MPa\"\nyoungs_modulus = \"1 MPa\"\npoisson_ratio = 0.4\n"),
           {"bad.toml:5: mix.bulk_modulus", "one or the other"}));
  EXPECT_TRUE(
      says(complaint(mix_a + "poisson_ratio = 0.4\n"), {"bad.toml:5: mix.poisson_ratio", "youngs_modulus"}));
  EXPECT_TRUE(says(complaint(mix_a + "youngs_modulus = \"1 MPa\"\npoisson_ratio = 0.4999999999999999\n"),
                   {"bad.toml:6: mix.poisson_ratio", "bulk modulus", "1e+13 Pa"}));
  EXPECT_TRUE(
      says(complaint(thixotropic, {"mix.thixotropy.saturation=1", "mix.thixotropy.initial_flocculation=5"}),
           {"initial_flocculation", "at most 1"}));
}

TEST(SceneReader, EveryProblemIsTold) {
  const std::string all = complaint(mix_a + "density = 2400\ncolour = \"grey\"\n[cone]\nheight = \"3 s\"\n");
  EXPECT_TRUE(says(all, {"bad.toml:5:", "bad.toml:6:", "bad.toml:8:"}));
  EXPECT_EQ(std::count(all.begin(), all.end(), '\n'), 2);
}

TEST(SceneReader, FilesThatCannotBeRead) {
  const test::TemporaryFolder folder;
  EXPECT_THROW(read(folder / "none.toml"), InputError);
  EXPECT_THROW(read(folder.path()), InputError);
  // A table that no scene knows would be lost without a word.
  test::write_file(folder / "mine.toml",
                   "[mix]\nyield_stress = \"50 Pa\"\nplastic_viscosity = \"30 "
                   "Pa.s\"\n[thixotropy]\nstructuration_rate = \"1 Pa/s\"\n");
  EXPECT_TRUE(
      says(complaint("apparatus = \"slump_flow\"\nmix = \"" + (folder / "mine.toml").string() + "\"\n"),
           {"mine.toml:4", "thixotropy: unknown key"}));
  EXPECT_TRUE(says(complaint("apparatus = \"slump_flow\"\nmix = = 3\n"), {"bad.toml:2", "no TOML"}));
}

TEST(SceneReader, NamedMixesAndOverrides) {
  const std::string text = "apparatus = \"slump_flow\"\nmix = \"mix_a\"\n";
  EXPECT_EQ(slump(read_text(text, "a.toml", {"mix.yield_stress=61 Pa"})).mix.tau_0, 61.0);
  EXPECT_EQ(slump(read_text(text, "a.toml", {"mix.yield_stress=\"61 Pa\""})).mix.tau_0, 61.0);
  EXPECT_EQ(slump(read_text(text, "a.toml", {"mix.yield_stress=61 Pa", "mix=mix_c"})).mix.mu, 30.2);
  EXPECT_FALSE(slump(read_text(text, "a.toml", {"mix.thixotropy=false"})).mix.thixotropy.has_value());
  EXPECT_EQ(slump(read_text(text, "a.toml", {"model.cell=[5 mm, 2 mm]"})).model.cell,
            (std::array{0.005, 0.002}));
  EXPECT_EQ(slump(read_text(text, "a.toml", {"model.points_per_cell=4"})).model.points_per_cell,
            (std::array{4, 4}));
  EXPECT_FALSE(slump(read_text(text, "a.toml", {"test.lift_speed=instant"})).lift_speed.has_value());
  EXPECT_EQ(read_text(text, "a.toml").measured.slump_flow_0, 0.59);
  EXPECT_TRUE(says(complaint(text, {"mix=mix_z"}), {"--set mix=mix_z: mix", "mix_a"}));
  EXPECT_TRUE(
      says(complaint(text, {"mix.yield_stres=61 Pa"}), {"--set mix.yield_stres=61 Pa: mix.yield_stres"}));
  EXPECT_TRUE(says(complaint(text, {"mix.yield_stress"}), {"KEY=VALUE"}));
  EXPECT_TRUE(says(complaint(text, {".=3"}), {"KEY=VALUE"}));
}

TEST(SceneReader, AMixBesideTheScene) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "mine.toml",
                   "[mix]\nyield_stress = \"70 Pa\"\nplastic_viscosity = \"20 Pa.s\"\n");
  test::write_file(folder / "s.toml", "apparatus = \"slump_flow\"\nmix = \"mine.toml\"\n");
  EXPECT_EQ(slump(read(folder / "s.toml")).mix.tau_0, 70.0);
}

TEST(SceneReader, ALaterLayerDropsWhatLosesItsMeaning) {
  const std::string text = mix_a + "[floor]\ncontact = \"friction\"\ncoefficient = 0.3\n";
  const Scene scene = read_text(text, "a.toml", {"floor.contact=no_slip"});
  EXPECT_TRUE(std::holds_alternative<NoSlip>(slump(scene).floor.contact));
  ASSERT_EQ(scene.notes.size(), 1U);
  EXPECT_TRUE(says(scene.notes.front(), {"a.toml:7: floor.coefficient"}));
}

// tau_i as a stress, or as a share of the mix's yield stress; of one layer not both, and neither without contact =
// "interface", nor in explicit steps.
TEST(SceneReader, TheInterfaceHasOneYieldStress) {
  const std::string on = mix_a + "[floor]\ncontact = \"interface\"\ninterface_viscosity = \"1000 Pa.s/m\"\n";
  const std::string stress = "interface_yield_stress = \"20 Pa\"\n", ratio = "interface_yield_ratio = 0.5\n";
  const auto law = [&](const std::string& text, const std::vector<std::string>& overrides = {}) {
    return std::get<Interface>(slump(read_text(text, "a.toml", overrides)).floor.contact);
  };
  EXPECT_EQ(law(on + stress).tau_i, 20.0);
  EXPECT_EQ(law(on + stress).k_i, 1000.0);
  EXPECT_EQ(law(on + ratio).tau_i, 27.0);
  EXPECT_EQ(law(on + stress, {"floor.interface_yield_ratio=0.25"}).tau_i, 13.5);
  EXPECT_EQ(law(on + ratio, {"floor.interface_yield_stress=30 Pa"}).tau_i, 30.0);
  EXPECT_TRUE(says(complaint(on), {"bad.toml:6: floor.contact", "interface_yield_ratio"}));
  EXPECT_TRUE(says(complaint(on + stress + ratio), {"floor.interface_yield_ratio", "one or the other"}));
  EXPECT_TRUE(says(complaint(on + ratio, {"floor.interface_viscosity=-1 Pa.s/m"}), {"at least 0 Pa.s/m"}));
  EXPECT_TRUE(says(complaint(mix_a + "[floor]\n" + stress), {"floor.interface_yield_stress", "interface"}));
  EXPECT_TRUE(says(complaint(on + ratio, {"model.scheme=explicit", "model.yield=papanastasiou"}),
                   {"floor.contact", "explicit"}));
}

double friction(const cone::Scene& scene) { return std::get<Coulomb>(scene.floor.contact).coefficient; }

TEST(SceneReader, FrictionComesFromTheMix) {
  const std::string text = "apparatus = \"slump_flow\"\nmix = \"mix_b\"\n[floor]\ncontact = \"friction\"\n";
  EXPECT_EQ(friction(slump(read_text(text, "a.toml"))), 0.45);
  EXPECT_EQ(friction(slump(read_text(text, "a.toml", {"floor.coefficient=0.2"}))), 0.2);
}

TEST(SceneReader, PresetLiesUnderTheScene) {
  const std::string text = "apparatus = \"slump_flow\"\npreset = \"paper\"\nmix = \"mix_a\"\n";
  const auto paper = slump(read_text(text, "a.toml"));
  EXPECT_NEAR(paper.mix.K, 33.3e3, 100.0);
  EXPECT_EQ(paper.model.scheme, SchemeKind::explicit_usf);
  EXPECT_EQ(paper.model.shape, ShapeKind::gimp);
  EXPECT_EQ(std::get<Papanastasiou>(paper.model.law).m, 5.0);
  EXPECT_EQ(paper.model.time_step, 1e-4);
  EXPECT_EQ(paper.model.space, SpaceKind::full);
  EXPECT_EQ(paper.duration, 20.0);
  EXPECT_EQ(friction(paper), 0.35);
  const auto mine = slump(read_text(text + "[model]\nyield = \"exact\"\n[test]\nduration = \"5 s\"\n",
                                    "a.toml", {"mix.bulk_modulus=2 MPa"}));
  EXPECT_TRUE(std::holds_alternative<ExactBingham>(mine.model.law));
  EXPECT_EQ(mine.duration, 5.0);
  EXPECT_EQ(mine.mix.K, 2e6);
  EXPECT_TRUE(says(complaint(text, {"preset=papr"}), {"preset", "\"paper\""}));
}

TEST(SceneReader, EngineLimitsAreInputErrors) {
  const Scene scene =
      read_text("apparatus = \"slump_flow\"\npreset = \"paper\"\nmix = \"mix_a\"\n", "p.toml");
  const std::atomic<bool> at_once{true};  // where the engine takes the scene, the run ends before it starts
  Observer observer;
  observer.interrupted = &at_once;
  try {
    run(scene, observer);
  } catch (const InputError& error) {
    EXPECT_TRUE(says(error.what(), {"p.toml: "}));
  }
}

/// What was measured on a mix is not held against another one that bears its name.
TEST(SceneReader, AChangedMixSaysSo) {
  const std::string text = "apparatus = \"slump_flow\"\nmix = \"mix_a\"\n";
  const auto of = [&](const std::vector<std::string>& overrides) {
    return read_text(text, "a.toml", overrides);
  };
  const Scene changed = of({"mix.yield_stress=61 Pa", "mix.density=2300 kg/m3"});
  EXPECT_EQ(changed.measured.name, "Mix A with changed yield_stress, density");
  EXPECT_EQ(changed.measured.on, "Mix A");
  const Scene again = read_text(changed.resolved, "a.toml");
  EXPECT_EQ(again.measured.name, changed.measured.name);
  EXPECT_EQ(again.measured.on, "Mix A");
  const Scene twice = read_text(changed.resolved, "a.toml", {"mix.yield_stress=54 Pa"});
  EXPECT_EQ(twice.measured.name, "Mix A with changed values");
  EXPECT_EQ(of({"mix.thixotropy=false"}).measured.on, "Mix A");
  for (const char* not_of_the_concrete : {"mix.slump_flow_0=580 mm", "mix.source=ours", "test.rest=240 s"}) {
    EXPECT_EQ(of({not_of_the_concrete}).measured.name, "Mix A");
    EXPECT_EQ(of({not_of_the_concrete}).measured.on, "");
  }
  const Scene own = of({"mix.yield_stress=61 Pa", "mix.name=ours"});
  EXPECT_EQ(own.measured.name, "ours");
}

/// The resolved text of a resolved scene is the same but for its comments, and so are all values.
void expect_round_trip(const std::string& text, const std::vector<std::string>& overrides) {
  const Scene first = read_text(text, "a.toml", overrides);
  const Scene second = read_text(first.resolved, "a.toml");
  const auto &a = slump(first), &b = slump(second);
  EXPECT_EQ(a.mix.tau_0, b.mix.tau_0);
  EXPECT_EQ(a.mix.mu, b.mix.mu);
  EXPECT_EQ(a.mix.K, b.mix.K);
  EXPECT_EQ(a.rest, b.rest);
  EXPECT_EQ(a.lift_speed, b.lift_speed);
  EXPECT_EQ(a.model.cell, b.model.cell);
  EXPECT_EQ(a.model.time_step, b.model.time_step);
  EXPECT_EQ(a.model.law.index(), b.model.law.index());
  EXPECT_EQ(secant(a.model.law, 1.0, 1.0), secant(b.model.law, 1.0, 1.0));  // depends on every parameter
  EXPECT_EQ(a.floor.contact.index(), b.floor.contact.index());
  EXPECT_EQ(bears(a.floor.contact, 1.0), bears(b.floor.contact, 1.0));  // depends on every parameter
  EXPECT_EQ(first.measured.source, second.measured.source);
  const Scene third = read_text(second.resolved, "a.toml");
  EXPECT_EQ(second.resolved, third.resolved);
}

TEST(SceneReader, ResolvedScenesReadBackBitForBit) {
  expect_round_trip(thixotropic, {"mix.yield_stress=0.1234567890123456789 kPa", "test.rest=7.3 min"});
  expect_round_trip("apparatus = \"slump_flow\"\npreset = \"paper\"\nmix = \"mix_c\"\n",
                    {"model.cell=[7 mm, 3.3 mm]"});
  expect_round_trip(
      mix_a, {"test.lift_speed=instant", R"(mix.source="a \"quoted\" \\ source")", "model.time_step=1e-5 s"});
  EXPECT_TRUE(says(read_text(mix_a, "a.toml").resolved, {"# default", "schema = 1"}));
}

TEST(SceneReader, TheTemplateIsAValidScene) {
  for (const auto& apparatus : all_apparatus()) {
    if (apparatus.keys.command != "run") continue;
    const std::string text = write_template(apparatus.keys);
    EXPECT_EQ(complaint(text), "") << text;
  }
}

/// The lines of a text whose comment says "needed", and those that open sections.
std::string needed_lines(const std::string& text) {
  std::istringstream in(text);
  std::string lines;
  for (std::string line; std::getline(in, line);)
    if (line.starts_with('[') || line.starts_with("apparatus") || line.find("# needed") != std::string::npos)
      lines += line + "\n";
  return lines;
}

std::string without_comments(const std::string& text) {
  std::istringstream in(text);
  std::string lines;
  for (std::string line; std::getline(in, line);) {
    line.erase(std::min(line.find('#'), line.size()));
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) lines += line + "\n";
  }
  return lines;
}

// "Every line shows its default and may be left out": a key whose default is another kinetics' once opened a gate.
TEST(SceneReader, TheTemplateShowsTheDefaults) {
  for (const auto& apparatus : all_apparatus()) {
    if (apparatus.keys.command != "run") continue;
    const std::string text = write_template(apparatus.keys);
    EXPECT_EQ(without_comments(read_text(text, "a.toml").resolved),
              without_comments(read_text(needed_lines(text), "a.toml").resolved))
        << apparatus.keys.name;
  }
}

}  // namespace
}  // namespace tremie::scene
