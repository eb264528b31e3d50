// The apparatus that the program has. The web page has a list of its own (apparatus/web/all_apparatus.cpp).

#include "apparatus/cell/apparatus.hpp"
#include "apparatus/icar_vane/apparatus.hpp"
#include "apparatus/l_box/apparatus.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/slump_flow/apparatus.hpp"

namespace tremie::scene {

const std::vector<Apparatus>& all_apparatus() {
  static const std::vector<Apparatus> all = {slump_flow::apparatus(), l_box::apparatus(),
                                             icar_vane::apparatus(), cell::apparatus()};
  return all;
}

}  // namespace tremie::scene
