// Whatever a study's file holds, it is read or refused.

#include "apparatus/scene/input_error.hpp"
#include "apparatus/study/definition.hpp"
#include "tests/fuzz/from_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  from_file(data, size, [](const std::filesystem::path& file) {
    try {
      tremie::study::read_definition(file);
    } catch (const tremie::scene::InputError&) {
    }
  });
  return 0;
}
