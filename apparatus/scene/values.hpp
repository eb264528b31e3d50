#pragma once

// The checked values of a scene, by dotted key ("mix.yield_stress"), in SI units.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "apparatus/scene/document.hpp"
#include "apparatus/scene/keys.hpp"

namespace tremie::scene {

/// One checked value. Which member is set follows from the key's kind and shape.
struct Value {
  std::vector<double> numbers;     ///< quantity (SI), number, integer, boolean (0 or 1)
  std::vector<std::string> words;  ///< choice, text, or the word in place of a quantity
  Origin origin;
  std::vector<std::string> written;  ///< a quantity's numbers with their units, as they were given
  std::string note;                  ///< why it has this value, where it was derived
};

/// Every getter throws std::logic_error for a key that the scene has no value for: ask has() first where a
/// key may not apply.
class Values {
 public:
  bool has(std::string_view key) const;    ///< has a value: given or by default
  bool given(std::string_view key) const;  ///< by the scene, a preset or --set, not by default
  bool has_section(std::string_view section) const;
  std::size_t count(std::string_view repeated_section) const;  ///< of [[name]]

  double number(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;
  std::optional<double> number_unless(std::string_view key, std::string_view word) const;
  std::int64_t integer(std::string_view key) const;
  bool boolean(std::string_view key) const;
  const std::string& word(std::string_view key) const;
  const Value& at(std::string_view key) const;
  Layer layer(std::string_view key) const { return at(key).origin.layer; }

  template <class Enum>
  Enum choice(std::string_view key, const Words<Enum>& words) const {
    const std::string& given_word = word(key);
    for (const auto& [name, value] : words)
      if (name == given_word) return value;
    fail(key, "is none of the words that the program knows");
  }

  /// Throws InputError: file, line, key, `what`.
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;

  /// For rules over several keys.
  void set_number(std::string_view key, double value, Layer layer, const std::string& note);
  void set_numbers(std::string_view key, std::vector<double> values, Layer layer, const std::string& note);
  void drop(std::string_view key);
  /// Drops what has no meaning beside `decider`: quietly where it is a default, with a note where a later
  /// layer decided; throws InputError where the decider's own layer gave it. `why` follows the key's name.
  void drop_beside(std::string_view key, std::string_view decider, const std::string& why);

  std::map<std::string, Value, std::less<>> entries;
  std::map<std::string, Origin, std::less<>> sections;  ///< those present, with the place of their header
  std::vector<std::string> notes;  ///< what the reader left out, and why: for `tremie check`
};

/// What to say of sections that the scene lacks as a whole, by their name.
using MissingSections = std::map<std::string, std::string>;

/// Checks a whole document against a schema: unknown keys, types, units, ranges, missing keys, keys that do
/// not apply; fills in the defaults. A section that is `missing` is told so, and not key by key. Throws one InputError with every problem found, a line each.
Values check(const Node& document, const Schema& schema, const MissingSections& missing = {});

}  // namespace tremie::scene
