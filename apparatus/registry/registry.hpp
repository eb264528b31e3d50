#pragma once

// From a file to a checked scene, and from a scene to a result, in one in-process call each. What every
// command uses; an apparatus joins by its name in apparatus.cmake.

#include <any>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/apparatus.hpp"
#include "apparatus/common/model.hpp"
#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/load.hpp"

namespace tremie::scene {

/// A checked scene.
struct Scene {
  std::string name;                      ///< the file's name without .toml
  std::string path;                      ///< as the user wrote it
  std::string apparatus;                 ///< "slump_flow"
  const Apparatus* functions = nullptr;  ///< of that apparatus
  std::any test;                         ///< the apparatus' own scene
  Measured measured;
  Output output;
  std::string resolved;  ///< the same scene as TOML, every value in SI; reads back to the same scene
  std::vector<std::filesystem::path> files;                ///< that it was read from
  std::vector<std::string> notes;                          ///< what the reader left out, and why
  std::map<std::string, std::string, std::less<>> places;  ///< of the keys that were given, "mine.toml:7"
};

/// Every apparatus.
const std::vector<Apparatus>& all_apparatus();

/// The keys of each.
std::vector<ApparatusKeys> all_keys();

/// Reads and checks a scene that this command of tremie runs; empty: any. `overrides` are --set arguments,
/// "mix.yield_stress=61 Pa". Throws InputError.
Scene read(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
           const std::string& command = "run");

/// A scene from the text of one, for programs and tests. `name` stands for the file in messages.
Scene read_text(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {}, const std::string& command = "run");

/// OpenMP threads of the scene's run, at least 1; a scene that was read has one.
void set_threads(Scene& scene, int threads);

/// As many threads as pay for the scene's size on this machine.
int default_threads(const Scene& scene);

/// The options of the model; the apparatus must have points.
const Model& model_of(const Scene& scene);
Model& model_of(Scene& scene);

/// Runs the scene. Numerical trouble comes back in Outcome::checks. Throws InputError where the scene asks
/// for what its apparatus cannot run. `coarser`: for an error estimate (RunOptions).
Outcome run(const Scene& scene, const Observer& observer = {}, bool coarser = false);

/// Empty for an apparatus without points. Throws InputError as run() does.
std::optional<SizeEstimate> estimate(const Scene& scene);

/// What the scene uses and what it leaves out, a line each ("flocculation: not stored, not computed").
std::vector<std::string> uses(const Scene& scene);

}  // namespace tremie::scene
