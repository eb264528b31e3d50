// The one place where a document meets its schema.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <stdexcept>

#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/values.hpp"

namespace tremie::scene {
namespace {

std::string join(const std::vector<std::string>& words, const char* quote = "\"") {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + (quote + word) + quote;
  return text;
}

std::string dotted(std::string_view section, std::string_view key) {
  return section.empty() ? std::string(key) : fmt::format("{}.{}", section, key);
}

/// A problem of one value, without file, line and key: the caller knows those.
using Problem = std::invalid_argument;

std::string allowed_text(const Key& key) {
  std::string text;
  if (!key.words.empty()) text = join(key.words);
  if (key.kind == Kind::quantity)
    text += (text.empty() ? "" : " or ") + ("a quantity in " + units_text(key.dimension));
  if (key.kind == Kind::number) text = "a number";
  if (key.kind == Kind::integer) text = "a whole number";
  if (key.kind == Kind::boolean) text = "true or false";
  if (key.kind == Kind::text) text = "a string";
  const std::string range = range_text(key);
  return range.empty() ? text : text + ", " + range;
}

/// The sizes that a quantity other than 0 may have, in SI: some orders of magnitude beyond all concretes and tests, and
/// well within what can be computed with.
Range sizes_of(Dimension dimension) {
  static const std::map<Dimension, Range> sizes{
      {Dimension::length, between(1e-9, 1e2)},    {Dimension::time, between(1e-9, 1e9)},
      {Dimension::speed, between(1e-9, 1e3)},     {Dimension::pressure, between(1e-9, 1e13)},
      {Dimension::density, between(1e-3, 1e6)},   {Dimension::rate, between(1e-12, 1e6)},
      {Dimension::rotation, between(1e-12, 1e6)}, {Dimension::angle, between(0.0, 1e6)}};
  const auto found = sizes.find(dimension);
  return found == sizes.end() ? between(1e-12, 1e9) : found->second;
}

void check_size(const Key& key, double value, const std::string& written) {
  const Range sizes = key.kind == Kind::quantity ? sizes_of(key.dimension) : between(0.0, 1e9);
  if (value == 0.0 || contains(sizes, std::abs(value))) return;
  const auto amount = [&](double size) {
    return key.kind == Kind::quantity ? write_quantity(size, key.dimension) : write_number(size);
  };
  throw Problem(std::abs(value) < sizes.low
                    ? fmt::format("{} is too small to be computed with; allowed: at least {}", written,
                                  amount(sizes.low))
                    : fmt::format("{} is too large to be computed with; allowed: at most {}", written,
                                  amount(sizes.high)));
}

void check_range(const Key& key, double value, const std::string& written) {
  if (!std::isfinite(value))
    throw Problem(fmt::format("{} is not a finite number; allowed: {}", written, allowed_text(key)));
  if (!contains(key.range, value))
    throw Problem(fmt::format("{} is out of range; it must be {}", written, range_text(key)));
  check_size(key, value, written);
}

/// Whether a value could stand under the key.
std::function<bool(double)> sensible(const Key& key) {
  return [&key](double value) {
    return contains(key.range, value) && (value == 0.0 || contains(sizes_of(key.dimension), std::abs(value)));
  };
}

/// A range where one value is asked for: what runs over ranges.
std::string range_hint(const Key& key, const std::string& text) {
  for (const char* mark : {"..", "±", "+-", "+/-", " to ", "…"})
    if (text.find(mark) != std::string::npos)
      return fmt::format(
          "; a scene has one value, tremie study runs it over a range: [[factor]] with key = \"….{}\" and "
          "range = [\"…\", \"…\"]",
          key.name);
  return {};
}

bool is_word(const Key& key, const std::string& text) {
  return std::find(key.words.begin(), key.words.end(), text) != key.words.end();
}

void read_text(const Key& key, const std::string& text, Value& into) {
  if (key.kind == Kind::text || is_word(key, text)) {
    into.words.push_back(text);
  } else if (key.kind == Kind::choice) {
    const std::string near = nearest_in_brackets(text, key.words);
    throw Problem(fmt::format("\"{}\" is not allowed; allowed: {}{}", text, join(key.words),
                              near.empty() && !key.help.empty() ? " (" + key.help + ")" : near));
  } else if (key.kind == Kind::quantity) {
    std::string words = key.words.empty() ? "" : " or " + join(key.words);
    double value = 0.0;
    try {
      value = parse_quantity(text, key.dimension, sensible(key));
    } catch (const std::invalid_argument& error) {
      throw Problem(error.what() + words + range_hint(key, text));
    }
    check_range(key, value, "\"" + text + "\"");
    into.numbers.push_back(value);
    into.written.push_back(text);
  } else {
    throw Problem(fmt::format("\"{}\" is a string; allowed: {} without quotes", text, allowed_text(key)));
  }
}

void read_bare_number(const Key& key, double value, bool whole, Value& into) {
  const std::string written = write_number(value);
  if (!std::isfinite(value)) check_range(key, value, written);
  if (key.kind == Kind::quantity) {
    throw Problem(fmt::format(
        "{0} is a bare number; write it with a unit, as a string: {1} = \"{0} {2}\" (units: {3})", written,
        key.name, unit_meant(value, key.dimension, sensible(key)), units_text(key.dimension)));
  }
  const bool fits = key.kind == Kind::number || (key.kind == Kind::integer && whole);
  if (!fits) throw Problem(fmt::format("{} is not allowed; allowed: {}", written, allowed_text(key)));
  check_range(key, value, written);
  into.numbers.push_back(value);
}

void read_scalar(const Key& key, const Node& node, Value& into) {
  if (const auto* text = std::get_if<std::string>(&node.value)) return read_text(key, *text, into);
  if (const auto* whole = std::get_if<std::int64_t>(&node.value))
    return read_bare_number(key, static_cast<double>(*whole), true, into);
  if (const auto* number = std::get_if<double>(&node.value))
    return read_bare_number(key, *number, false, into);
  const auto* boolean = std::get_if<bool>(&node.value);
  if (!boolean || key.kind != Kind::boolean)
    throw Problem("has the wrong type; allowed: " + allowed_text(key));
  into.numbers.push_back(*boolean ? 1.0 : 0.0);
}

Value read_pairs(const Key& key, const Node& node) {
  const auto fail = [&] { throw Problem("must be an array of pairs, like " + key.example); };
  Value value;
  value.origin = node.origin;
  const auto* array = std::get_if<Array>(&node.value);
  if (!array || array->empty()) fail();
  for (const Node& element : *array) {
    const auto* pair = std::get_if<Array>(&element.value);
    if (!pair || pair->size() != 2) fail();
    for (const Node& number : *pair) read_scalar(key, number, value);
  }
  return value;
}

Value read_value(const Key& key, const Node& node) {
  Value value{{}, {}, node.origin, {}, {}};
  const auto* array = std::get_if<Array>(&node.value);
  if (key.shape == Shape::pairs) return read_pairs(key, node);
  if (!array) {
    if (key.shape == Shape::list)
      throw Problem("must be an array, like [\"…\", \"…\"], of " + allowed_text(key));
    read_scalar(key, node, value);
    return value;
  }
  if (key.shape == Shape::one) throw Problem("is an array; allowed: " + allowed_text(key));
  if (key.shape == Shape::one_or_two && array->size() != 2)
    throw Problem(fmt::format("has {} entries; allowed: one value, or two as [across, up]", array->size()));
  if (array->empty()) throw Problem("is empty; allowed: an array of " + allowed_text(key));
  for (const Node& element : *array) read_scalar(key, element, value);
  return value;
}

/// Walks a document and gathers values and problems.
class Checker {
 public:
  Checker(const Schema& schema, const MissingSections& missing) : schema_(schema), missing_(missing) {}

