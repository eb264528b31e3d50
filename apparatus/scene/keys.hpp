#pragma once

// What a scene may say: one Section a TOML table, one Key a line. Reading, `tremie check`, `tremie new`, the
// resolved scene and the search for the nearest key all work from these tables, so a key is described once.
//
// To add an apparatus: write a function that returns its ApparatusKeys (its own sections beside the shared
// ones of shared_keys.hpp), and read the checked values off with Values (values.hpp). For example:
//
//   Section vane{.name = "vane", .help = "The vane and its container.", .keys = {
//       {.name = "radius", .kind = Kind::quantity, .dimension = Dimension::length, .range = positive,
//        .fallback = "63.5 mm", .help = "of the blades' tips"},
//       {.name = "blades", .kind = Kind::integer, .range = between(2, 12), .fallback = "4", .help = "number
//       of blades"}}};
//
//   double radius = values.number("vane.radius");   // metres, checked
//
// A repeated table [[history]] is a Section with `repeated`; its values are history[0].duration and so on,
// for i below values.count("history"). A key of the same name at the top ("history = \"file.csv\"") is taken
// where it is no table. Load such a scene with load({path, overrides}, {{my_keys()}}) (load.hpp), without the
// registry of apparatus.

#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "apparatus/scene/units.hpp"

namespace tremie::scene {

class Values;

enum class Kind {
  quantity,  ///< a string with a unit
  number,    ///< a plain finite number
  integer,
  boolean,
  choice,  ///< one of `words`
  text
};

enum class Shape {
  one,
  one_or_two,  ///< a value, or [across, up]
  list,        ///< an array of at least one
  pairs        ///< an array of at least one [first, second]
};

/// Values allowed, SI. The ends belong to it unless `open`.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
};

inline constexpr Range any{};
inline constexpr Range positive{.low = 0.0, .low_open = true};
inline constexpr Range not_negative{.low = 0.0};
constexpr Range between(double low, double high) { return {.low = low, .high = high}; }

/// A key that has a meaning only where another key of the same section has one of these words.
struct Condition {
  std::string key;
  std::vector<std::string> words;
};

struct Key {
  std::string name = {};
  Kind kind = Kind::quantity;
  Dimension dimension = Dimension::length;  ///< kind = quantity alone
  Range range = any;
  std::vector<std::string> words =
      {};  ///< choice: all there are; quantity: taken in place of one ("instant")
  Shape shape = Shape::one;
  std::string fallback = {};     ///< the default as in TOML, without the quotes of a string; empty: none
  bool required = false;         ///< where the section is there and `only_with` holds
  std::string needed_with = {};  ///< required beside this key of the section, and only there
  std::vector<std::string> needed_without =
      {};  ///< `required`, but not beside one of these keys of the section
  std::optional<Condition> only_with = {};
  /// The word in place of `fallback` where a scene gives one of these keys (full names): that of the latest layer, then
  /// the first. Keys that do not go with a word so chosen are left out.
  std::vector<std::pair<std::string, std::string>> implied_by = {};
  std::string example = {};  ///< for `tremie new`, where there is no default
  bool varies = false;       ///< another key decides on the default: `tremie new` leaves it off
  std::string help = {};
};

struct Section {
  std::string name = {};  ///< dotted, "mix.thixotropy"; "" is the top of the file
  std::string help = {};
  std::vector<Key> keys = {};
  bool optional = false;  ///< absent unless the scene gives it; `name = false` drops it
  bool repeated = false;  ///< [[name]]: its values are called name[0].key, name[1].key, …
};

using Schema = std::vector<Section>;

/// The sections of several schemas, in their order.
Schema joined(std::initializer_list<Schema> parts);

/// A named set of values under the scene's own.
struct Preset {
  std::string name;
  std::string toml;
};

/// All that the reader must know of one apparatus.
struct ApparatusKeys {
  std::string name;  ///< the scene's `apparatus = `
  std::string help;
  Schema schema;  ///< its sections; a first one without a name adds keys to the top of the file
  std::vector<Preset> presets = {};
  /// Rules over several keys: derive, drop, or fail. May be empty.
  std::function<void(Values&)> settle;
  std::string command = "run";  ///< the command of tremie that runs it
};

/// "greater than 0 Pa": a range in words, in the key's unit.
std::string range_text(const Key& key);

bool contains(const Range& range, double value);

/// The word of which `word` is a part, else the nearest by edit distance; empty where none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& words);
/// "; did you mean \"spread\"?", or "." where no word is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& words);
/// " (nearest: \"spread\")", or nothing.
std::string nearest_in_brackets(std::string_view word, const std::vector<std::string>& words,
                                const char* quote = "\"");

const Section* find_section(const Schema& schema, std::string_view name);
const Key* find_key(const Section& section, std::string_view name);

/// The words of an enumeration, for a key's `words` and for Values::choice.
template <class Enum>
using Words = std::vector<std::pair<std::string, Enum>>;

template <class Enum>
std::vector<std::string> names(const Words<Enum>& words) {
  std::vector<std::string> result;
  for (const auto& [name, value] : words) result.push_back(name);
  return result;
}

}  // namespace tremie::scene
