#pragma once

// An experiment from its first line to its last frame: what every apparatus does around the loop.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "apparatus/run/frames.hpp"
#include "apparatus/run/record.hpp"
#include "apparatus/run/run_checks.hpp"
#include "apparatus/run/run_loop.hpp"
#include "apparatus/run/step_settings.hpp"

namespace tremie::experiment {

/// How long an experiment takes at most and who sees what of it.
template <class Sample>
struct Showing {
  double duration = 0.0, frame_interval = 0.0;  ///< [s]; interval 0: chosen (frame_times.hpp)
  std::string (*progress)(const Sample&);       ///< "spread 412 mm"
  bool from_start = true;  ///< whether the series and the frames begin before the first step
};

/// The first line of the series and the first frame, of the body at rest. run_experiment() does it where it was not done: a body
/// that is to be laid out otherwise shows them before.
template <class Geometry, class RecordOfRun, class Read>
void show_start(const Body<Geometry>& body, const scene::Observer& observer, Read read, RecordOfRun& record) {
  record.series.push_back(read(StepReport{}));
  if (observer.on_frame && observer.all_frames && !goes_on(observer.checkpoints))
    observer.on_frame(frame_of(body));
}

/// Runs the flow. `read(step)` makes a line of the series, `finish(stopped_at)` reads the results at the end, from the body too,
/// and adds the apparatus' own reasons to those that are judged here.
template <class Geometry, class RecordOfRun, class Read, class Finish>
void run_experiment(const Flow& flow, Body<Geometry>& body,
                    const Showing<typename RecordOfRun::Sample>& showing, const scene::Observer& observer,
                    Read read, Finish finish, RecordOfRun& record) {
  const double start_mass = total_mass(body.points), start_volume_change = volume_change(body.points),
               start_height = mean_height(body.points);
  if (showing.from_start && record.series.empty()) show_start(body, observer, read, record);
  Squeeze squeeze;
  squeeze.see(start_volume_change, 0.0);
  Flow watched = flow;
  watched.end = showing.duration;
  watched.collapsed = [&] { return squeeze.collapsed(); };
  const auto read_and_show = [&](const StepReport& step) {
    squeeze.see(volume_change(body.points), body.time);
    const auto& sample = record.series.emplace_back(read(step));
    if (observer.on_progress)
      observer.on_progress({sample.time, showing.duration, sample.time_step, showing.progress(sample)});
  };
  const auto stopped_at = run_loop(watched, read_and_show, observer, showing.frame_interval,
                                   showing.from_start ? frame_after(0.0, showing.frame_interval) : 0.0,
                                   record.status, record.checks, record.cost);
  if (record.series.empty()) record.series.emplace_back();  // the first step failed
  if (flow.tell) flow.tell(stopped_at.has_value(), record.checks, record.cost);
  judge(body, start_mass, record.checks, record.cost);
  judge_squeeze(squeeze, body.mix, 2.0 * start_height, record.checks);
  if (showing.from_start) judge_volume(start_volume_change, record.checks);
  // One that is so viscous that it has hardly set out moves on; what stands swings by less.
  const double way = std::sqrt(2.0 * kinetic_energy(body.points) / total_mass(body.points)) * body.time;
  record.checks.stood_still = showing.from_start && way < 5e-4 * start_height &&
                              std::abs(mean_height(body.points) / start_height - 1.0) < 0.01;
  finish(stopped_at);
  record.final_frame = flow.last_frame ? flow.last_frame() : flow.frame();
  if (observer.on_frame) observer.on_frame(record.final_frame);
}

/// Whether the schedule of a flow of this duration has time left [s].
inline bool has_time_left(double time, double duration) { return time < duration * (1.0 - 1e-12); }

}  // namespace tremie::experiment
