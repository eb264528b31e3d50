#include "apparatus/scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tremie::scene {
namespace {

std::string amount(const Key& key, double value) {
  return key.kind == Kind::quantity ? write_quantity(value, key.dimension) : write_number(value);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0]++;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

Schema joined(std::initializer_list<Schema> parts) {
  Schema schema;
  for (const Schema& part : parts) schema.insert(schema.end(), part.begin(), part.end());
  return schema;
}

bool contains(const Range& range, double value) {
  const bool above = range.low_open ? value > range.low : value >= range.low;
  const bool below = range.high_open ? value < range.high : value <= range.high;
  return above && below;
}

std::string range_text(const Key& key) {
  const Range& range = key.range;
  const bool low = std::isfinite(range.low), high = std::isfinite(range.high);
  const auto below = range.high_open ? "less than " : "at most ";
  std::string text;
  if (low) text += (range.low_open ? "greater than " : "at least ") + amount(key, range.low);
  if (high) text += (low ? " and " : "") + std::string(below) + amount(key, range.high);
  return text;
}

std::string nearest(std::string_view word, const std::vector<std::string>& words) {
  // A word of which the given one is a part ("vane" of "icar_vane") is meant more often than one of like letters.
  const auto distance = [&](const std::string& of) {
    return word.size() > 2 && of.find(word) != std::string::npos ? 0 : edit_distance(word, of);
  };
  const auto closer = [&](const std::string& a, const std::string& b) { return distance(a) < distance(b); };
  const auto found = std::min_element(words.begin(), words.end(), closer);
  // Words that differ in more than a third of the letters have no spelling in common.
  const bool is_near = found != words.end() && distance(*found) <= std::max<std::size_t>(2, word.size() / 3);
  return is_near ? *found : std::string{};
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& words) {
  const std::string near = nearest(word, words);
  return near.empty() ? "." : fmt::format("; did you mean \"{}\"?", near);
}

std::string nearest_in_brackets(std::string_view word, const std::vector<std::string>& words,
                                const char* quote) {
  const std::string near = nearest(word, words);
  return near.empty() ? near : fmt::format(" (nearest: {}{}{})", quote, near, quote);
}

const Section* find_section(const Schema& schema, std::string_view name) {
  const auto found =
      std::find_if(schema.begin(), schema.end(), [&](const Section& s) { return s.name == name; });
  return found == schema.end() ? nullptr : &*found;
}

const Key* find_key(const Section& section, std::string_view name) {
  const auto found =
      std::find_if(section.keys.begin(), section.keys.end(), [&](const Key& k) { return k.name == name; });
  return found == section.keys.end() ? nullptr : &*found;
}

}  // namespace tremie::scene
