// Whatever a torque record or an instrument's export holds, it is read or refused.

#include <cstdint>
#include <string_view>

#include "rheometer/records/torque_record.hpp"
#include "rheometer/tables/table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    tremie::parse_torque_record(text, "fuzzed.csv");
  } catch (const tremie::RecordError&) {
  }
  return 0;
}
