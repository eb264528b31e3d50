// The apparatus that the web page has, and what it leaves out of them.

#include <stdexcept>

#include "apparatus/parts/cone/set_up.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie {

const std::vector<scene::Apparatus>& scene::all_apparatus() {
  static const std::vector<Apparatus> all = {slump_flow::apparatus()};
  return all;
}

cone::Outcome cone::run_explicit(const Scene&, const scene::Observer&) {
  throw std::invalid_argument(
      "model.scheme: the page has implicit steps alone; give \"implicit\", or run the scene by `tremie run`");
}

}  // namespace tremie
