#include "apparatus/report/run_files/moving.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>

namespace tremie::report {
namespace {

/// Between the times that the stage has.
double turned_at(const scene::Stage& stage, double time) {
  const auto& all = stage.turned;
  const auto after = std::find_if(all.begin(), all.end(), [&](const auto& t) { return t[0] >= time; });
  if (after == all.begin() || after == all.end())
    return all.empty() ? 0.0 : (after == all.end() ? all.back() : *after)[1];
  const auto &a = *std::prev(after), &b = *after;
  return a[1] + (b[1] - a[1]) * (time - a[0]) / (b[0] - a[0]);
}

MovingFrame seen(const Frame& frame, const scene::Stage& stage, bool thixotropic) {
  MovingFrame result;
  result.time = frame.time;
  result.turned = turned_at(stage, frame.time);
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

using Places = std::vector<std::array<double, 3>>;

/// Of points that fill a space the section y = 0: of each rectangle of x and z the point that is nearest to it, so that
/// no part of the section stays empty where the points have moved apart.
std::vector<std::size_t> nearest_to_section(const Places& places, std::size_t most) {
  std::array<double, 3> low = places.front(), high = low;
  for (const auto& x : places)
    for (std::size_t d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  const double width = std::max(high[0] - low[0], 1e-9), height = std::max(high[2] - low[2], 1e-9),
               h = std::sqrt(width * height / static_cast<double>(most));
  std::map<std::pair<int, int>, std::size_t> nearest;
  for (std::size_t p = 0; p < places.size(); ++p) {
    const std::pair at{static_cast<int>((places[p][0] - low[0]) / h),
                       static_cast<int>((places[p][2] - low[2]) / h)};
    const auto [there, is_new] = nearest.try_emplace(at, p);
    if (!is_new && std::abs(places[p][1]) < std::abs(places[there->second][1])) there->second = p;
  }
  std::vector<std::size_t> chosen;
  for (const auto& [at, p] : nearest) chosen.push_back(p);
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

/// Which points of a frame stand for all.
std::vector<std::size_t> points_shown(const Places& places, std::size_t most) {
  const bool all = places.size() <= most;
  if (!all && std::any_of(places.begin(), places.end(), [](const auto& x) { return x[2] != 0.0; }) &&
      std::any_of(places.begin(), places.end(), [](const auto& x) { return x[1] != 0.0; }))
    return nearest_to_section(places, most);
  std::vector<std::size_t> chosen;
  const std::size_t every = all ? 1 : (places.size() + most - 1) / most;
  for (std::size_t p = 0; p < places.size(); p += every) chosen.push_back(p);
  return chosen;
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
  picture.turning = stage.turning, picture.full = stage.full;
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
