#pragma once

#include <string>
#include <utility>
#include <vector>

#include "rheometer/protocol/protocol.hpp"

namespace tremie::report {

/// report.html of a whole test. `file`: the record; `command` repeats the reading.
std::string protocol_html(const ProtocolRecord& record, const ProtocolReading& reading,
                          const std::string& file, const std::string& command);

/// The charts of its sections as files, each a name and an SVG: section_<number>.svg.
std::vector<std::pair<std::string, std::string>> protocol_chart_files(const ProtocolRecord& record,
                                                                      const ProtocolReading& reading);

}  // namespace tremie::report
