#pragma once

// Which files of a folder are Tremie's: what a command may replace there. The time of change of a file that Tremie wrote
// ends with a mark; a file of another name or without the mark was put there, or changed, by others. A file system or
// an archive of whole seconds loses the mark: what lies there is not replaced.

#include <filesystem>
#include <string>
#include <vector>

namespace tremie::report {

/// The folder that a path stands for: absolute, links followed, not necessarily there. Throws scene::InputError where
/// a link on the way leads nowhere.
std::filesystem::path resolved_folder(const std::filesystem::path& folder);

/// Throws scene::InputError: "--out FOLDER: WHY".
[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const std::string& why);

/// Throws where the folder is, or holds, a file or folder that the command reads.
void refuse_inputs(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs);

/// Marks a file.
void mark_own_file(const std::filesystem::path& file);
/// Marks all files of a finished result.
void mark_own_files(const std::filesystem::path& folder);
/// Whether it is a file, no link, and as Tremie left it.
bool is_marked(const std::filesystem::path& file);

/// The files in a result's folder that are not Tremie's, or no longer as Tremie wrote them: "notes.txt", "sub/".
std::vector<std::string> foreign_files(const std::filesystem::path& folder);
/// Of these, the ones that bear a name of Tremie's.
std::vector<std::string> changed_files(const std::filesystem::path& folder);
/// "notes.txt, my.toml and 3 more".
std::string short_list(const std::vector<std::string>& names);

/// Removes a result's files and no others; the folder too, where nothing is left.
void remove_own_files(const std::filesystem::path& folder);

}  // namespace tremie::report
