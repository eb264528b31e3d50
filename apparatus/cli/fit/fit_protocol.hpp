#pragma once

// The sections of a record as a table for the screen and as charts.

#include <string>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::cli {

void print_protocol(const ProtocolReading& reading);

/// gnuplot script: section_<number>.svg, torque over time or, of a flow curve, over speed.
std::string protocol_charts(const ProtocolRecord& record, const ProtocolReading& reading);

}  // namespace tremie::cli
