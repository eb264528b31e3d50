// Whatever a scene holds, it is read or refused; what was read is written so that it reads back to the same.

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/l_box/l_box.hpp"
#include "apparatus/parts/cone/readings.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/resolved.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace {

using namespace tremie::scene;

/// The values without the comments that say where each came from.
std::string without_comments(const std::string& text) {
  std::string bare;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    line = line.substr(0, line.rfind(" # "));
    bare += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    at = end + 1;
  }
  return bare;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::array<ApparatusKeys, 3> known{tremie::slump_flow::keys(), tremie::l_box::keys(),
                                                  tremie::icar_vane::keys()};
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const Loaded loaded = load({"fuzzed.toml", {}, text}, known);
    if (loaded.apparatus == "slump_flow") tremie::cone::read_scene(loaded.values);
    if (loaded.apparatus == "l_box") tremie::l_box::read_scene(loaded.values);
    if (loaded.apparatus == "icar_vane") tremie::icar_vane::read_scene(loaded.values);
    const std::string resolved = write_resolved(loaded.schema, loaded.values);
    const Loaded again = load({"resolved.toml", {}, resolved}, known);
    if (without_comments(write_resolved(again.schema, again.values)) != without_comments(resolved))
      std::abort();
  } catch (const InputError&) {
  }
  return 0;
}
