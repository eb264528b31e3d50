#pragma once

#include <algorithm>
#include <cstdint>

#include "apparatus/common/model.hpp"

namespace tremie::experiment {

/// A thread has at least so many points: fewer cost it more waiting than they save.
inline constexpr std::int64_t points_per_thread = 5000, points_per_explicit_thread = 1600;

inline bool is_3d(SpaceKind space) {
  return space == SpaceKind::quarter || space == SpaceKind::half || space == SpaceKind::full ||
         space == SpaceKind::cylindrical;
}

/// The number of threads for a body of so many points on so many hardware threads, where the user names none.
/// On two idle cores a second thread makes the full slump flow of 13,000 points 1.45 times faster; the quarter of
/// 3,250 points it makes 1.5 times faster by explicit steps, but by implicit ones 9 % slower, sections 6 % and
/// the vane's plane section 19 %, whose factorisations have one thread whatever their size.
inline int default_threads(std::int64_t points, SpaceKind space, SchemeKind scheme, int hardware_threads) {
  if (!is_3d(space)) return 1;
  const std::int64_t least = scheme == SchemeKind::implicit ? points_per_thread : points_per_explicit_thread;
  return static_cast<int>(std::clamp<std::int64_t>(points / least, 1, std::max(1, hardware_threads)));
}

}  // namespace tremie::experiment
