#pragma once

// A study as a page: what matters, main effects over the rows, how many rows can be trusted.

#include <string>
#include <vector>

#include "apparatus/study/rows/indices.hpp"

namespace tremie::study {

/// report.html. `note` says which results have no indices; `reasons` why the study is not to be trusted; `command`
/// repeats it.
std::string study_html(const Definition& study, const Design& design, const Collected& collected,
                       const std::vector<ResultIndices>& indices, const std::string& note,
                       const std::vector<std::string>& reasons, const std::string& command);

}  // namespace tremie::study
