// tremie check S.toml: validates, shows the resolved scene, what it carries and what it would cost.

#include <fmt/format.h>

#include <iostream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/options/json_option.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/registry/cost_estimate.hpp"
#include "apparatus/registry/machine_pace.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/compare/run_result.hpp"
#include "apparatus/run/machine/free_memory.hpp"

namespace tremie::cli {
namespace {

struct CheckOptions {
  std::string scene;
  std::vector<std::string> overrides;
  bool json = false;
};

using Json = nlohmann::ordered_json;

std::string count_text(std::int64_t n) {
  return n < 1000000000 ? fmt::format("{}", n) : fmt::format("{:.1e}", static_cast<double>(n));
}

void print_estimate(const scene::Scene& scene, const scene::SizeEstimate& e) {
  const auto cost = scene::cost_of(scene, e, scene::machine_pace(scene));
  say("\n# cost, estimated\n#   {} points, {} bytes a point\n#   {} active cells at the start\n", e.points,
      e.bytes_per_point, e.cells_active);
  say("#   about {} steps, at most some {}\n", count_text(e.steps_expected), count_text(e.steps));
  say("#   about {} of CPU ({} to {}", scene::duration_text(cost.cpu), scene::duration_text(cost.cpu_low),
      scene::duration_text(cost.cpu_high));
  if (e.steps > e.steps_expected)
    say("; up to {} if it flows on for all of test.duration", scene::duration_text(cost.cpu_most));
  say(")\n");
  say("#   about {} of memory, {} of files (each to a factor of two)\n", scene::megabytes_text(cost.memory),
      scene::megabytes_text(cost.disk));
}

Json cost_json(const scene::Scene& scene, const std::optional<scene::SizeEstimate>& e) {
  if (!e) return nullptr;
  const auto cost = scene::cost_of(scene, *e, scene::machine_pace(scene));
  return {{"points", e->points},
          {"bytes_per_point", e->bytes_per_point},
          {"cells_active", e->cells_active},
          {"steps", e->steps_expected},
          {"steps_at_most", e->steps},
          {"cpu_s", {{"value", cost.cpu}, {"low", cost.cpu_low}, {"high", cost.cpu_high}}},
          {"cpu_at_most_s", cost.cpu_most},
          {"memory_MB", cost.memory / 1e6},
          {"files_MB", cost.disk / 1e6}};
}

/// A scene's values as numbers, truths and words.
Json scene_json(const scene::Scene& scene) {
  Json json = Json::object();
  for (const auto& entry : report::scene_entries(scene.resolved, scene.path)) json[entry.key] = entry.text;
  return json;
}

void print_json(const scene::Scene& scene, const std::optional<scene::SizeEstimate>& estimate) {
  const Json json{{"schema", 1},
                  {"apparatus", scene.apparatus},
                  {"valid", true},
                  {"scene", scene_json(scene)},
                  {"uses", scene::uses(scene)},
                  {"notes", scene.notes},
                  {"cost", cost_json(scene, estimate)}};
  answer(json.dump(2) + "\n");
}

void print_text(const CheckOptions& options, const scene::Scene& scene,
                const std::optional<scene::SizeEstimate>& estimate) {
  answer(fmt::format("# {}: valid. Every value that it uses, in SI:\n\n{}",
                     options.scene == "-" ? "the scene" : options.scene, scene.resolved));
  say("\n# used and left out\n");
  for (const auto& line : scene::uses(scene)) say("#   {}\n", line);
  for (const auto& note : scene.notes) say("# note: {}\n", note);
  if (estimate) print_estimate(scene, *estimate);
}

/// "-" stands for the standard input.
scene::Scene read(const CheckOptions& options) {
  if (options.scene != "-") return scene::read(options.scene, options.overrides, "");
  const std::string text{std::istreambuf_iterator<char>(std::cin), {}};
  return scene::read_text(text, "standard input", options.overrides, "");
}

void check(const CheckOptions& options) {
  const auto scene = read(options);
  const auto estimate = scene::estimate(scene);  // refuses what the apparatus cannot run
  options.json ? print_json(scene, estimate) : print_text(options, scene, estimate);
}

}  // namespace

void add_command_check(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<CheckOptions>();
  Command command(app, "check",
                  "Check a scene; print it with all defaults, and the time and memory that it needs");
  command.required("scene", options->scene, "Scene file (TOML), or - for the standard input");
  command.overrides(options->overrides);
  add_json_option(command, options->json);
  command.example("tremie check slump.toml, or tremie new slump_flow | tremie check -");
  command.run([options, &exit_code] {
    check(*options);
    exit_code = done;
  });
}

}  // namespace tremie::cli
