#pragma once

#include <exception>
#include <string>

#include "rheometer/records/torque_record.hpp"

namespace tremie {

/// What is said when a record's text is refused; "nothing" where it is read.
inline std::string refusal(const std::string& text, const ReadOptions& options = {}) {
  try {
    parse_torque_record(text, "r.csv", 0.0, options);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace tremie