  Values run(const Node& document) {
    visit(document, "", "");
    for (const auto& [name, problem] : missing_) report(document.origin, name, problem);
    add_sections_that_are_always_there(document.origin);
    for (const auto& [name, origin] : values_.sections) choose_implied(name);
    for (const auto& [name, origin] : std::map(values_.sections)) complete(name, origin);
    drop_what_does_not_apply();
    if (problems_.empty()) return std::move(values_);
    std::string all;
    const std::size_t shown = std::min(problems_.size(), most_shown);
    for (std::size_t i = 0; i < shown; ++i) all += (i == 0 ? "" : "\n") + problems_[i];
    if (shown < problems_.size()) all += fmt::format("\n… and {} more", problems_.size() - shown);
    throw InputError(all);
  }

 private:
  static constexpr std::size_t most_shown = 20;

  /// `name` is the section as in the schema, `place` as in the values ("history[2]" for a repeated one).
  void visit(const Node& table, const std::string& name, const std::string& place) {
    values_.sections[place] = table.origin;
    for (const auto& [key, node] : std::get<Table>(table.value)) visit_member(key, node, name, place);
  }

  static std::string parent_of(const Section& section) {
    const auto dot = section.name.rfind('.');
    return dot == std::string::npos ? "" : section.name.substr(0, dot);
  }

