#pragma once

// A TOML text as a plain tree whose every node knows where it came from. toml++ stays behind document.cpp.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tremie::scene {

/// Who gave a value; a later layer wins over an earlier one.
enum class Layer { fallback, preset, scene, command_line };

/// Where a node was written.
struct Origin {
  Layer layer = Layer::fallback;
  std::string file;  ///< the file's path, or the --set argument as typed
  int line = 0;      ///< 1-based; 0 where there is none
};

/// "slump.toml:12", "--set mix.yield_stress=-5", "preset paper:3".
std::string describe(const Origin& origin);

struct Member;
struct Node;
using Table = std::vector<Member>;  ///< in the order of the file
using Array = std::vector<Node>;
struct Other {};  ///< a TOML value that no scene uses: a date or a time

struct Node {
  Origin origin;
  std::variant<Table, Array, std::string, std::int64_t, double, bool, Other> value;
};

struct Member {
  std::string key;
  Node node;
};

/// Reads a TOML file. Throws InputError where it can't be read or is no TOML.
Node parse_file(const std::filesystem::path& path);

/// Reads TOML text; `name` stands for the file in messages. Throws InputError.
Node parse_text(std::string_view text, const std::string& name, Layer layer);

/// The member of a table; nullptr where there is none or where `node` is no table.
Node* find(Node& node, std::string_view key);
const Node* find(const Node& node, std::string_view key);

/// Throws InputError "lab.toml:3: KEY: WHAT", with the place of the node.
[[noreturn]] void complain(const Node& node, const std::string& key, const std::string& what);

/// One --set argument, "mix.yield_stress=61 Pa".
struct Override {
  std::vector<std::string> path;  ///< {"mix", "yield_stress"}
  Node value;
};

/// Splits KEY=VALUE. VALUE is TOML; what is no TOML value is taken as a string. Throws InputError without "="
/// or KEY.
Override parse_override(const std::string& argument);

/// Writes a value into the tree, making tables on the way. A table lies under another table: they are merged. "load[1]" is
/// the second table of [[load]], which must be there.
void put(Node& root, const std::vector<std::string>& path, Node value);

/// Lays the table `over` on the table `under`: what both have is taken from `over`, table by table.
void merge(Node& under, const Node& over);

}  // namespace tremie::scene
