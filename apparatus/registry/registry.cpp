#include "apparatus/registry/registry.hpp"

#include <algorithm>
#include <stdexcept>

#include "apparatus/registry/usual_ranges.hpp"
#include "apparatus/run/machine/free_processors.hpp"
#include "apparatus/run/machine/stopwatch.hpp"
#include "apparatus/run/machine/threads.hpp"
#include "apparatus/scene/resolved.hpp"

namespace tremie::scene {
namespace {

const Apparatus& apparatus_named(const std::string& name) {
  const auto& all = all_apparatus();
  return *std::find_if(all.begin(), all.end(), [&](const Apparatus& a) { return a.keys.name == name; });
}

Scene build(Loaded loaded) {
  Scene scene;
  scene.name = loaded.name;
  scene.path = loaded.path;
  scene.apparatus = loaded.apparatus;
  scene.functions = &apparatus_named(loaded.apparatus);
  scene.test = scene.functions->read(loaded);
  scene.measured = read_measured(loaded.values);
  if (loaded.values.has("output.frames")) scene.output = read_output(loaded.values);
  scene.resolved = write_resolved(loaded.schema, loaded.values);
  scene.notes = loaded.values.notes;
  const auto unusual = unusual_values(loaded.schema, loaded.values);
  scene.notes.insert(scene.notes.end(), unusual.begin(), unusual.end());
  if (const std::string soft = softness(loaded.values); !soft.empty()) scene.notes.push_back(soft);
  scene.files = loaded.files;
  for (const auto& [key, value] : loaded.values.entries)
    if (loaded.values.given(key)) scene.places[key] = describe(value.origin);
  return scene;
}

/// An apparatus says with std::invalid_argument that it cannot run what the scene asks for, "key: reason":
/// the user's to mend, where the key was given.
template <class Call>
auto as_input_error(const Scene& scene, Call call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    const std::string_view text = error.what();
    const auto place = scene.places.find(text.substr(0, text.find(':')));
    throw InputError((place == scene.places.end() ? scene.path : place->second) + ": " + error.what());
  }
}

}  // namespace

std::vector<ApparatusKeys> all_keys() {
  std::vector<ApparatusKeys> keys;
  for (const Apparatus& apparatus : all_apparatus()) keys.push_back(apparatus.keys);
  return keys;
}

Scene read(const std::filesystem::path& path, const std::vector<std::string>& overrides,
           const std::string& command) {
  return build(load({path, overrides}, all_keys(), command));
}

Scene read_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides,
                const std::string& command) {
  return build(load({name, overrides, text}, all_keys(), command));
}

void set_threads(Scene& scene, int threads) { scene.functions->threads(scene.test) = threads; }

int default_threads(const Scene& scene) {
  const SpaceKind space = model_of(scene).space;
  if (!experiment::is_3d(space)) return 1;  // spares the estimate
  return experiment::default_threads(estimate(scene)->points, space, model_of(scene).scheme,
                                     experiment::free_processors());
}

Model& model_of(Scene& scene) { return scene.functions->model(scene.test); }
const Model& model_of(const Scene& scene) { return model_of(const_cast<Scene&>(scene)); }

Outcome run(const Scene& scene, const Observer& observer, bool coarser) {
  const Stopwatch watch;
  Observer own = observer;
  own.all_frames = scene.output.frames;
  Outcome outcome = as_input_error(scene, [&] {
    return scene.functions->run(scene.test, {scene.measured, coarser}, own);
  });
  outcome.apparatus = scene.apparatus;
  watch.stop(outcome.cost);
  if (scene.functions->threads)
    outcome.cost.threads = scene.functions->threads(const_cast<Scene&>(scene).test);
  if (outcome.checks.stood_still)
    outcome.lines.push_back("moved           no: the concrete stands as it was filled in");
  if (outcome.status == Status::failed && outcome.checks.reasons.empty())
    outcome.checks.reasons.push_back("the run did not come to its end");
  return outcome;
}

std::optional<SizeEstimate> estimate(const Scene& scene) {
  if (!scene.functions->estimate) return std::nullopt;
  return as_input_error(scene, [&] { return scene.functions->estimate(scene.test); });
}

std::vector<std::string> uses(const Scene& scene) { return scene.functions->uses(scene.test); }

}  // namespace tremie::scene
