#include "apparatus/l_box/apparatus.hpp"

#include "apparatus/l_box/l_box.hpp"

namespace tremie::l_box {

scene::Apparatus apparatus() {
  return scene::make_apparatus<Scene>(
      {.keys = keys(), .words = "L-box", .headlines = headlines(), .glossary = glossary()}, read_scene, uses,
      run_and_read, estimate);
}

}  // namespace tremie::l_box
