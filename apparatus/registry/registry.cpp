#include "apparatus/registry/registry.hpp"

#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <stdexcept>

#include "apparatus/icar_vane/outcome.hpp"
#include "apparatus/icar_vane/keys.hpp"
#include "apparatus/l_box/outcome.hpp"
#include "apparatus/l_box/keys.hpp"
#include "apparatus/scene/resolved.hpp"
#include "apparatus/slump_flow/outcome.hpp"
#include "apparatus/slump_flow/keys.hpp"

namespace tremie::scene {
namespace {

std::variant<slump_flow::Scene, l_box::Scene, icar_vane::Scene> test_of(const Loaded& loaded) {
  if (loaded.apparatus == "l_box") return l_box_scene(loaded.values);
  if (loaded.apparatus == "icar_vane") return icar_vane_scene(loaded.values);
  return slump_flow_scene(loaded.values);
}

Outcome run_test(const slump_flow::Scene& test, const Scene& scene, const Observer& observer) {
  return run_slump_flow(test, scene.measured, scene.output.frames, observer);
}

Outcome run_test(const l_box::Scene& test, const Scene& scene, const Observer& observer) {
  return run_l_box(test, scene.output.frames, observer);
}

Outcome run_test(const icar_vane::Scene& test, const Scene& scene, const Observer& observer) {
  return run_icar_vane(test, scene.output.frames, observer);
}

std::vector<std::string> uses_of(const slump_flow::Scene& test) { return slump_flow_uses(test); }
std::vector<std::string> uses_of(const l_box::Scene& test) { return l_box_uses(test); }
std::vector<std::string> uses_of(const icar_vane::Scene& test) { return icar_vane_uses(test); }

Scene build(const Loaded& loaded) {
  Scene scene;
  scene.name = loaded.name;
  scene.path = loaded.path;
  scene.apparatus = loaded.apparatus;
  scene.test = test_of(loaded);
  scene.measured = read_measured(loaded.values);
  scene.output = read_output(loaded.values);
  scene.resolved = write_resolved(loaded.schema, loaded.values);
  scene.notes = loaded.values.notes;
  for (const auto& [key, value] : loaded.values.entries)
    if (loaded.values.given(key)) scene.places[key] = describe(value.origin);
  return scene;
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
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

std::vector<ApparatusKeys> all_apparatus() { return {slump_flow_keys(), l_box_keys(), icar_vane_keys()}; }

Scene read(const std::filesystem::path& path, const std::vector<std::string>& overrides) {
  return build(load({path, overrides}, all_apparatus()));
}

Scene read_text(const std::string& text, const std::string& name, const std::vector<std::string>& overrides) {
  return build(load({name, overrides, text}, all_apparatus()));
}

void set_threads(Scene& scene, int threads) {
  std::visit([&](auto& test) { test.threads = threads; }, scene.test);
}

Outcome run(const Scene& scene, const Observer& observer) {
  const double wall = wall_seconds(), cpu = cpu_seconds();
  Outcome outcome = as_input_error(scene, [&] {
    return std::visit([&](const auto& test) { return run_test(test, scene, observer); }, scene.test);
  });
  outcome.cost.wall = wall_seconds() - wall;
  outcome.cost.cpu = cpu_seconds() - cpu;
  outcome.cost.threads = std::visit([](const auto& test) { return test.threads; }, scene.test);
  outcome.cost.peak_rss_bytes = peak_rss_bytes();
  if (outcome.status == Status::failed && outcome.checks.reasons.empty())
    outcome.checks.reasons.push_back("the run did not come to its end");
  return outcome;
}

Estimate estimate(const Scene& scene) {
  const auto estimate_test = [](const auto& test) {
    const auto e = estimate(test);  // the apparatus' own
    return Estimate{e.points, e.cells_active, e.bytes_per_point, e.steps};
  };
  return as_input_error(scene, [&] { return std::visit(estimate_test, scene.test); });
}

std::vector<std::string> uses(const Scene& scene) {
  return std::visit([](const auto& test) { return uses_of(test); }, scene.test);
}

}  // namespace tremie::scene
