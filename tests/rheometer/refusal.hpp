#pragma once

#include <algorithm>
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

/// Whether the reader says this of what it understood.
inline bool understood(const TorqueRecord& r, const std::string& part) {
  return std::any_of(r.understood.begin(), r.understood.end(),
                     [&](const std::string& text) { return text.find(part) != std::string::npos; });
}

}  // namespace tremie
