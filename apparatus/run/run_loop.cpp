#include "apparatus/run/run_loop.hpp"

#include <omp.h>

#include <string>

#include "apparatus/run/machine/team.hpp"
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

/// Keeps, once, the state that a longer test goes on from: the end has shortened no step before it. Steps are shortened from
/// two before the end on, and grow by less than half.
struct EndWatch {
  double last = 0.025;  ///< what the last step took, or the first may [s]
  bool kept = false;

  void see(const Flow& flow, const Checkpoints* checkpoints, const VisitState& state) {
    if (kept || !checkpoints || !checkpoints->keep_for_longer || flow.end - flow.time() >= 4.0 * last) return;
    checkpoints->keep_for_longer(state);
    kept = true;  // not in what was kept: a longer test has another end
  }
};

/// The state between two steps: the flow's, the loop's own, and what was counted.
VisitState state_of(const Flow& flow, double& next_frame, RestWatch& watch, EndWatch& end, Checks& checks,
                    Cost& cost) {
  return [&](Archive& archive) {
    archive(next_frame, watch, end, checks.unconverged_steps, checks.cells_in_a_step, checks.reasons);
    archive(cost.steps, cost.cells_active);
    flow.state(archive);
  };
}

/// Steps to the next reading with as many threads as pay beside other programs.
class Pace {
 public:
  StepReport advance(const Flow& flow, Checks& checks, Cost& cost) {
    if (all_ == 1) return flow.advance(checks, cost);
    const double steps = static_cast<double>(cost.steps), begin = clock_now(), put_off = times_put_off();
    const StepReport step = flow.advance(checks, cost);
    const double solves = static_cast<double>(cost.steps) - steps + step.iterations;
    omp_set_num_threads(team_.after(solves, clock_now() - begin, times_put_off() - put_off));
    return step;
  }
  ~Pace() { omp_set_num_threads(all_); }

 private:
  int all_ = omp_get_max_threads();
  Team team_{all_};
};

}  // namespace

std::optional<double> run_loop(const Flow& flow, const std::function<void(const StepReport&)>& read,
                               const scene::Observer& observer, double frame_interval, double next_frame,
                               Status& status, Checks& checks, Cost& cost) {
  RestWatch watch;
  std::optional<double> at_rest;
  const Checkpoints* checkpoints = flow.state ? observer.checkpoints : nullptr;
  EndWatch end;
  Pace pace;
  const VisitState state = state_of(flow, next_frame, watch, end, checks, cost);
  if (goes_on(checkpoints)) checkpoints->restore(state);
  if (flow.collapsed && flow.collapsed()) status = Status::failed;
  while (status == Status::completed && !at_rest && flow.unfinished()) {
    end.see(flow, checkpoints, state);
    if (checkpoints && checkpoints->due()) checkpoints->keep(state);
    const double before = flow.time();
    flow.prepare();
    const StepReport step = pace.advance(flow, checks, cost);
    end.last = flow.time() - before;
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
