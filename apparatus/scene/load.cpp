#include "apparatus/scene/load.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "apparatus/scene/document.hpp"

namespace tremie::scene {
namespace {

namespace fs = std::filesystem;

std::string quoted_list(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "\"" : ", \"") + word + "\"";
  return text;
}

/// A section that a scene may take whole from a file of reference_data: `mix = "mix_a"`.
struct FromFile {
  const char *section, *folder;
};
constexpr FromFile from_files[] = {
    {"mix", "mixes"}, {"cone", "cones"}, {"funnel", "funnels"}, {"box", "boxes"}, {"ring", "rings"}};

/// The file that `mix = "…"` stands for: a name from reference_data/mixes, or a path beside the scene.
fs::path file_of(const FromFile& from, const std::string& name, const Origin& origin,
                 const fs::path& scene_folder) {
  if (name.ends_with(".toml")) return scene_folder / name;
  for (const auto& folder : data_folders()) {
    const fs::path file = folder / from.folder / (name + ".toml");
    std::error_code error;
    if (fs::is_regular_file(file, error)) return file;
  }
  const auto known = names_in(from.folder);
  throw InputError(
      fmt::format("{0}: {1}: there is no {1} \"{2}\"{3} Allowed: {4}, a path to a .toml file, "
                  "or a table [{1}]",
                  describe(origin), from.section, name, did_you_mean(name, known), quoted_list(known)));
}

/// A line for each key at the top of a file that no apparatus has, with the nearest one.
std::string unknown_at_top(const Node& document, std::span<const ApparatusKeys> known) {
  std::vector<std::string> allowed{"apparatus", "schema", "preset"};
  for (const auto& apparatus : known)
    for (const Section& section : apparatus.schema) {
      if (!section.name.empty()) allowed.push_back(section.name.substr(0, section.name.find('.')));
      for (const Key& key : section.name.empty() ? section.keys : std::vector<Key>{})
        allowed.push_back(key.name);
    }
  std::string lines;
  for (const Member& member : std::get<Table>(document.value))
    if (std::find(allowed.begin(), allowed.end(), member.key) == allowed.end())
      lines += fmt::format("{}: {}: unknown key{}\n", describe(member.node.origin), member.key,
                           did_you_mean(member.key, allowed));
  return lines;
}

/// Replaces `mix = "mix_a"` by that file's [mix], and so on. Returns the files.
std::vector<fs::path> inline_files(Node& document, const fs::path& scene_folder,
                                   std::span<const ApparatusKeys> known) {
  std::vector<fs::path> files;
  for (const FromFile& from : from_files) {
    Node* section = find(document, from.section);
    const auto* name = section ? std::get_if<std::string>(&section->value) : nullptr;
    if (!name) continue;
    const fs::path file = file_of(from, *name, section->origin, scene_folder);
    Node text = parse_file(file);
    Node* table = find(text, from.section);
    if (!table || !std::holds_alternative<Table>(table->value))
      throw InputError(
          fmt::format("{}:1: {}: missing table [{}]", file.string(), from.section, from.section));
    if (const std::string unknown = unknown_at_top(text, known); !unknown.empty())
      throw InputError(unknown.substr(0, unknown.size() - 1));
    *section = *table;
    files.push_back(file);
  }
  return files;
}

/// A key of the concrete itself, not of its name or of what was measured on it.
bool is_of_the_concrete(const Override& o) {
  if (o.path.size() < 2 || o.path.front() != "mix") return false;
  const std::string& key = o.path[1];
  return key != "name" && key != "source" && key != "licence" && key != "measured_on" &&
         !key.starts_with("slump_flow");
}

/// Lays the command line's values over the scene's. Returns the keys of the concrete among them, "yield_stress,
/// density"; adds the files that were read.
std::string apply_overrides(Node& document, const Request& request, std::span<const ApparatusKeys> known,
                            std::vector<fs::path>& files) {
  std::vector<Override> overrides;
  std::string of_the_concrete;
  for (const auto& argument : request.overrides) overrides.push_back(parse_override(argument));
  const auto names_a_file = [](const Override& o) {
    return o.path.size() == 1 &&
           std::any_of(std::begin(from_files), std::end(from_files),
                       [&](const FromFile& from) { return o.path.front() == from.section; });
  };
  for (const auto& change : overrides)
    if (names_a_file(change)) put(document, change.path, change.value);
  files = inline_files(document, request.path.parent_path(), known);
  if (!request.text) files.push_back(request.path);
  for (const auto& change : overrides) {
    if (names_a_file(change)) continue;
    put(document, change.path, change.value);
    if (is_of_the_concrete(change))
      of_the_concrete += (of_the_concrete.empty() ? "" : ", ") + change.path.back();
  }
  return of_the_concrete;
}

/// A mix whose values the command line changed is no longer the one that bears the name and was measured.
void rename_changed_mix(Values& values, const std::string& changed) {
  const auto name = values.entries.find("mix.name");
  if (changed.empty() || name == values.entries.end() || values.layer("mix.name") == Layer::command_line)
    return;
  auto [measured_on, first] = values.entries.try_emplace("mix.measured_on", name->second);
  name->second.words = {measured_on->second.words.front() + " with changed " + (first ? changed : "values")};
}

const ApparatusKeys& apparatus_of(const Node& document, const std::string& file,
                                  std::span<const ApparatusKeys> known, const std::string& command) {
  const auto runs = [&](const ApparatusKeys& a) { return command.empty() || a.command == command; };
  std::vector<std::string> allowed;
  for (const auto& apparatus : known)
    if (runs(apparatus)) allowed.push_back(apparatus.name);
  const Node* node = find(document, "apparatus");
  if (!node)
    throw InputError(fmt::format("{}{}: apparatus: missing key; allowed: {}", unknown_at_top(document, known),
                                 describe(document.origin), quoted_list(allowed)));
  const auto* name = std::get_if<std::string>(&node->value);
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const ApparatusKeys& a) { return name && a.name == *name; });
  if (found != known.end() && runs(*found)) return *found;
  const std::string given = name ? *name : "";
  if (found != known.end())
    throw InputError(fmt::format("{}: apparatus: a scene of \"{}\" is run by `tremie {} {}`",
                                 describe(node->origin), given, found->command, file));
  throw InputError(fmt::format("{}: apparatus: \"{}\" is not allowed; allowed: {}{}", describe(node->origin),
                               given, quoted_list(allowed), nearest_in_brackets(given, allowed)));
}

