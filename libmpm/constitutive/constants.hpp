#pragma once

// Numbers that more than one part of the tree needs.

#include <numbers>

namespace tremie {

inline constexpr double two_pi = 2.0 * std::numbers::pi;  ///< [rad] a revolution
inline constexpr double gravity = 9.81;                   ///< [m/s^2]

}  // namespace tremie
