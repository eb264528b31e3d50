#pragma once

// The sections of a record as a table for the screen.

#include <string>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::cli {

void print_protocol(const ProtocolReading& reading);

}  // namespace tremie::cli
