#pragma once

#include <filesystem>
#include <string>

#include "apparatus/common/outcome.hpp"

namespace tremie::report {

/// Has tremie-picture draw shape.png from a .vtp of the folder, on $DISPLAY or else through xvfb-run. A run
/// never fails over its picture: returns a note where there is none, else nothing.
std::string draw_picture(const scene::Outcome& outcome, const std::filesystem::path& folder,
                         const std::string& vtp);

}  // namespace tremie::report
