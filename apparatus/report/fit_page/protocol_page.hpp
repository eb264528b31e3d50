#pragma once

#include <string>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::report {

/// report.html of a whole test. `file`: the record; `command` repeats the reading.
std::string protocol_html(const ProtocolRecord& record, const ProtocolReading& reading,
                          const std::string& file, const std::string& command);

}  // namespace tremie::report
