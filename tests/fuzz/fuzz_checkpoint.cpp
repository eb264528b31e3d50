// Whatever a checkpoint's state holds behind its sum, it is read or refused: no list is asked for that the rest of the
// bytes could not fill.

#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include "libmpm/body/archive.hpp"

namespace {

/// Of the shapes that a state is made of: numbers, words, lists of plain and of other things.
struct Part {
  double time = 0.0;
  std::string name;
  std::vector<std::array<double, 3>> points;
};

void visit(tremie::Archive& archive, Part& part) { archive(part.time, part.name, part.points); }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::size_t at = 0;
  const auto read = [&](void* to, std::size_t n) {
    if (n > size - at) throw std::length_error("cut");
    if (n > 0) std::memcpy(to, data + at, n);
    at += n;
  };
  tremie::Archive archive(read, size);
  std::vector<Part> parts;
  std::vector<std::string> reasons;
  std::array<std::vector<double>, 2> buffers;
  Part last;
  try {
    archive(parts, reasons, buffers, last);
  } catch (const std::length_error&) {
  }
  return 0;
}
