#include "apparatus/common/law_keys.hpp"

#include <optional>

namespace tremie::scene {
namespace {

constexpr std::string_view plastic_viscosity = "mix.plastic_viscosity";

Key* find(std::vector<Key>& keys, const std::string& name) {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const Key& k) { return k.name == name; });
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> law_words() {
  std::vector<std::string> words;
  for_each_law([&](const auto& law) { add_once(words, std::string(law.word)); });
  return words;
}

/// The keys of [mix] that stand in place of plastic_viscosity, each once: the first of a law decides for the others.
std::vector<std::string> mix_keys_of_laws() {
  std::vector<std::string> keys;
  for_each_law([&](const auto& law) {
    for (const auto& key : law.keys())
      if (section_of(key.name) == "mix") add_once(keys, std::string(key.name));
  });
  return keys;
}

/// Whether the scene has just the keys of [mix] that the law asks for, and none of another law.
template <class L>
bool has_its_mix_keys(const Values& values, const L& law) {
  const auto keys = law.keys();
  const auto asks_for = [&](const std::string& name) {
    return std::any_of(keys.begin(), keys.end(), [&](const auto& key) { return key.name == name; });
  };
  const std::vector<std::string> of_laws = mix_keys_of_laws();
  return law.viscous != values.has(plastic_viscosity) &&
         std::all_of(of_laws.begin(), of_laws.end(),
                     [&](const std::string& name) { return values.has(name) == asks_for(name); });
}

}  // namespace

std::vector<Key> law_model_keys() {
  std::vector<Key> keys{
      {.name = "yield", .kind = Kind::choice, .words = law_words(), .fallback = law_words().front()}};
  for_each_law([&](const auto& law) {
    for (const auto& of_law : law.keys()) {
      if (section_of(of_law.name) != "model") continue;
      if (!find(keys, name_of(of_law.name))) {
        keys.push_back(scene_key(of_law));
        keys.back().only_with = Condition{"yield", {}};
      }
      add_once(find(keys, name_of(of_law.name))->only_with->words, std::string(law.word));
    }
  });
  return keys;
}

std::vector<Key> viscosity_keys() {
  std::vector<Key> keys{{.name = name_of(plastic_viscosity),
                         .dimension = Dimension::viscosity,
                         .range = positive,
                         .required = true,
                         .example = "35.8 Pa.s",
                         .help = "mu"}};
  for_each_law([&](const auto& law) {
    std::string first;
    for (const auto& of_law : law.keys()) {
      if (section_of(of_law.name) != "mix" || find(keys, name_of(of_law.name))) continue;
      keys.push_back(scene_key(of_law));
      keys.back().needed_with = first;
      if (!first.empty()) continue;
      first = keys.back().name;
      add_once(keys.front().needed_without, first);
    }
  });
  return keys;
}

void settle_law(Values& values) {
  const std::vector<std::string> others = mix_keys_of_laws();
  std::optional<std::string> other;
  for (const std::string& key : others)
    if (!other && values.has(key)) other = key;
  if (other && values.has(plastic_viscosity)) {
    if (values.layer(plastic_viscosity) > values.layer(*other)) {
      for (const std::string& key : others)
        values.drop_beside(key, plastic_viscosity,
                           "has no meaning beside plastic_viscosity; give one or the other");
    } else {
      values.drop_beside(plastic_viscosity, *other,
                         "has no meaning beside " + name_of(*other) + "; give one or the other");
    }
  }
  if (!values.has("model.yield")) return;
  std::string allowed;
  bool found = false;
  for_each_law([&](const auto& law) {
    if (!has_its_mix_keys(values, law)) return;
    allowed += (allowed.empty() ? "\"" : ", \"") + std::string(law.word) + "\"";
    found = found || law.word == values.word("model.yield");
  });
  if (allowed.empty() && other)
    values.fail(*other, "stands beside keys of another law; give those of one");
  else if (!found)
    values.fail("model.yield", "\"" + values.word("model.yield") + "\" does not go with " +
                                   (other ? *other : std::string(plastic_viscosity)) +
                                   "; allowed: " + allowed);
}

YieldLaw read_law(const Values& values) {
  YieldLaw read;
  for_each_law([&](auto law) {
    if (law.word != values.word("model.yield") || !has_its_mix_keys(values, law)) return;
    for (const auto& key : law.keys()) law.*key.member = values.number(key.name);
    read = law;
  });
  return read;
}

std::vector<Key> contact_keys(bool friction) {
  std::vector<Key> keys{{.name = "contact", .kind = Kind::choice}};
  for_each_wall_law([&](const auto& law) {
    if (law.follows_pressure && !friction) return;
    keys.front().words.emplace_back(law.word);
    for (const auto& of_law : law.keys()) {
      keys.push_back(scene_key(of_law));
      keys.back().required = of_law.fallback.empty() && !of_law.optional;
      keys.back().only_with = Condition{"contact", {law.word}};
    }
  });
  keys.push_back({.name = "interface_yield_ratio",
                  .kind = Kind::number,
                  .range = between(0.0, 100.0),
                  .only_with = Condition{"contact", {Interface::word}},
                  .example = "0.5",
                  .help = "in place of interface_yield_stress: tau_i over the mix's yield_stress"});
  keys.front().fallback = keys.front().words.front();
  return keys;
}

void settle_interface(Values& values, const std::string& section) {
  const std::string contact = section + ".contact", stress = section + ".interface_yield_stress",
                    ratio = section + ".interface_yield_ratio";
  if (values.word(contact) != Interface::word) return;
  if (values.has("model.scheme") && values.word("model.scheme") != "implicit")
    values.fail(
        contact,
        "explicit steps do not know \"interface\", whose stress acts on the area that is wetted; give "
        "model.scheme = \"implicit\" or another contact");
  if (!values.has(stress) && !values.has(ratio))
    values.fail(contact,
                "\"interface\" needs interface_yield_stress beside it, like interface_yield_stress = "
                "\"27 Pa\", or interface_yield_ratio = 0.5");
  if (!values.has(ratio)) return;
  if (values.has(stress) && values.layer(stress) >= values.layer(ratio)) {
    values.drop_beside(ratio, stress, "has no meaning beside interface_yield_stress; give one or the other");
    return;
  }
  values.set_number(stress, values.number(ratio) * values.number("mix.yield_stress"), values.layer(ratio),
                    "interface_yield_ratio = " + write_number(values.number(ratio)) + " of mix.yield_stress");
  values.drop(ratio);
}

WallLaw read_wall_law(const Values& values, const std::string& section) {
  WallLaw read;
  for_each_wall_law([&](auto law) {
    if (law.word != values.word(section + ".contact")) return;
    for (const auto& key : law.keys()) law.*key.member = values.number(section + "." + name_of(key.name));
    read = law;
  });
  return read;
}

}  // namespace tremie::scene
