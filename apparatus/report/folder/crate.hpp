#pragma once

// ro-crate-metadata.json beside a result: what its files are and how they came about, for archives and for programs
// that read RO-Crate 1.1 (https://w3id.org/ro/crate/1.1).

#include <filesystem>
#include <string>

namespace tremie::report {

/// Says what a folder holds. An empty text is left out.
struct Crate {
  std::string name, description;
  std::string command;               ///< what repeats the result
  std::string input = "scene.toml";  ///< the file in the folder that the command computed the others from
  std::string mix_name = {}, mix_source = {};  ///< the concrete and where its numbers come from
  std::string mix_licence = {};                ///< of those numbers, "CC-BY-4.0" (SPDX)
  bool completed = true;
};

/// Describes all files of a folder but hidden ones and a checkpoint. The same files and the same Crate give the same
/// bytes on one day: sizes and times, which differ between two runs of a scene, are left out. The day of publication, which
/// RO-Crate requires, is that of SOURCE_DATE_EPOCH in the environment [seconds since 1970], otherwise today (UTC). Returns a
/// note where SOURCE_DATE_EPOCH is no such number. Throws io::WriteError.
std::string write_crate(const std::filesystem::path& folder, const Crate& crate);

}  // namespace tremie::report
