#include "apparatus/cli/run/longer_test.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <variant>

#include "apparatus/cli/options/quantity.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/scene/document.hpp"
#include "apparatus/scene/input_error.hpp"

namespace tremie::cli {
namespace {

/// test.duration of a resolved scene [s]; empty where it has none.
std::optional<double> duration_in(const std::string& resolved) {
  const scene::Node document = scene::parse_text(resolved, "scene.toml", scene::Layer::scene);
  const scene::Node* test = scene::find(document, "test");
  const scene::Node* duration = test ? scene::find(*test, "duration") : nullptr;
  const auto* text = duration ? std::get_if<std::string>(&duration->value) : nullptr;
  return text ? std::optional(scene::parse_quantity(*text, scene::Dimension::time)) : std::nullopt;
}

/// Where the line of test.duration begins and ends in a resolved scene.
std::pair<std::size_t, std::size_t> line_of_duration(const std::string& resolved) {
  const std::size_t begin = resolved.find("\nduration = ", resolved.find("\n[test]\n")) + 1;
  return {begin, resolved.find('\n', begin)};
}

/// The resolved scene with the line that `changed` has: comments tell where the other values came from.
std::string with_duration_of(std::string resolved, const std::string& changed) {
  const auto [from, to] = line_of_duration(changed);
  const auto [begin, end] = line_of_duration(resolved);
  return resolved.replace(begin, end - begin, changed, from, to - from);
}

}  // namespace

report::RunRequest longer_test(const report::RunRequest& request, const std::string& until) {
  const std::optional<double> end = quantity("--until", until, scene::Dimension::time),
                              before = duration_in(request.resolved);
  if (!before)
    throw scene::InputError("--until: this test has no test.duration: its schedule alone says when it ends");
  if (*end <= *before)
    throw scene::InputError(
        fmt::format("--until: \"{}\" is no later than the end of the run, {:g} s", until, *before));
  const std::string change = "test.duration=" + until;
  const auto scene = scene::read_text(request.resolved, request.name, {change});
  report::RunRequest longer = request;
  longer.resolved = with_duration_of(request.resolved, scene.resolved);
  longer.command += " --set '" + change + "'";
  return longer;
}

void refuse_longer_test(const std::string& folder) {
  std::ifstream stream(std::filesystem::path(folder) / "summary.json");
  const auto summary = nlohmann::json::parse(stream, nullptr, /*allow_exceptions=*/false);
  const auto stopped_at = nlohmann::json::json_pointer("/results/stopped_at_s");
  if (summary.is_object() && summary.contains(stopped_at) && summary.at(stopped_at).is_number())
    throw scene::InputError(
        fmt::format("{}: the concrete came to rest at {:.4g} s, before the test was over: a longer one "
                    "ends there, too",
                    folder, summary.at(stopped_at).get<double>()));
  throw scene::InputError(
      fmt::format("{}: holds no finished run with the state for a longer test: none is kept with "
                  "output.checkpoint_interval = \"never\", nor of a run that failed",
                  folder));
}

}  // namespace tremie::cli
