#include "apparatus/registry/cost_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/run/frame_times.hpp"
#include "apparatus/run/machine/free_memory.hpp"
#include "apparatus/run/machine/threads.hpp"

namespace tremie::scene {
namespace {

constexpr double factor = 2.0,
                 factor_here = 1.5;     ///< that the seconds are good to, without and with the machine's pace
constexpr double start_and_end = 0.09;  ///< CPU of reading, charts and files [s]
constexpr double program = 21e6;        ///< memory without points [bytes]
constexpr double page = 0.5e6;          ///< of files without frames [bytes]
constexpr double frame_of_point = 85.0;  ///< in frames/ and results.h5 [bytes]
constexpr double most_shown = 20000.0;   ///< points of a frame
constexpr double solver_of_cell =
    12e3;                             ///< of the linear system without a matrix, in three dimensions [bytes]
constexpr double longest = 86400.0;   ///< run that begins without being asked twice [s]
constexpr double most_counted = 1e6;  ///< frames

/// Frames that are written over a time, as run_loop takes them and the files thin them.
double frames_over(const Scene& scene, double time, double points) {
  if (!scene.output.frames) return 0.0;
  const double interval = scene.output.frame_interval;
  if (interval > 0.0) return std::floor(time / interval) + 2.0;
  double n = 1.0;
  for (double t = 0.0; t < time && n < most_counted; t = experiment::frame_after(t, 0.0)) n += 1.0;
  return std::ceil(n / (points > 20000.0 ? 3.0 : 2.0)) + 1.0;
}

}  // namespace

CostEstimate cost_of(const Scene& scene, const SizeEstimate& e, std::optional<double> pace) {
  const auto points = static_cast<double>(e.points);
  const double per_step = points * e.point_step * pace.value_or(1.0), good_to = pace ? factor_here : factor;
  CostEstimate cost;
  cost.cpu = start_and_end + per_step * static_cast<double>(e.steps_expected);
  cost.cpu_low = cost.cpu / good_to, cost.cpu_high = cost.cpu * good_to;
  cost.cpu_most = good_to * (start_and_end + per_step * static_cast<double>(e.steps));
  const bool explicit_scheme = model_of(scene).scheme != SchemeKind::implicit;
  const bool space = experiment::is_3d(model_of(scene).space);
  const double shown_and_solver = explicit_scheme ? 320.0 : space ? 150.0 : 500.0;
  cost.memory = program + points * (static_cast<double>(e.bytes_per_point) + shown_and_solver);
  if (space && !explicit_scheme) cost.memory += solver_of_cell * static_cast<double>(e.cells_active);
  cost.disk =
      page + frame_of_point * std::min(points, most_shown) * frames_over(scene, e.time_expected, points);
  return cost;
}

std::string objection(const CostEstimate& cost, double free_memory, int threads) {
  if (cost.memory > free_memory)
    return fmt::format(
        "needs about {} of memory (to a factor of {:g}), and {} are free: larger cells (model.cell) or fewer "
        "model.points_per_cell",
        megabytes_text(cost.memory), factor, megabytes_text(free_memory));
  if (cost.cpu > longest * threads)
    return fmt::format(
        "takes about {} (to a factor of {:g}): larger cells (model.cell), or a shorter test.duration",
        duration_text(cost.cpu / threads), factor);
  return {};
}

void check_cost(const Scene& scene, int threads) {
  const auto e = estimate(scene);
  if (!e) return;
  const std::string against =
      objection(cost_of(scene, *e), experiment::free_memory(std::max(1, threads)), std::max(1, threads));
  if (!against.empty()) throw InputError(fmt::format("{}: the run {}; --force runs it", scene.path, against));
}

std::string duration_text(double s) {
  if (s < 300.0) return rounded(s, 2) + " s";
  if (s < 7200.0) return fmt::format("{:.0f} min", s / 60.0);
  if (s < 2e5) return fmt::format("{:.0f} h", s / 3600.0);
  if (s < 3.2e7) return fmt::format("{:.0f} days", s / 86400.0);
  return "more than a year";
}

std::string megabytes_text(double bytes) {
  return bytes < 1e10 ? rounded(bytes / 1e6, 2) + " MB" : fmt::format("{:.3g} GB", bytes / 1e9);
}

}  // namespace tremie::scene
