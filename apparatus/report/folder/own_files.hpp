#pragma once

// Which files of a folder are Tremie's: what a command may replace there. A hidden list in the folder, ".tremie", has
// the names, sizes and sums of what was written; all else was put there, or changed, by others.

#include <filesystem>
#include <string>
#include <vector>

namespace tremie::report {

inline constexpr const char* list_of_own_files = ".tremie";

/// The folder that a path stands for: absolute, links followed, not necessarily there. Throws scene::InputError where
/// a link on the way leads nowhere.
std::filesystem::path resolved_folder(const std::filesystem::path& folder);

/// Throws scene::InputError: "--out FOLDER: WHY".
[[noreturn]] void refuse_folder(const std::filesystem::path& folder, const std::string& why);

/// Throws where the folder is, or holds, a file or folder that the command reads.
void refuse_inputs(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& inputs);

/// Lists these files as Tremie's, beside those that are listed. Throws io::WriteError.
void list_as_own(const std::filesystem::path& folder, const std::vector<std::filesystem::path>& names);
/// Lists all that the folder holds.
void list_all_as_own(const std::filesystem::path& folder);

/// Whether it is listed, and a file that is as it was then.
bool is_own_file(const std::filesystem::path& folder, const std::filesystem::path& name);
/// What the folder holds beside its own files, in order: "notes.txt", "sub/".
std::vector<std::string> foreign_files(const std::filesystem::path& folder);
/// Of these, the ones that are listed, and were changed since.
std::vector<std::string> changed_files(const std::filesystem::path& folder);
/// "notes.txt, my.toml and 3 more".
std::string short_list(const std::vector<std::string>& names);

/// Removes a folder's own files and no others; the folder too, where nothing is left.
void remove_own_files(const std::filesystem::path& folder);

}  // namespace tremie::report
