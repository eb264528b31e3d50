#include "apparatus/scene/document.hpp"

#include <fmt/format.h>

// toml++ 3.3 asserts what it then reports as an error of the file (a key such as "[,mix]"): the error is what we want.
#define TOML_ASSERT(condition) static_cast<void>(0)
#include <toml++/toml.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iostream>
#include <optional>
#include <utility>

#include "apparatus/scene/input_error.hpp"

namespace tremie::scene {
namespace {

struct Source {
  const std::string& name;
  Layer layer;
};

Node convert(const toml::node& from, const Source& source);

Table convert_table(const toml::table& from, const Source& source) {
  Table table;
  for (const auto& [key, node] : from) table.push_back({std::string(key.str()), convert(node, source)});
  // toml++ keeps its tables sorted by key; a person expects the order of the file.
  std::stable_sort(table.begin(), table.end(),
                   [](const Member& a, const Member& b) { return a.node.origin.line < b.node.origin.line; });
  return table;
}

Array convert_array(const toml::array& from, const Source& source) {
  Array array;
  for (const auto& node : from) array.push_back(convert(node, source));
  return array;
}

Node convert(const toml::node& from, const Source& source) {
  Node node{{source.layer, source.name, static_cast<int>(from.source().begin.line)}, Other{}};
  if (const auto* table = from.as_table()) {
    Table members = convert_table(*table, source);
    // A table that only dotted keys imply has no place of its own.
    if (node.origin.line == 0 && !members.empty()) node.origin.line = members.front().node.origin.line;
    node.value = std::move(members);
  }
  if (const auto* array = from.as_array()) node.value = convert_array(*array, source);
  if (const auto* text = from.as_string()) node.value = text->get();
  if (const auto* integer = from.as_integer()) node.value = integer->get();
  if (const auto* number = from.as_floating_point()) node.value = number->get();
  if (const auto* boolean = from.as_boolean()) node.value = boolean->get();
  return node;
}

/// VALUE of --set as a TOML value; empty where it is none.
std::optional<Node> toml_value(const std::string& text, const Source& source) {
  if (text.find_first_of("\r\n") != std::string::npos) return std::nullopt;
  try {
    const toml::table table = toml::parse("value = " + text);
    if (table.size() == 1) return convert(*table.get("value"), source);
  } catch (const toml::parse_error&) {
  }
  return std::nullopt;
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// "[5 mm, 2 mm]": the shell has eaten the quotes of a TOML array.
Node value_or_words(const std::string& text, const Source& source) {
  if (auto value = toml_value(text, source)) return *value;
  const Origin origin{source.layer, source.name, 0};
  if (!text.starts_with('[') || !text.ends_with(']')) return {origin, text};
  Array array;
  std::size_t start = 1;
  while (start < text.size()) {
    const auto end = std::min(text.find(',', start), text.size() - 1);
    array.push_back(value_or_words(trimmed(text.substr(start, end - start)), source));
    start = end + 1;
  }
  return {origin, array};
}

void set_line_of_override(Node& node) {
  node.origin.line = 0;
  if (auto* table = std::get_if<Table>(&node.value))
    for (auto& member : *table) set_line_of_override(member.node);
  if (auto* array = std::get_if<Array>(&node.value))
    for (auto& element : *array) set_line_of_override(element);
}

}  // namespace

namespace {

/// A scene has a few parts; so many more would fill the stack.
constexpr std::size_t most_parts = 64;
constexpr std::size_t most_bytes = std::size_t{1} << 28;

/// Looks for a key of too many dotted parts before the parser does. Strings do not count.
void refuse_deep_keys(std::string_view text, const std::string& name) {
  std::size_t parts = 0, line = 1;
  char within = 0;  // the quote of the string that this is in
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '\n') ++line;
    if (within != 0) {
      if (c == '\\' && within == '"') ++i;
      if (c == within || c == '\n') within = 0;
    } else if (c == '"' || c == '\'') {
      within = c;
    } else if (c == '.') {
      if (++parts > most_parts)
        throw InputError(fmt::format("{}:{}: a key has more than {} dotted parts", name, line, most_parts));
    } else if (std::string_view("=,[]{}\n#").find(c) != std::string_view::npos) {
      parts = 0;
    }
  }
}

/// All of a file; one without an end (a device) is no scene.
std::string read_whole(std::istream& file, const std::string& name) {
  std::string text;
  std::vector<char> block(1 << 16);
  while (file.read(block.data(), static_cast<std::streamsize>(block.size())), file.gcount() > 0) {
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
    if (text.size() > most_bytes)
      throw InputError(fmt::format("{}: is no scene: longer than {} MB", name, most_bytes >> 20));
  }
  if (file.bad()) throw InputError(fmt::format("{}: cannot be read", name));
  return text;
}

}  // namespace

