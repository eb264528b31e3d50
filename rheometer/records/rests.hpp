#pragma once

// Rows of a record in which the instrument stands still. Private to rheometer/records.

#include <cstddef>
#include <vector>

#include "rheometer/records/sections.hpp"

namespace tremie {

/// A speed is constant within this share of itself, over so many rows or more.
inline constexpr double same_speed = 0.03;
inline constexpr std::size_t fewest_rows = 5;

/// For each row whether it belongs to a rest: slower than 5e-4 of the fastest row, and no part of a sweep, a slow step or a
/// creep test.
std::vector<char> rests_of(const ProtocolRecord& record);

}  // namespace tremie
