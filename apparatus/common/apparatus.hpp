#pragma once

// An apparatus as the program sees it: its keys, and what can be done with a scene of it. Its folder exports
// one function that returns this, apparatus(); apparatus/registry/apparatus.cmake lists them.

#include <any>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "apparatus/common/model.hpp"
#include "apparatus/common/outcome.hpp"
#include "apparatus/common/readings.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/load.hpp"

namespace tremie::scene {

/// Points, cells and bytes at the start and a guess of the steps: at most, if the flow goes on for its whole
/// duration, and until the time at which it is expected to come to rest [s]; and the
/// CPU that a step takes by the point, as measured on the shipped scenes [s].
struct SizeEstimate {
  std::int64_t points = 0, cells_active = 0, bytes_per_point = 0, steps = 0, steps_expected = 0;
  double time_expected = 0.0, point_step = 0.0;
};

/// What a run is told beside its scene.
struct RunOptions {
  Measured measured;     ///< on the real concrete, for charts
  bool coarser = false;  ///< a run for an error estimate: its result is compared with nothing else
};

/// The functions take the apparatus' own scene as `read` returned it. `estimate`, `model` and `threads` are empty for an
/// apparatus without points (`tremie cell`).
struct Apparatus {
  ApparatusKeys keys;
  std::string words = {};                      ///< its name for people: "slump flow"
  std::vector<Headline> headlines = {};        ///< the first is the one that --accuracy is about
  std::vector<Described> glossary = {};        ///< its readings and columns
  std::function<std::any(Loaded&)> read = {};  ///< may lay further files into the values; throws InputError
  std::function<std::vector<std::string>(const std::any&)> uses = {};  ///< carried and left out, a line each
  std::function<Outcome(const std::any&, const RunOptions&, const Observer&)> run = {};
  std::function<SizeEstimate(const std::any&)> estimate = {};
  std::function<Model&(std::any&)> model = {};
  std::function<int&(std::any&)> threads = {};
};

/// The apparatus of a table of readings and of tables of columns: what of it is no function.
template <class View, class... Columns>
Apparatus apparatus_of(ApparatusKeys keys, std::string words, const std::vector<Reading<View>>& readings,
                       const Columns&... columns) {
  return {.keys = std::move(keys),
          .words = std::move(words),
          .headlines = headlines_of(readings),
          .glossary = described(readings, columns...)};
}

/// Fills the functions for a Scene that has the members `model` and `threads`.
template <class TestScene, class Read, class Uses, class Run, class EstimateCost>
Apparatus make_apparatus(Apparatus named, Read read, Uses uses, Run run, EstimateCost estimate) {
  const auto own = [](const std::any& scene) -> const TestScene& {
    return *std::any_cast<TestScene>(&scene);
  };
  named.read = [read](Loaded& loaded) -> std::any { return read(loaded.values); };
  named.uses = [own, uses](const std::any& scene) { return uses(own(scene)); };
  named.run = [own, run](const std::any& scene, const RunOptions& options, const Observer& observer) {
    return run(own(scene), options, observer);
  };
  named.estimate = [own, estimate](const std::any& scene) { return estimate(own(scene)); };
  named.model = [](std::any& scene) -> Model& { return std::any_cast<TestScene>(&scene)->model; };
  named.threads = [](std::any& scene) -> int& { return std::any_cast<TestScene>(&scene)->threads; };
  return named;
}

}  // namespace tremie::scene