std::string describe(const Origin& origin) {
  const std::string prefix = origin.layer == Layer::command_line ? "--set " : "";
  if (origin.line > 0) return fmt::format("{}{}:{}", prefix, origin.file, origin.line);
  return prefix + origin.file;
}

void complain(const Node& node, const std::string& key, const std::string& what) {
  throw InputError(fmt::format("{}: {}: {}", describe(node.origin), key, what));
}

Node parse_text(std::string_view text, const std::string& name, Layer layer) {
  refuse_deep_keys(text, name);
  try {
    Node node = convert(toml::parse(text), {name, layer});
    node.origin.line = 1;
    return node;
  } catch (const toml::parse_error& error) {
    throw InputError(
        fmt::format("{}:{}: this is no TOML: {}", name, error.source().begin.line, error.description()));
  }
}

Node parse_file(const std::filesystem::path& path) {
  if (path == "-") return parse_text(read_whole(std::cin, "standard input"), "standard input", Layer::scene);
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw InputError(fmt::format("{}: is a folder, not a scene file", path.string()));
  std::ifstream file(path, std::ios::binary);
  if (!file) {
    throw InputError(
        fmt::format("{}: {}", path.string(),
                    std::filesystem::exists(path, error) ? "cannot be read" : "there is no such file"));
  }
  return parse_text(read_whole(file, path.string()), path.string(), Layer::scene);
}

const Node* find(const Node& node, std::string_view key) {
  const auto* table = std::get_if<Table>(&node.value);
  if (!table) return nullptr;
  const auto found =
      std::find_if(table->begin(), table->end(), [&](const Member& m) { return m.key == key; });
  return found == table->end() ? nullptr : &found->node;
}

Node* find(Node& node, std::string_view key) { return const_cast<Node*>(find(std::as_const(node), key)); }

Override parse_override(const std::string& argument) {
  const auto equals = argument.find('=');
  const auto complain = [&] {
    return InputError(
        fmt::format("--set {}: must read KEY=VALUE, like mix.yield_stress=\"61 Pa\"", argument));
  };
  if (equals == std::string::npos) throw complain();
  Override result;
  const std::string key = trimmed(argument.substr(0, equals));
  for (std::size_t start = 0; start <= key.size();) {
    const auto end = std::min(key.find('.', start), key.size());
    if (end == start) throw complain();
    result.path.push_back(key.substr(start, end - start));
    start = end + 1;
  }
  if (result.path.empty() || result.path.size() > most_parts) throw complain();
  result.value = value_or_words(trimmed(argument.substr(equals + 1)), {argument, Layer::command_line});
  set_line_of_override(result.value);
  return result;
}

namespace {

/// The table that "load[1]" names, the second of [[load]]; nullptr where the name has no index.
Node* table_of_list(Node& node, const std::string& name, const Node& value) {
  const auto bracket = name.find('[');
  if (bracket == std::string::npos || bracket == 0 || name.back() != ']') return nullptr;
  const std::string list = name.substr(0, bracket),
                    digits = name.substr(bracket + 1, name.size() - bracket - 2);
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), index);
  Node* const found = find(node, list);
  auto* array = found ? std::get_if<Array>(&found->value) : nullptr;
  const bool there =
      error == std::errc{} && end == digits.data() + digits.size() && array && index < array->size();
  if (!there)
    complain(value, name,
             array && !array->empty()
                 ? fmt::format("allowed: {0}[0] to {0}[{1}], the tables [[{0}]] of the scene", list,
                               array->size() - 1)
                 : fmt::format("the scene has no table [[{}]] to change", list));
  return &(*array)[index];
}

}  // namespace

void put(Node& root, const std::vector<std::string>& path, Node value) {
  Node* node = &root;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!std::holds_alternative<Table>(node->value)) *node = {value.origin, Table{}};
    Node* next = table_of_list(*node, path[i], value);
    if (!next) next = find(*node, path[i]);
    if (!next) {
      auto& table = std::get<Table>(node->value);
      table.push_back({path[i], {value.origin, Table{}}});
      next = &table.back().node;
    }
    node = next;
  }
  const bool both_tables =
      std::holds_alternative<Table>(node->value) && std::holds_alternative<Table>(value.value);
  if (both_tables) {
    merge(*node, value);
  } else {
    *node = std::move(value);
  }
}

void merge(Node& under, const Node& over) {
  under.origin = over.origin;
  for (const Member& member : std::get<Table>(over.value)) put(under, {member.key}, member.node);
}

}  // namespace tremie::scene
