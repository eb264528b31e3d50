#pragma once

// VERIFICATION.md with its CSV files and charts: what the cases measured, for a person.

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/verification/case.hpp"

namespace tremie::verification {

/// Writes VERIFICATION.md, a CSV and a chart a case (error over CPU time, all schemes) into `folder`, which
/// is there. `command` is what made it. Throws io::WriteError.
void write_document(const std::vector<Case>& cases, const std::string& command,
                    const std::filesystem::path& folder);

/// The bounds that were not kept, a line each.
std::vector<std::string> broken_bounds(const std::vector<Case>& cases);

/// Whether every bound of every case is kept.
inline bool all_kept(const std::vector<Case>& cases) { return broken_bounds(cases).empty(); }

}  // namespace tremie::verification
