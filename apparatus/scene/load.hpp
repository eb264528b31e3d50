#pragma once

// From a file to checked values, for any apparatus: default < preset < scene < --set, named mixes inlined.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/values.hpp"

namespace tremie::scene {

/// A scene file and what the command line sets over it.
struct Request {
  std::filesystem::path path;
  std::vector<std::string> overrides = {};  ///< "mix.yield_stress=61 Pa"
  std::optional<std::string> text = {};     ///< the scene itself; `path` then only names it in messages
};

struct Loaded {
  std::string name;       ///< the file's name without .toml
  std::string path;       ///< as the user wrote it
  std::string apparatus;  ///< "slump_flow"
  Schema schema;          ///< with the top of the file
  Values values;
  std::vector<std::filesystem::path> files = {};  ///< that were read
};

/// Reads and checks a scene of one of the apparatus `known` that this command of tremie runs; empty: of any.
/// Throws InputError.
Loaded load(const Request& request, std::span<const ApparatusKeys> known, const std::string& command = "run");

/// The top of the file: schema, apparatus, preset.
Section top_section(const ApparatusKeys& apparatus);

/// Where reference_data lies: $TREMIE_DATA, the share folder beside the program, the source tree, or the share
/// folder that it was configured to be installed in.
std::vector<std::filesystem::path> data_folders();

/// Whether a scene may take the section whole from such a file by a name: `cone = "haegermann"`.
bool may_be_named(const std::string& section);

/// The names of the files in a folder of reference_data: those that `mix = "…"` ("mixes"), `cone`, `funnel` may have.
std::vector<std::string> names_in(const std::string& data_folder);
/// The names that `mix = "…"` may have.
std::vector<std::string> mix_names();

}  // namespace tremie::scene
