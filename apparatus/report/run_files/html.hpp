#pragma once

#include <string>

#include "apparatus/common/outcome.hpp"
#include "apparatus/report/page/moving_picture.hpp"

namespace tremie::report {

/// The report of a run: its outcome, its scene as TOML, its points over time (may be empty) and the command that
/// repeats it.
std::string report_html(const scene::Outcome& outcome, const std::string& resolved,
                        const MovingPicture& moving, const std::string& command);

/// "Mix A, slump flow after 240 s of rest: 348 ± 8 mm".
std::string headline_of(const scene::Outcome& outcome);

/// How the result stands to what was measured, a sentence; empty without a measurement.
std::string measured_line(const scene::Outcome& outcome);

}  // namespace tremie::report
