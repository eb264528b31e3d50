#pragma once

// The folder that a study fills row by row, in place.

#include <filesystem>
#include <string>

namespace tremie::cli {

bool is_study_folder(const std::filesystem::path& folder);

/// Makes the folder, or takes the one that is there. `goes_on`: the study that is there stays. `replace`: it gives way;
/// one that is finished stays in DIR/.earlier until the new one is. What is not Tremie's stays where it is. Throws
/// scene::InputError where something is in the way.
void make_study_folder(const std::filesystem::path& folder, bool goes_on, bool replace);

/// Written once; where it is there it must be this study's, else scene::InputError. Many rows may start at once.
void write_design(const std::filesystem::path& folder, const std::string& design);

/// The results are written: marks them as Tremie's, and removes the earlier study.
void finish_study_folder(const std::filesystem::path& folder);

/// "; the earlier study lies in DIR/.earlier", where it does.
std::string where_the_earlier_is(const std::filesystem::path& folder);

}  // namespace tremie::cli
