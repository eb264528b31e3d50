#include "apparatus/registry/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

namespace tremie::scene {
namespace {

constexpr double safety = 1.25, least_share = 1e-3, doubtful_share = 0.1;
/// Walls and free surfaces lie between the nodes: a higher order over three grids is luck.
constexpr double highest_order = 1.0;
/// A run's cost over the size of its cells: as many more steps, and points to the power of 1.2 in the plane.
constexpr double cost_exponent = 3.0;

/// A line of cells costs less than a plane, but hardly less where it is a little coarser: its grids lie
/// farther apart, so that the bar costs no more.
Coarsening coarsening_of(const Scene& scene) {
  const bool line = model_of(scene).space == SpaceKind::couette;
  return line ? Coarsening{2.0, 3.0} : Coarsening{};
}

/// The order p of f = f_0 + c h^p over h, m h and c h: (c^p - m^p)/(m^p - 1) = ratio, growing with p.
double order_from(double ratio, const Coarsening& by) {
  double low = 0.01, high = 20.0;
  for (int i = 0; i < 60; ++i) {
    const double p = 0.5 * (low + high), m = std::pow(by.middle, p);
    ((std::pow(by.coarse, p) - m) / (m - 1.0) < ratio ? low : high) = p;
  }
  return 0.5 * (low + high);
}

/// Such a run shows its progress alone: its frames, and what it would be compared with, are nobody's.
Outcome run_with_cells(const Scene& scene, double ratio, const Observer& observer) {
  Observer quiet;
  quiet.on_progress = observer.on_progress;
  quiet.interrupted = observer.interrupted;
  return run(coarsened(scene, ratio), quiet, true);
}

/// Finer cells may be more than a scene allows; the bar then comes from the coarser grids.
std::optional<Outcome> run_on_finer_grid(const Scene& scene, double ratio, const Observer& observer) {
  try {
    return run_with_cells(scene, ratio, observer);
  } catch (const InputError&) {
    return {};
  }
}

/// Outcomes of three grids, the finest first; the first or the second is the run that the bars are for.
struct Grids {
  const Outcome* finer = nullptr;
  const Outcome *fine, *middle, *coarse;
};

/// Nothing where one of the grids does not read the number.
std::optional<Extrapolation> extrapolate_of(const std::string& name, const Grids& grids,
                                            const Coarsening& by) {
  const auto f = find_number(*grids.fine, name), m = find_number(*grids.middle, name);
  const auto other = find_number(grids.finer ? *grids.finer : *grids.coarse, name);
  if (!f || !m || !other) return {};
  return grids.finer ? extrapolate_with_finer(*other, *f, *m, by) : extrapolate(*f, *m, *other, by);
}

std::string basis_of(const Headline& headline, const Extrapolation& e, bool finer) {
  return (e.richardson ? fmt::format("{}: Richardson, order {:.1f}", headline.name, e.order)
                       : fmt::format("{}: spread of three grids", headline.name)) +
         (finer ? ", one finer" : "");
}

}  // namespace

Extrapolation extrapolate(double fine, double middle, double coarse, const Coarsening& by) {
  const double near = fine - middle, far = middle - coarse;
  const auto [low, high] = std::minmax({fine, middle, coarse});
  Extrapolation e;
  e.error = safety * (high - low);
  if (near * far > 0.0) {
    e.order = order_from(far / near, by);
    e.richardson = e.order >= 0.5 && e.order <= 4.0;
    if (e.richardson)
      e.error = safety * std::abs(near) / (std::pow(by.middle, std::min(e.order, highest_order)) - 1.0);
  }
  e.error = std::max(e.error, least_share * std::abs(fine));
  return e;
}

bool is_doubtful(const Extrapolation& three, double fine) {
  return !three.richardson && three.error > doubtful_share * std::abs(fine);
}

Extrapolation extrapolate_with_finer(double finer, double fine, double middle, const Coarsening& by) {
  Extrapolation e = extrapolate(finer, fine, middle, {by.middle, by.middle * by.middle});
  if (e.richardson) e.error += std::abs(finer - fine);
  return e;
}

Scene coarsened(const Scene& scene, double ratio) {
  Scene result = scene;
  Model& model = model_of(result);
  for (double& h : model.cell) h *= ratio;
  if (model.time_step) *model.time_step *= ratio;
  model.step_scale *= ratio;
  return result;
}

ErrorEstimate estimate_error(const Scene& scene, const Outcome& outcome, const Observer& observer) {
  ErrorEstimate estimate;
  if (outcome.status != Status::completed) {
    estimate.basis = "none: the run did not come to its end";
    return estimate;
  }
  const Coarsening by = coarsening_of(scene);
  try {
    const Outcome middle = run_with_cells(scene, by.middle, observer);
    const Outcome coarse = run_with_cells(scene, by.coarse, observer);
    estimate.cpu = middle.cost.cpu + coarse.cost.cpu;
    if (middle.status != Status::completed || coarse.status != Status::completed) {
      estimate.basis = "none: a coarser run did not come to its end";
      return estimate;
    }
    Grids grids{nullptr, &outcome, &middle, &coarse};
    const std::vector<Headline>& headlines = scene.functions->headlines;
    const auto first = headlines.empty() ? std::nullopt : extrapolate_of(headlines.front().name, grids, by);
    std::optional<Outcome> finer;
    if (first && is_doubtful(*first, *find_number(outcome, headlines.front().name))) {
      finer = run_on_finer_grid(scene, 1.0 / by.middle, observer);
      if (finer) estimate.cpu += finer->cost.cpu;
      if (finer && finer->status == Status::completed) grids.finer = &*finer;
    }
    for (const Headline& headline : headlines) {
      const auto e = extrapolate_of(headline.name, grids, by);
      if (!e) continue;
      estimate.bars.push_back({headline.name, e->error});
      estimate.basis += (estimate.basis.empty() ? "" : "; ") + basis_of(headline, *e, grids.finer);
    }
    if (estimate.bars.empty()) estimate.basis = "none: a coarser run does not reach this reading";
  } catch (const InputError& error) {
    estimate.basis = fmt::format("none: {}", error.what());
  }
  return estimate;
}

Choice choose_cells(const Scene& scene, double accuracy, const Observer& observer) {
  std::array<Outcome, 3> pilots;
  Choice choice;
  for (std::size_t i = 0; i < 3; ++i) {
    pilots[i] = run_with_cells(scene, 2.0 + static_cast<double>(i), observer);
    choice.pilot_cpu += pilots[i].cost.cpu;
  }
  const auto headline = scene.functions->headlines.front();
  std::array<double, 3> value{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto number = find_number(pilots[i], headline.name);
    if (!number)
      throw InputError(fmt::format("--accuracy: coarser cells give no {}: set model.cell", headline.word));
    value[i] = *number;
  }
  // 2 h, 3 h and 4 h are to each other as h, 1.5 h and 2 h. Where no order is seen, the first is assumed.
  const Extrapolation e = extrapolate(value[0], value[1], value[2]);
  const double order = e.richardson ? std::min(e.order, highest_order) : 1.0;
  const double wanted = accuracy * std::abs(value[0]) / e.error;
  choice.factor = std::clamp(2.0 * std::pow(wanted, 1.0 / order), 0.2, 2.0);
  const double cost = pilots[0].cost.cpu * std::pow(2.0 / choice.factor, cost_exponent);
  choice.cpu = 1.5 * cost;
  return choice;
}

std::string cells_override(const Scene& scene, double ratio) {
  const auto cell = model_of(scene).cell;
  const double across = 1e3 * ratio * cell[0], up = 1e3 * ratio * cell[1];
  if (cell[0] == cell[1]) return fmt::format("model.cell=\"{:.4g} mm\"", across);
  return fmt::format("model.cell=[\"{:.4g} mm\", \"{:.4g} mm\"]", across, up);
}

std::vector<std::string> error_lines(const Scene& scene, const Outcome& outcome) {
  std::vector<std::string> lines;
  if (!outcome.error) return lines;
  for (const ErrorBar& bar : outcome.error->bars)
    for (const Headline& headline : scene.functions->headlines)
      if (bar.name == headline.name)
        lines.push_back(fmt::format("{} {:.{}f} ± {:.{}f} {}", headline.word,
                                    find_number(outcome, bar.name).value_or(0.0), headline.digits, bar.error,
                                    headline.digits, unit_for_people(headline.name)));
  lines.push_back(fmt::format("by {}; {:.2f} s of CPU", outcome.error->basis, outcome.error->cpu));
  return lines;
}

}  // namespace tremie::scene
