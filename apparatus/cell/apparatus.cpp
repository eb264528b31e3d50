#include "apparatus/cell/apparatus.hpp"

#include <fmt/format.h>

#include "apparatus/cell/cell.hpp"

namespace tremie::cell {
namespace {

std::vector<std::string> uses(const std::any& any_scene) {
  const MaterialCell& cell = std::any_cast<Scene>(&any_scene)->cell;
  return {fmt::format("{} pieces of the history; no points, no grid", cell.history.size()),
          fmt::format("flocculation: {}",
                      cell.mix.thixotropy ? "computed, and by CVODE beside it" : "not computed")};
}

}  // namespace

scene::Apparatus apparatus() {
  return {.keys = keys(),
          .words = "material cell",
          .glossary = glossary(),
          .read = [](scene::Loaded& loaded) -> std::any { return build(loaded); },
          .uses = uses,
          .run =
              [](const std::any& scene, const scene::RunOptions&, const scene::Observer&) {
                const Scene& own = *std::any_cast<Scene>(&scene);
                return outcome(own, run(own));
              }};
}

}  // namespace tremie::cell
