#pragma once

#include <filesystem>

#include "apparatus/common/outcome.hpp"
#include "apparatus/report/page/charts.hpp"

namespace tremie::report {

/// A chart of the outcome, its measured levels and its error bar with it.
LineChart line_chart(const scene::Chart& chart, const scene::Outcome& outcome);

/// Every chart that has something to draw, as SVG into the folder. Throws io::WriteError.
void draw_charts(const scene::Outcome& outcome, const std::filesystem::path& folder);

}  // namespace tremie::report
