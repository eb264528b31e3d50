// Whatever a quantity says, it is understood or refused; what was understood is written so that it reads back.

#include <cstdint>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "apparatus/scene/units.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tremie::scene;
  if (size == 0) return 0;
  const auto dimension = static_cast<Dimension>(data[0] % (static_cast<int>(Dimension::consistency) + 1));
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const double value = parse_quantity(text, dimension);
    if (value - value == 0.0 && parse_quantity(write_quantity(value, dimension), dimension) != value)
      std::abort();
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
