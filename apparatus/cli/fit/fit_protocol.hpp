#pragma once

// The sections of a record as JSON, as a table for the screen and as CSV.

#include <nlohmann/json.hpp>
#include <string>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::cli {

/// {"kind": "protocol", "sections": [...], "structuration_rate_Pa_per_s", ...}.
nlohmann::ordered_json protocol_json(const ProtocolReading& reading);

void print_protocol(const ProtocolReading& reading);

/// The table as CSV.
std::string protocol_csv(const ProtocolReading& reading);

}  // namespace tremie::cli