  void add_sections_that_are_always_there(const Origin& origin) {
    for (const Section& section : schema_)
      if (!section.optional && !section.repeated && values_.has_section(parent_of(section)) &&
          !missing_.contains(section.name))
        values_.sections.try_emplace(section.name, origin);
  }

  void visit_member(const std::string& key, const Node& node, const std::string& name,
                    const std::string& place) {
    const Section* child = find_section(schema_, dotted(name, key));
    const Key* known = find_key(*find_section(schema_, name), key);
    const bool structured =
        std::holds_alternative<Table>(node.value) || std::holds_alternative<Array>(node.value);
    if (child && (structured || !known)) return visit_section(*child, key, node, place);
    if (!known) return unknown(key, node, name, place);
    try {
      values_.entries[dotted(place, key)] = read_value(*known, node);
    } catch (const Problem& problem) {
      report(node.origin, dotted(place, key), problem.what());
      refused_.insert(dotted(place, key));
    }
  }

  void visit_section(const Section& section, const std::string& key, const Node& node,
                     const std::string& place) {
    const auto* off = std::get_if<bool>(&node.value);
    if (section.optional && off && !*off) return;  // "thixotropy = false" leaves the table out
    const auto* array = std::get_if<Array>(&node.value);
    const bool is_table = std::holds_alternative<Table>(node.value);
    if (section.repeated && array) {
      std::size_t i = 0;
      for (const Node& element : *array) {
        const std::string where = fmt::format("{}[{}]", dotted(place, key), i++);
        if (std::holds_alternative<Table>(element.value))
          visit(element, section.name, where);
        else
          report(element.origin, where, "must be a table [[" + section.name + "]]");
      }
    } else if (!section.repeated && is_table) {
      visit(node, section.name, dotted(place, key));
    } else {
      const auto wanted = section.repeated ? "[[" + section.name + "]]" : "[" + section.name + "]";
      report(node.origin, dotted(place, key), "must be a table " + wanted);
    }
  }

  void unknown(const std::string& key, const Node& node, const std::string& name, const std::string& place) {
    std::vector<std::string> allowed;
    for (const auto& k : find_section(schema_, name)->keys) allowed.push_back(k.name);
    for (const auto& section : schema_)
      if (!section.name.empty() && parent_of(section) == name)
        allowed.push_back(section.name.substr(name.empty() ? 0 : name.size() + 1));
    std::string hint = did_you_mean(key, allowed);
    for (const auto& section : schema_)
      if (section.name != name && find_key(section, key))
        hint = section.name.empty() ? "; it belongs at the top of the file."
                                    : fmt::format("; it belongs in [{}].", section.name);
    const auto where = name.empty() ? "at the top of a scene" : "in [" + name + "]";
    report(node.origin, dotted(place, key),
           fmt::format("unknown key{} Allowed {}: {}", hint, where, join(allowed, "")));
  }

  /// Words that other keys of the scene imply, where it gives none.
  void choose_implied(const std::string& place) {
    for (const Key& key : find_section(schema_, place.substr(0, place.find('[')))->keys) {
      if (values_.has(dotted(place, key.name)) || reported(dotted(place, key.name))) continue;
      const std::pair<std::string, std::string>* chosen = nullptr;
      for (const auto& implied : key.implied_by)
        if (values_.has(implied.first) &&
            (!chosen || values_.layer(implied.first) > values_.layer(chosen->first)))
          chosen = &implied;
      if (!chosen) continue;
      Value value;
      value.words = {chosen->second};
      value.note = "by " + chosen->first;
      value.origin.layer = Layer::fallback;
      values_.entries[dotted(place, key.name)] = value;
    }
  }

  /// Defaults, and keys that are missing, in one section that is there.
  void complete(const std::string& place, const Origin& origin) {
    const std::string name = place.substr(0, place.find('['));
    for (const Key& key : find_section(schema_, name)->keys) {
      const std::string full = dotted(place, key.name);
      if (values_.has(full) || reported(full)) continue;
      if (!key.fallback.empty())
        values_.entries[full] = default_of(key);
      else if (is_needed(key, place))
        missing(key, full, origin_of_need(key, place, origin));
    }
  }

