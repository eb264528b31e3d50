#pragma once

// The rows of a record's falls that one least squares takes (joint_fall_fit.hpp). Private to rheometer/protocol.

#include <cstddef>
#include <vector>

#include "rheometer/protocol/falls.hpp"

namespace tremie {

/// Falls as they are fitted: from their onset on, at most 300 rows, evenly in the logarithm of time. One that loses less than
/// a quarter of its torque there is left out.
struct FallRows {
  std::vector<Fall> falls;
  std::vector<double> shear_rate;  ///< of each fall [1/s]
  std::vector<std::size_t> speed;  ///< of each fall: the number of its speed
  std::vector<std::size_t> begin;  ///< first row of each fall among all rows, and their number at the end
  std::size_t speeds = 0;
};
FallRows rows_of(const std::vector<Fall>& falls, const std::vector<double>& shear_rate);

}  // namespace tremie