/// What to say of a scene without a mix; nothing where it has one.
MissingSections missing_mix(const Node& document) {
  if (find(document, "mix")) return {};
  return {{"mix", "missing key; allowed: a table [mix] or one of " + quoted_list(mix_names())}};
}

/// The preset's values under the scene's; nothing where the scene names none. An unknown name is left for
/// check().
void lay_on_preset(Node& document, const ApparatusKeys& apparatus) {
  const Node* node = find(document, "preset");
  const auto* name = node ? std::get_if<std::string>(&node->value) : nullptr;
  if (!name) return;
  for (const Preset& preset : apparatus.presets) {
    if (preset.name != *name) continue;
    Node under = parse_text(preset.toml, "preset " + preset.name, Layer::preset);
    merge(under, document);
    document = std::move(under);
    return;
  }
}

/// The top of the file, with what the apparatus adds to it, then the apparatus' sections.
Schema whole_schema(const ApparatusKeys& apparatus) {
  Schema schema{top_section(apparatus)};
  for (const Section& section : apparatus.schema) {
    auto& top = schema.front().keys;
    if (section.name.empty())
      top.insert(top.end(), section.keys.begin(), section.keys.end());
    else
      schema.push_back(section);
  }
  return schema;
}

/// The file that this code is in: the program, or Python's module; empty where the system does not say.
fs::path own_file() {
#ifdef __GLIBC__
  Dl_info info;  // of the program it has the name that it was called by
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) != 0) {
    const fs::path file = info.dli_fname;
    if (file.extension() == ".so") return file;
  }
#endif
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error);
}

/// The share folder in the nearest folder above that file that has one, wherever both were moved to: PREFIX of
/// PREFIX/bin/tremie, or of PREFIX/lib/python3/dist-packages/tremie.
fs::path data_of_installation() {
  for (fs::path folder = own_file().parent_path(); folder.has_relative_path();
       folder = folder.parent_path()) {
    const fs::path data = folder / TREMIE_SHARE / "reference_data";
    std::error_code error;
    if (fs::is_directory(data, error)) return data;
  }
  return {};
}

}  // namespace

bool may_be_named(const std::string& section) {
  return std::any_of(std::begin(from_files), std::end(from_files),
                     [&](const FromFile& from) { return section == from.section; });
}

Section top_section(const ApparatusKeys& apparatus) {
  std::vector<std::string> presets;
  for (const auto& preset : apparatus.presets) presets.push_back(preset.name);
  Section top{.name = "", .help = apparatus.help};
  top.keys.push_back({.name = "schema",
                      .kind = Kind::integer,
                      .range = between(1, 1),
                      .fallback = "1",
                      .help = "version of the scene's keys"});
  top.keys.push_back(
      {.name = "apparatus", .kind = Kind::choice, .words = {apparatus.name}, .required = true});
  if (presets.empty()) return top;
  top.keys.push_back(
      {.name = "preset", .kind = Kind::choice, .words = presets, .help = "values under the scene's own"});
  return top;
}

std::vector<fs::path> data_folders() {
  std::vector<fs::path> folders;
  if (const char* set = std::getenv("TREMIE_DATA")) folders.emplace_back(set);
  if (const fs::path data = data_of_installation(); !data.empty()) folders.push_back(data);
  folders.emplace_back(TREMIE_SOURCE_DATA);
  folders.emplace_back(TREMIE_INSTALLED_DATA);
  return folders;
}

std::vector<std::string> names_in(const std::string& data_folder) {
  std::vector<std::string> names;
  for (const auto& folder : data_folders()) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder / data_folder, error))
      if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::vector<std::string> mix_names() { return names_in("mixes"); }

Loaded load(const Request& request, std::span<const ApparatusKeys> known, const std::string& command) {
  Node document = request.text ? parse_text(*request.text, request.path.string(), Layer::scene)
                               : parse_file(request.path);
  std::vector<fs::path> files;
  const std::string changed = apply_overrides(document, request, known, files);
  const ApparatusKeys& apparatus = apparatus_of(document, request.path.string(), known, command);
  const MissingSections missing = missing_mix(document);
  lay_on_preset(document, apparatus);
  Loaded loaded{request.path.stem().string(),
                request.path.string(),
                apparatus.name,
                whole_schema(apparatus),
                {},
                files};
  loaded.values = check(document, loaded.schema, missing);
  rename_changed_mix(loaded.values, changed);
  loaded.values.drop("preset");  // its values stand in the resolved scene by themselves
  if (apparatus.settle) apparatus.settle(loaded.values);
  return loaded;
}

}  // namespace tremie::scene
