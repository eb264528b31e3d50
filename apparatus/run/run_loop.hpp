#pragma once

// The one loop by which every apparatus runs its test, by implicit or explicit steps.

#include <functional>
#include <limits>
#include <optional>

#include "apparatus/common/outcome.hpp"
#include "apparatus/run/frame_times.hpp"
#include "libmpm/implicit/step.hpp"

namespace tremie::experiment {

inline constexpr double rest_speed = 1e-4;     ///< slower than this is at rest [m/s]
inline constexpr double rest_must_last = 0.5;  ///< before a flow is called stopped [s]

/// Watches for the flow to come to rest: slow, for long enough, and free to flow.
struct RestWatch {
  std::optional<double> slow_since;

  bool at_rest(bool free_to_flow, double max_speed, double time) {
    if (!free_to_flow || max_speed > rest_speed)
      slow_since.reset();
    else if (!slow_since)
      slow_since = time;
    return slow_since && time - *slow_since >= rest_must_last;
  }
};

/// One test as the loop sees it. The functions refer to the apparatus' own body, schedule and series.
struct Flow {
  double end = std::numeric_limits<double>::infinity();  ///< when the schedule has no time left [s]
  std::function<double()> time;                          ///< of the body [s]
  std::function<bool()> unfinished;                      ///< whether the schedule has time left
  std::function<void()> prepare;  ///< moves gate, cone or vane for the step to come, and bounds the step
  /// Steps to the next reading: one implicit step, or many explicit ones. Counts them.
  std::function<StepReport(Checks&, Cost&)> advance;
  std::function<Frame()> frame;            ///< the points as they are now
  std::function<Frame()> last_frame = {};  ///< the same where the body is not needed any more; may be empty
  /// Speed by which the flow is judged to be at rest [m/s], and whether anything holds it still. Empty: the
  /// test takes its whole time.
  std::function<double(const StepReport&)> speed = {};
  std::function<bool()> free_to_flow = {};
  /// Since when the readings stand still, as a laboratory would judge it [s]: rest too, where it is not empty.
  std::function<std::optional<double>()> stands_since = {};
  std::function<bool()> collapsed = {};     ///< its own weight has squeezed the body to nothing; may be empty
  std::function<bool()> gains_energy = {};  ///< more than a stable run can; may be empty
  std::function<void(bool, Checks&, Cost&)> tell =
      {};  ///< what the steps themselves were watched for; true: the flow came to rest
  /// All that goes on from one step to the next: body, schedule and series. Empty: the test keeps no checkpoints.
  VisitState state = {};
};

/// Runs the flow until its time is over, it is at rest, a step fails or somebody interrupts; `read` adds a line to the series.
/// Frames come at `next_frame` and every `frame_interval` after it [s]; 0: chosen. Returns when it came to rest [s]; empty
/// where it did not.
std::optional<double> run_loop(const Flow& flow, const std::function<void(const StepReport&)>& read,
                               const scene::Observer& observer, double frame_interval, double next_frame,
                               Status& status, Checks& checks, Cost& cost);

}  // namespace tremie::experiment
