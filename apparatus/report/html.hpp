#pragma once

#include <filesystem>
#include <string>

#include "apparatus/common/outcome.hpp"

namespace tremie::report {

/// One page to read and to send: the results, the charts and the picture of the folder, all in the file
/// itself.
std::string report_html(const scene::Outcome& outcome, const std::string& resolved,
                        const std::filesystem::path& folder);

}  // namespace tremie::report
