#include "apparatus/icar_vane/apparatus.hpp"

#include "apparatus/icar_vane/icar_vane.hpp"

namespace tremie::icar_vane {

scene::Apparatus apparatus() {
  return scene::make_apparatus<Scene>(
      {.keys = keys(), .words = "vane", .headlines = headlines(), .glossary = glossary()}, read_scene, uses,
      run_and_read, estimate);
}

}  // namespace tremie::icar_vane
