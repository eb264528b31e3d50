#include "apparatus/report/run_files/moving.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace tremie::report {
namespace {

MovingFrame seen(const Frame& frame, const scene::Stage& stage, bool thixotropic) {
  MovingFrame result;
  result.time = frame.time;
  result.values.resize(thixotropic ? 2 : 1);
  const auto at = [](const std::array<double, 3>& x, int d) { return x[static_cast<std::size_t>(d)]; };
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    const auto& x = frame.position[p];
    if (stage.slice > 0.0 && std::abs(at(x, stage.depth)) > stage.slice) continue;
    result.places.push_back({static_cast<float>(at(x, stage.across)), static_cast<float>(at(x, stage.up))});
    result.values[0].push_back(p < frame.shear_rate.size() ? static_cast<float>(frame.shear_rate[p]) : 0.0F);
    if (thixotropic) result.values[1].push_back(static_cast<float>(frame.flocculation[p]));
  }
  return result;
}

/// Which points of a frame stand for all: those next to y = 0 where they fill a space, then evenly every so many.
std::vector<std::size_t> points_shown(const std::vector<std::array<double, 3>>& x, std::size_t most) {
  std::vector<std::size_t> chosen(x.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  if (chosen.size() <= most) return chosen;
  std::vector<double> depth;
  for (const auto& p : x) depth.push_back(std::abs(p[1]));
  std::nth_element(depth.begin(), depth.begin() + static_cast<std::ptrdiff_t>(most - 1), depth.end());
  const bool space = std::any_of(x.begin(), x.end(), [](const auto& p) { return p[2] != 0.0; });
  if (space) std::erase_if(chosen, [&](std::size_t p) { return std::abs(x[p][1]) > depth[most - 1]; });
  const std::size_t every = (chosen.size() + most - 1) / most;
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < chosen.size(); i += every) result.push_back(chosen[i]);
  return result;
}

Frame thin_frame(const Frame& frame, std::size_t most) {
  Frame thin;
  thin.time = frame.time;
  for (const std::size_t p : points_shown(frame.position, most)) {
    thin.position.push_back(frame.position[p]);
    if (p < frame.shear_rate.size()) thin.shear_rate.push_back(frame.shear_rate[p]);
    if (p < frame.flocculation.size()) thin.flocculation.push_back(frame.flocculation[p]);
  }
  return thin;
}

}  // namespace

void ShownFrames::add(const Frame& frame) {
  if (!kept_.empty() && kept_.back().time == frame.time) return;
  if (last_is_extra_) kept_.pop_back();
  if (kept_.size() + 1 >= most_frames) {  // every second of the kept ones goes
    std::vector<Frame> half;
    for (std::size_t i = 0; i < kept_.size(); i += 2) half.push_back(std::move(kept_[i]));
    kept_ = std::move(half);
    stride_ *= 2;
  }
  last_is_extra_ = came_ % stride_ != 0;
  kept_.push_back(thin_frame(frame, most_points));
  ++came_;
}

MovingPicture moving_picture(const scene::Outcome& outcome, const std::vector<Frame>& frames) {
  MovingPicture picture;
  if (!outcome.stage || frames.empty()) return picture;
  const scene::Stage& stage = *outcome.stage;
  const bool thixotropic =
      std::all_of(frames.begin(), frames.end(), [](const Frame& f) { return !f.flocculation.empty(); });
  picture.caption = "The concrete over time; what was computed, point by point.";
  picture.fixed = stage.walls, picture.lifted = stage.lifted;
  picture.lift_speed = stage.lift_speed, picture.mirrored = stage.mirrored;
  for (const Frame& frame : frames) picture.frames.push_back(seen(frame, stage, thixotropic));
  picture.fields = {{"shear rate", "1/s", 0.01, 10.0, true}};
  if (thixotropic) {
    double most = 1e-3;
    for (const Frame& frame : frames)
      for (const double v : frame.flocculation) most = std::max(most, std::isfinite(v) ? v : 0.0);
    picture.fields.push_back({"flocculation state λ", "", 0.0, most, false});
  }
  return picture;
}

}  // namespace tremie::report
