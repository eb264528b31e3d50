#include "apparatus/common/thixotropy_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "apparatus/common/law_keys.hpp"

namespace tremie::scene {
namespace {

template <class K>
bool is_needed(const LawKey<K>& key) {
  return key.fallback.empty() && !key.optional;
}

/// The keys that kinetics state, each once with the words of those that have it. Where all have it, it has no condition.
std::vector<Key> kinetics_keys() {
  std::vector<Key> keys;
  for_each_kinetics([&](const auto& kinetics) {
    for (const auto& stated : kinetics.keys()) {
      Key key = scene_key(stated);
      key.required = is_needed(stated);
      key.only_with = Condition{"kinetics", {}};
      auto known = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == key.name; });
      if (known == keys.end())
        known = keys.insert(keys.end(), key);
      else if (known->help.find(key.help) == std::string::npos)
        known->help += fmt::format("; {}: {}", kinetics.word, key.help);
      known->required = known->required && key.required;
      known->varies = known->varies || stated.optional;
      known->only_with->words.emplace_back(kinetics.word);
    }
  });
  for (Key& key : keys)
    if (key.only_with->words.size() == kinetics_words().size()) key.only_with.reset();
  return keys;
}

constexpr const char* modes_key = "mix.thixotropy.modes";
constexpr const char* layer_key = "mix.thixotropy.layer";

void check_modes(const Values& values) {
  if (!values.has(modes_key)) return;
  const std::vector<double> numbers = values.numbers(modes_key);
  if (numbers.size() > 2 * RatePowerKinetics::most_modes)
    values.fail(modes_key, fmt::format("has {} modes; allowed: at most {}", numbers.size() / 2,
                                       RatePowerKinetics::most_modes));
  double sum = 0.0;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (!(numbers[i] > 0.0)) values.fail(modes_key, "has a share of 0; allowed: shares greater than 0");
    sum += numbers[i];
  }
  if (std::abs(sum - 1.0) > 1e-6)
    values.fail(modes_key, fmt::format("has shares whose sum is {:.6g}; allowed: a sum of 1", sum));
}

}  // namespace

Section thixotropy_section() {
  const Key structuration{.name = "structuration_rate",
                          .dimension = Dimension::structuration,
                          .range = not_negative,
                          .required = true,
                          .example = "1.3 Pa/s",
                          .help = "A_thix, at rest"};
  const Key choice{.name = "kinetics",
                   .kind = Kind::choice,
                   .words = kinetics_words(),
                   .fallback = std::string(RatePowerKinetics::word),
                   .implied_by = {{"preset", std::string(GatedKinetics::word)},
                                  {"mix.thixotropy.breakdown_rate", std::string(RatePowerKinetics::word)},
                                  {"mix.thixotropy.destructuration", std::string(GatedKinetics::word)}},
                   .help = "by the keys that are given; see docs/theory/flocculation.md"};
  const Key initial{.name = "initial_flocculation",
                    .kind = Kind::number,
                    .range = not_negative,
                    .fallback = "0",
                    .help = "lambda before the rest"};
  std::vector<Key> keys{structuration};
  const std::vector<Key> of_kinetics = kinetics_keys();
  for (const Key& key : of_kinetics)
    if (!key.only_with) keys.push_back(key);
  keys.push_back(choice);
  for (const Key& key : of_kinetics)
    if (key.only_with) keys.push_back(key);
  keys.push_back(
      {.name = "modes",
       .kind = Kind::number,
       .range = not_negative,
       .shape = Shape::pairs,
       .only_with = Condition{"kinetics", {std::string(RatePowerKinetics::word)}},
       .example = "[[0.6, 1.0], [0.3, 0.1], [0.1, 0.01]]",
       .help =
           "[share, factor] of each mode: share of lambda and of A_thix, factor on k; one mode if left out"});
  keys.push_back({.name = "layer",
                  .range = positive,
                  .example = "5 mm",
                  .help = "a grain: structure breaks down by the mean shear rate over this length; icar_vane "
                          "alone"});
  keys.push_back(initial);
  return {.name = "mix.thixotropy",
          .help =
              "Thixotropy; these are Mix A's numbers. Leave the table out, and no flocculation is stored or "
              "computed.",
          .keys = keys,
          .optional = true};
}

void settle_thixotropy(Values& values, bool layer_has_meaning) {
  if (!values.has_section("mix.thixotropy")) return;
  for_each_kinetics([&](const auto& kinetics) {
    if (kinetics.word != values.word("mix.thixotropy.kinetics")) return;
    for (const auto& key : kinetics.keys())
      if (key.optional && values.has(key.name) && !values.given(key.name))
        values.drop(key.name);
      else if (is_needed(key) && !values.has(key.name))
        values.fail(key.name, fmt::format("missing key with kinetics = \"{}\", like {} = {}", kinetics.word,
                                          name_of(key.name), key.example));
  });
  check_modes(values);
  const char *most = "mix.thixotropy.saturation", *at_first = "mix.thixotropy.initial_flocculation";
  if (values.has(most) && values.number(at_first) > values.number(most))
    values.fail(at_first, fmt::format("is above saturation; allowed: at most {:g}", values.number(most)));
  if (values.has(layer_key) && !layer_has_meaning)
    values.fail(layer_key,
                "is a length over which the shear rate varies; allowed in apparatus = \"icar_vane\" alone, "
                "which follows it between vane and container; leave it out here");
  if (values.number("mix.yield_stress") == 0.0)
    values.fail("mix.yield_stress",
                "is 0 with [mix.thixotropy]: the flocculation state grows by A_thix/tau_0 and has no value; "
                "give a yield stress greater than 0 Pa, or leave [mix.thixotropy] out (thixotropy = false)");
}

std::optional<Thixotropy> read_thixotropy(const Values& values) {
  if (!values.has_section("mix.thixotropy")) return std::nullopt;
  Thixotropy t{.A_thix = values.number("mix.thixotropy.structuration_rate"),
               .initial_flocculation = values.number("mix.thixotropy.initial_flocculation"),
               .layer = values.has(layer_key) ? values.number(layer_key) : 0.0};
  for_each_kinetics([&](auto kinetics) {
    if (kinetics.word != values.word("mix.thixotropy.kinetics")) return;
    for (const auto& key : kinetics.keys())
      if (values.has(key.name)) kinetics.*key.member = values.number(key.name);
    if constexpr (requires { kinetics.modes; })
      if (values.has(modes_key)) {
        const std::vector<double> numbers = values.numbers(modes_key);
        for (std::size_t i = 0; i + 1 < numbers.size(); i += 2)
          kinetics.modes.push_back({numbers[i], numbers[i + 1]});
      }
    t.kinetics = kinetics;
  });
  return t;
}

}  // namespace tremie::scene