  /// Where the key stands that asks for this one, else where its section does.
  Origin origin_of_need(const Key& key, const std::string& place, const Origin& section) const {
    const auto asks = values_.entries.find(dotted(place, key.needed_with));
    return key.needed_with.empty() || asks == values_.entries.end() ? section : asks->second.origin;
  }

  /// Whether a scene that leaves the key out is incomplete. What another key of the section decides was read before.
  bool is_needed(const Key& key, const std::string& place) const {
    const auto there = [&](const std::string& name) {
      return !name.empty() && (values_.has(dotted(place, name)) || refused_.contains(dotted(place, name)));
    };
    if (there(key.needed_with)) return true;
    return key.required && applies(key, place) &&
           std::none_of(key.needed_without.begin(), key.needed_without.end(), there);
  }

  static Value default_of(const Key& key) {
    const bool quoted = key.kind == Kind::quantity || key.kind == Kind::choice || key.kind == Kind::text;
    const bool bare = key.fallback.starts_with('[') || !quoted;
    const std::string text = "value = " + (bare ? key.fallback : '"' + key.fallback + '"');
    const Node node = parse_text(text, "default", Layer::fallback);
    return read_value(key, *find(node, "value"));
  }

  void missing(const Key& key, const std::string& full, const Origin& origin) {
    const bool bare = key.kind == Kind::number || key.kind == Kind::integer || key.kind == Kind::boolean;
    const std::string quote = bare ? "" : "\"";
    const std::string example =
        key.example.empty() ? "" : fmt::format(", like {} = {}{}{}", key.name, quote, key.example, quote);
    const std::string when =
        !key.needed_with.empty() ? fmt::format(" beside {}", key.needed_with)
        : key.only_with ? fmt::format(" with {} = {}", key.only_with->key, join(key.only_with->words))
                        : "";
    report(origin, full, fmt::format("missing key{}; allowed: {}{}", when, allowed_text(key), example));
  }

  bool applies(const Key& key, const std::string& place) const {
    if (!key.only_with) return true;
    const auto found = values_.entries.find(dotted(place, key.only_with->key));
    if (found == values_.entries.end() || found->second.words.empty()) return true;  // reported already
    const auto& words = key.only_with->words;
    return std::find(words.begin(), words.end(), found->second.words.front()) != words.end();
  }

  /// A default or a value that a later layer made meaningless goes quietly; a contradiction within a layer is
  /// a fault.
  void drop_what_does_not_apply() {
    for (const auto& [place, origin] : values_.sections) {
      for (const Key& key : find_section(schema_, place.substr(0, place.find('[')))->keys) {
        const std::string full = dotted(place, key.name);
        if (!values_.has(full) || applies(key, place)) continue;
        const Value& decider = values_.at(dotted(place, key.only_with->key));
        const Origin given = values_.at(full).origin;
        const std::string why =
            fmt::format("has no meaning with {} = \"{}\"; it goes with {} = {}", key.only_with->key,
                        decider.words.front(), key.only_with->key, join(key.only_with->words));
        const Section& section = *find_section(schema_, place.substr(0, place.find('[')));
        const bool implied = decider.origin.layer == Layer::fallback &&
                             !find_key(section, key.only_with->key)->implied_by.empty();
        if (!implied && given.layer != Layer::fallback && given.layer >= decider.origin.layer)
          report(given, full, why);
        else if (given.layer > Layer::preset && (!implied || is_of_the_scene(given)))
          values_.notes.push_back(fmt::format("{}: {} {}", describe(given), full, why));
        values_.drop(full);
      }
    }
  }

  /// Written in the scene itself. A mix's file may hold the keys of several kinetics, for whoever chooses one.
  bool is_of_the_scene(const Origin& given) const {
    const auto found = values_.entries.find("apparatus");
    return found != values_.entries.end() && given.file == found->second.origin.file;
  }

  bool reported(const std::string& full) const {
    return std::find(reported_.begin(), reported_.end(), full) != reported_.end();
  }

  void report(const Origin& origin, const std::string& full, const std::string& what) {
    problems_.push_back(fmt::format("{}: {}: {}", describe(origin), full, what));
    reported_.push_back(full);
  }

  const Schema& schema_;
  const MissingSections& missing_;
  std::set<std::string> refused_;  ///< keys whose value is told to be wrong, and so not missing
  Values values_;
  std::vector<std::string> problems_, reported_;
};

}  // namespace

Values check(const Node& document, const Schema& schema, const MissingSections& missing) {
  return Checker(schema, missing).run(document);
}

}  // namespace tremie::scene
