#include "apparatus/run/run_loop.hpp"

#include <string>

#include "libmpm/body/archive.hpp"

namespace tremie::experiment {
namespace {

/// Ends a run whose last step failed: the points are where they were before it.
bool gave_up(const StepReport& step, Status& status, Checks& checks, double time) {
  if (!step.failed) return false;
  status = Status::failed;
  checks.reasons.push_back("the velocities ran away at " + std::to_string(time) + " s; the run ends there");
  return true;
}

/// Since when the flow rests; empty while it moves.
std::optional<double> rests_since(const Flow& flow, const StepReport& step, RestWatch& watch) {
  if (flow.speed && watch.at_rest(flow.free_to_flow(), flow.speed(step), flow.time()))
    return watch.slow_since;
  return flow.stands_since && flow.free_to_flow() ? flow.stands_since() : std::nullopt;
}

/// The state between two steps: the flow's, the loop's own, and what was counted.
VisitState state_of(const Flow& flow, double& next_frame, RestWatch& watch, Checks& checks, Cost& cost) {
  return [&](Archive& archive) {
    archive(next_frame, watch, checks.unconverged_steps, checks.cells_in_a_step, checks.reasons);
    archive(cost.steps, cost.cells_active);
    flow.state(archive);
  };
}

}  // namespace

std::optional<double> run_loop(const Flow& flow, const std::function<void(const StepReport&)>& read,
                               const scene::Observer& observer, double frame_interval, double next_frame,
                               Status& status, Checks& checks, Cost& cost) {
  RestWatch watch;
  std::optional<double> at_rest;
  const Checkpoints* checkpoints = flow.state ? observer.checkpoints : nullptr;
  const VisitState state = state_of(flow, next_frame, watch, checks, cost);
  if (goes_on(checkpoints)) checkpoints->restore(state);
  if (flow.collapsed && flow.collapsed()) status = Status::failed;
  while (status == Status::completed && !at_rest && flow.unfinished()) {
    if (checkpoints && checkpoints->due()) checkpoints->keep(state);
    flow.prepare();
    const StepReport step = flow.advance(checks, cost);
    if (gave_up(step, status, checks, flow.time())) break;
    read(step);
    at_rest = rests_since(flow, step, watch);
    if (observer.interrupted && *observer.interrupted) status = Status::interrupted;
    if (flow.gains_energy && flow.gains_energy()) status = Status::failed;
    if (flow.collapsed && flow.collapsed()) status = Status::failed;
    if (observer.on_frame && observer.all_frames && flow.time() >= next_frame) {
      observer.on_frame(flow.frame());
      next_frame = frame_after(next_frame, frame_interval);
    }
  }
  if (checkpoints && status == Status::interrupted && !at_rest && flow.unfinished()) checkpoints->keep(state);
  return at_rest;
}

}  // namespace tremie::experiment
