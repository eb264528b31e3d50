#pragma once

// Flow curves among rows that keep no speed. Private to rheometer/records.

#include <cstddef>
#include <vector>

#include "rheometer/records/sections.hpp"

namespace tremie {

/// A flow curve of the rows [begin, end), by its highest speed.
Section flow_curve_section(const std::vector<double>& omega, std::size_t begin, std::size_t end, bool up,
                           bool stepped);

/// Appends the ramps up and down of the rows [begin, end), however often the speed turns; rows of neither kind are a
/// section too.
void add_ramps(const std::vector<double>& omega, std::size_t begin, std::size_t end,
               std::vector<Section>& sections);

}  // namespace tremie
