#include "apparatus/validation/readings.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "apparatus/registry/error_estimate.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/study/rows/pool.hpp"

namespace tremie::validation {
namespace {

double result_of(const scene::Scene& scene, const std::string& name, bool coarser) {
  return scene::find_number(scene::run(scene, {}, coarser), name).value_or(NAN);
}

std::string read_one(const Ask& ask) {
  auto scene = scene::read_text(ask.scene, "validation", ask.overrides);
  scene::set_threads(scene, 1);
  scene.output.frames = false;
  const scene::Coarsening by;
  const double fine = result_of(scene, ask.result, false);
  if (!ask.with_error) return nlohmann::json{fine, 0.0}.dump();
  const double middle = result_of(scene::coarsened(scene, by.middle), ask.result, true);
  const double coarse = result_of(scene::coarsened(scene, by.coarse), ask.result, true);
  scene::Extrapolation e = scene::extrapolate(fine, middle, coarse);
  if (scene::is_doubtful(e, fine))
    e = scene::extrapolate_with_finer(result_of(scene::coarsened(scene, 1.0 / by.middle), ask.result, true),
                                      fine, middle);
  return nlohmann::json{fine, e.error}.dump();
}

}  // namespace

std::vector<Reading> read_scenes(const std::vector<Ask>& asked, const Settings& settings) {
  std::vector<std::size_t> items(asked.size());
  std::iota(items.begin(), items.end(), std::size_t{0});
  std::vector<Reading> readings(asked.size(), {NAN, NAN});
  const bool whole = study::run_pool(
      items, settings.jobs, [&](std::size_t i) { return read_one(asked[i]); },
      [&](const study::Finished& finished) {
        if (!finished.text) return;
        const auto pair = nlohmann::json::parse(*finished.text);
        if (pair[0].is_number() && pair[1].is_number())
          readings[finished.item] = {pair[0].get<double>(), pair[1].get<double>()};
      },
      settings.stop);
  if (!whole) throw Interrupted{};
  return readings;
}

}  // namespace tremie::validation
