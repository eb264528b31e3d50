#pragma once

// From a file to a checked scene, and from a scene to a result, in one in-process call each. What every
// command uses; an apparatus joins by one alternative of Scene::test and one branch in scene.cpp.

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "apparatus/icar_vane/icar_vane.hpp"
#include "apparatus/l_box/l_box.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::scene {

/// A checked scene.
struct Scene {
  std::string name;       ///< the file's name without .toml
  std::string path;       ///< as the user wrote it
  std::string apparatus;  ///< "slump_flow"
  std::variant<slump_flow::Scene, l_box::Scene, icar_vane::Scene> test;
  Measured measured;
  Output output;
  std::string resolved;  ///< the same scene as TOML, every value in SI; reads back to the same scene
  std::vector<std::string> notes;                          ///< what the reader left out, and why
  std::map<std::string, std::string, std::less<>> places;  ///< of the keys that were given, "mine.toml:7"
};

/// The keys of every apparatus that read() knows.
std::vector<ApparatusKeys> all_apparatus();

/// Reads and checks. `overrides` are --set arguments, "mix.yield_stress=61 Pa". Throws InputError.
Scene read(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// A scene from the text of one, for programs and tests. `name` stands for the file in messages.
Scene read_text(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {});

void set_threads(Scene& scene, int threads);

/// Runs the scene. Numerical trouble comes back in Outcome::checks. Throws InputError where the scene asks
/// for what its apparatus cannot run.
Outcome run(const Scene& scene, const Observer& observer = {});

/// Points, cells and bytes at the start and a guess of the steps.
struct Estimate {
  std::int64_t points = 0, cells_active = 0, bytes_per_point = 0, steps = 0;
};
Estimate estimate(const Scene& scene);

/// What the scene uses and what it leaves out, a line each ("flocculation: not stored, not computed").
std::vector<std::string> uses(const Scene& scene);

}  // namespace tremie::scene
