// Whatever a laboratory's file holds, it is read or refused.

#include "apparatus/calibration/lab.hpp"
#include "apparatus/scene/input_error.hpp"
#include "tests/fuzz/from_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  from_file(data, size, [](const std::filesystem::path& file) {
    try {
      tremie::calibration::read_lab(file);
    } catch (const tremie::scene::InputError&) {
    }
  });
  return 0;
}
