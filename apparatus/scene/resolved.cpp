#include "apparatus/scene/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tremie::scene {
namespace {

constexpr std::size_t comment_column = 44;

std::string full_name(const std::string& place, const Key& key) {
  return place.empty() ? key.name : place + "." + key.name;
}

/// A TOML basic string.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n')
      result += "\\n";
    else if (c == '\t')
      result += "\\t";
    else if (static_cast<unsigned char>(c) < 0x20)
      result += fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
    else
      result += c;
  }
  return result + '"';
}

std::string scalar_text(const Key& key, double number) {
  if (key.kind == Kind::quantity) return quoted(write_quantity(number, key.dimension));
  if (key.kind == Kind::boolean) return number != 0.0 ? "true" : "false";
  return write_number(number);
}

std::string value_text(const Key& key, const Value& value) {
  std::vector<std::string> parts;
  for (const auto& word : value.words) parts.push_back(quoted(word));
  for (const double number : value.numbers) parts.push_back(scalar_text(key, number));
  if (key.shape == Shape::one || (parts.size() == 1 && key.shape == Shape::one_or_two)) return parts.front();
  if (key.shape == Shape::pairs) {
    for (std::size_t i = 0; 2 * i < parts.size(); ++i)
      parts[i] = fmt::format("[{}, {}]", parts[2 * i], parts[2 * i + 1]);
    parts.resize(parts.size() / 2);
  }
  return fmt::format("[{}]", fmt::join(parts, ", "));
}

std::string with_comment(std::string line, const std::string& comment) {
  if (comment.empty()) return line + "\n";
  if (line.size() < comment_column) line.resize(comment_column, ' ');
  return line + "  # " + comment + "\n";
}

std::string origin_comment(const Value& value) {
  const Layer from = value.origin.layer;
  const std::string layer = from == Layer::fallback       ? "default"
                            : from == Layer::preset       ? "preset"
                            : from == Layer::command_line ? "--set"
                                                          : "";
  if (value.note.empty()) return layer;
  return layer.empty() ? value.note : layer + ": " + value.note;
}

std::string section_text(const Section& section, const std::string& place, const Values& values) {
  std::string text;
  if (!place.empty())
    text +=
        section.repeated ? fmt::format("\n[[{}]]\n", section.name) : fmt::format("\n[{}]\n", section.name);
  for (const Key& key : section.keys) {
    const std::string full = full_name(place, key);
    if (!values.has(full)) continue;
    const Value& value = values.at(full);
    text += with_comment(key.name + " = " + value_text(key, value), origin_comment(value));
  }
  return text;
}

/// What may stand there: words, a range, units.
std::string allowed_briefly(const Key& key) {
  std::vector<std::string> parts;
  std::string words;
  for (const auto& word : key.words) words += (words.empty() ? "" : " | ") + quoted(word);
  if (!words.empty()) parts.push_back(words + (key.kind == Kind::quantity ? " | a quantity" : ""));
  if (const std::string range = range_text(key); !range.empty()) parts.push_back(range);
  if (key.kind == Kind::quantity) parts.push_back("in " + units_text(key.dimension));
  if (key.only_with)
    parts.push_back(
        fmt::format("with {} = \"{}\"", key.only_with->key, fmt::join(key.only_with->words, "\" or \"")));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string allowed_comment(const Key& key) {
  const std::string allowed = allowed_briefly(key);
  return (key.required ? "needed: " : "") + key.help + (allowed.empty() || key.help.empty() ? "" : ": ") +
         allowed;
}

std::string template_value(const Key& key) {
  const std::string text = key.fallback.empty() ? key.example : key.fallback;
  const bool string = key.kind == Kind::quantity || key.kind == Kind::choice || key.kind == Kind::text;
  return string && !text.starts_with('[') ? quoted(text) : text;
}

/// Whether the key applies where everything has its default.
bool applies_by_default(const Section& section, const Key& key) {
  if (!key.only_with) return true;
  const Key* decider = find_key(section, key.only_with->key);
  const auto& words = key.only_with->words;
  return decider && std::find(words.begin(), words.end(), decider->fallback) != words.end();
}

}  // namespace

std::string write_resolved(const Schema& schema, const Values& values) {
  std::string text;
  for (const Section& section : schema) {
    if (section.repeated) {
      for (std::size_t i = 0; i < values.count(section.name); ++i)
        text += section_text(section, fmt::format("{}[{}]", section.name, i), values);
    } else if (values.has_section(section.name)) {
      text += section_text(section, section.name, values);
    }
  }
  return text;
}

std::string write_template(const ApparatusKeys& apparatus) {
  std::string text = fmt::format(
      "# {}\n# Every line shows its default and may be left out, but for those marked \"needed\"; lines that "
      "begin with # are\n# off. tremie check FILE validates it and tells what it will cost; tremie {} FILE "
      "runs it.\n# In place of the table [mix] one line may name a mix: mix = \"mix_a\" (mix_b, mix_c, or a "
      "path to a .toml file).\n\n",
      apparatus.help, apparatus.name == "cell" ? "cell" : "run");
  text += fmt::format("apparatus = \"{}\"\n", apparatus.name);
  for (const Preset& preset : apparatus.presets)
    text +=
        with_comment(fmt::format("# preset = \"{}\"", preset.name), "values in place of the defaults below");
  const auto nothing_to_show = [](const Key& key) {
    const std::string value = template_value(key);
    return (value.empty() || value == "\"\"") && !key.required;
  };
  for (const Section& section : apparatus.schema) {
    if (section.optional && std::all_of(section.keys.begin(), section.keys.end(), nothing_to_show)) continue;
    if (!section.name.empty())
      text += fmt::format("\n# {}\n{}{}{}\n", section.help, section.repeated ? "[[" : "[", section.name,
                          section.repeated ? "]]" : "]");
    for (const Key& key : section.keys) {
      const std::string value = template_value(key);
      if (value.empty() || value == "\"\"") {
        text += with_comment(fmt::format("# {} = ...", key.name), allowed_comment(key));
        continue;
      }
      const bool active =
          applies_by_default(section, key) && !key.varies && (!key.fallback.empty() || key.required);
      text +=
          with_comment(fmt::format("{}{} = {}", active ? "" : "# ", key.name, value), allowed_comment(key));
    }
  }
  return text;
}

}  // namespace tremie::scene
