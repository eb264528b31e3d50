#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/report/rheometer_files.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/study/rows/files.hpp"
#include "apparatus/study/rows/indices.hpp"

namespace tremie::study {

/// Writes study.csv, study.h5 and summary.json with the indices and their note, each whole or not at all. Returns the reasons why the study
/// is not to be trusted: rows that are missing or came twice, or more than a tenth of the rows without a
/// result to be trusted.
std::vector<std::string> write_results(const Definition& study, const Design& design,
                                       const Collected& collected, const std::vector<ResultIndices>& indices,
                                       const std::string& note, const std::filesystem::path& folder,
                                       const Stopwatch& watch);

/// A file that a reader never meets half written.
void write_whole(const std::filesystem::path& file, const std::string& text);

}  // namespace tremie::study
