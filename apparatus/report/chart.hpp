#pragma once

#include <filesystem>
#include <string>

#include "apparatus/common/outcome.hpp"

namespace tremie::report {

/// The gnuplot script of a chart, data and all: makes chart.file in the folder that gnuplot runs in.
std::string chart_script(const scene::Chart& chart, const std::vector<scene::Column>& series);

/// Draws every chart of the outcome into the folder. Returns a note where it could not ("gnuplot is not
/// installed…"), else nothing.
std::string draw_charts(const scene::Outcome& outcome, const std::filesystem::path& folder);

}  // namespace tremie::report
