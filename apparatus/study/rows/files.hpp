#pragma once

// What a study leaves in its folder: study.csv and study.h5.

#include <filesystem>
#include <string>

#include "apparatus/study/design.hpp"
#include "apparatus/study/rows/journal.hpp"

namespace tremie::study {

/// study.csv: `row`, the factors, the results, `status`, `exit_code`, `reasons` (joined by "; "), `cpu_s`. A
/// row that nobody ran has the status "missing".
std::string study_csv(const Definition& study, const Design& design, const Collected& collected);

/// study.h5: the numbers of study.csv, a list a column, not-a-number where there is none. Throws
/// io::WriteError.
void write_study_h5(const std::filesystem::path& file, const Definition& study, const Design& design,
                    const Collected& collected);

}  // namespace tremie::study
