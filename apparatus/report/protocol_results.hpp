#pragma once

// The sections of a whole test as JSON and as a table.

#include <nlohmann/json.hpp>
#include <string>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::report {

/// {"kind": "protocol", "sections": [...], "structuration_rate_Pa_per_s", ...}.
nlohmann::ordered_json protocol_results(const ProtocolReading& reading);

/// sections.csv.
std::string protocol_csv(const ProtocolReading& reading);

}  // namespace tremie::report
