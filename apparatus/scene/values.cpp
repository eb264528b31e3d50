#include "apparatus/scene/values.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "apparatus/scene/input_error.hpp"

namespace tremie::scene {

bool Values::has(std::string_view key) const { return entries.find(key) != entries.end(); }

bool Values::given(std::string_view key) const {
  const auto found = entries.find(key);
  return found != entries.end() && found->second.origin.layer != Layer::fallback;
}

bool Values::has_section(std::string_view section) const { return sections.find(section) != sections.end(); }

std::size_t Values::count(std::string_view repeated_section) const {
  std::size_t n = 0;
  while (has_section(fmt::format("{}[{}]", repeated_section, n))) ++n;
  return n;
}

const Value& Values::at(std::string_view key) const {
  const auto found = entries.find(key);
  if (found == entries.end()) throw std::logic_error(fmt::format("the scene holds no value for {}", key));
  return found->second;
}

std::vector<double> Values::numbers(std::string_view key) const { return at(key).numbers; }

double Values::number(std::string_view key) const {
  const Value& value = at(key);
  if (value.numbers.size() != 1) throw std::logic_error(fmt::format("{} is not one number", key));
  return value.numbers.front();
}

std::optional<double> Values::number_unless(std::string_view key, std::string_view word) const {
  const Value& value = at(key);
  if (!value.words.empty() && value.words.front() == word) return std::nullopt;
  return number(key);
}

std::int64_t Values::integer(std::string_view key) const { return static_cast<std::int64_t>(number(key)); }

bool Values::boolean(std::string_view key) const { return number(key) != 0.0; }

const std::string& Values::word(std::string_view key) const {
  const Value& value = at(key);
  if (value.words.empty()) throw std::logic_error(fmt::format("{} is not a word", key));
  return value.words.front();
}

void Values::fail(std::string_view key, const std::string& what) const {
  const auto found = entries.find(key);
  const bool placed = found != entries.end() && found->second.origin.layer != Layer::fallback;
  const Origin origin =
      placed ? found->second.origin : sections.find("")->second;  // a default stands nowhere
  throw InputError(fmt::format("{}: {}: {}", describe(origin), key, what));
}

void Values::set_number(std::string_view key, double value, Layer layer, const std::string& note) {
  set_numbers(key, {value}, layer, note);
}

void Values::set_numbers(std::string_view key, std::vector<double> values, Layer layer,
                         const std::string& note) {
  Value& entry = entries[std::string(key)];
  entry.numbers = std::move(values);
  entry.words.clear();
  entry.origin.layer = layer;
  entry.note = note;
}

void Values::drop(std::string_view key) {
  const auto found = entries.find(key);
  if (found != entries.end()) entries.erase(found);
}

void Values::drop_beside(std::string_view key, std::string_view decider, const std::string& why) {
  if (!has(key)) return;
  if (given(key) && layer(key) >= layer(decider)) fail(key, why);
  if (layer(key) > Layer::preset)
    notes.push_back(fmt::format("{}: {} {}", describe(at(key).origin), key, why));
  drop(key);
}

}  // namespace tremie::scene
