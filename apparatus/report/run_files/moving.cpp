#include "apparatus/report/run_files/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
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

/// A number of the points that colours them.
struct ShownField {
  std::vector<double> Frame::*values;
  ColourField colours;
  double factor = 1.0;
};

double largest(const std::vector<Frame>& frames, std::vector<double> Frame::*values) {
  double most = 1e-3;
  for (const Frame& frame : frames)
    for (const double v : frame.*values) most = std::max(most, std::isfinite(v) ? v : 0.0);
  return most;
}

/// What colours the points, the first at first: their loads where these are told apart, or the shear rate.
std::vector<ShownField> fields_of(const std::vector<Frame>& frames) {
  const auto all_have = [&](std::vector<double> Frame::*values) {
    return std::all_of(frames.begin(), frames.end(), [&](const Frame& f) { return !(f.*values).empty(); });
  };
  std::vector<ShownField> fields;
  if (all_have(&Frame::load)) {
    constexpr double minutes = 1.0 / 60.0;
    fields.push_back({&Frame::load, {"load", "", 0.0, largest(frames, &Frame::load), false}});
    fields.push_back(
        {&Frame::age, {"age", "min", 0.0, minutes * largest(frames, &Frame::age), false}, minutes});
  }
  fields.push_back({&Frame::shear_rate, {"shear rate", "1/s", 0.01, 10.0, true}});
  if (all_have(&Frame::flocculation))
    fields.push_back({&Frame::flocculation,
                      {"flocculation state λ", "", 0.0, largest(frames, &Frame::flocculation), false}});
  return fields;
}

MovingFrame seen(const Frame& frame, const scene::Stage& stage, const std::vector<ShownField>& fields) {
  MovingFrame result;
  result.time = frame.time;
  result.turned = turned_at(stage, frame.time);
  result.values.resize(fields.size());
  const auto at = [](const std::array<double, 3>& x, int d) { return x[static_cast<std::size_t>(d)]; };
  for (std::size_t p = 0; p < frame.position.size(); ++p) {
    const auto& x = frame.position[p];
    if (stage.slice > 0.0 && std::abs(at(x, stage.depth)) > stage.slice) continue;
    result.places.push_back({static_cast<float>(at(x, stage.across)), static_cast<float>(at(x, stage.up))});
    for (std::size_t i = 0; i < fields.size(); ++i) {
      const auto& values = frame.*fields[i].values;
      result.values[i].push_back(p < values.size() ? static_cast<float>(fields[i].factor * values[p]) : 0.0F);
    }
  }
  return result;
}

using Places = std::vector<std::array<double, 3>>;

bool fills_space(const Places& places) {
  return std::any_of(places.begin(), places.end(), [](const auto& x) { return x[2] != 0.0; }) &&
         std::any_of(places.begin(), places.end(), [](const auto& x) { return x[1] != 0.0; });
}

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

/// How many squares of a section hold some of every k-th point. By floats, as a resumed run has them.
std::size_t squares_held(const Places& places, std::size_t every, double square) {
  std::set<std::array<int, 3>> held;
  const auto at = [square](double x) { return static_cast<int>(std::floor(static_cast<float>(x) / square)); };
  for (std::size_t p = 0; p < places.size(); p += every)
    held.insert({at(places[p][0]), at(places[p][1]), at(places[p][2])});
  return held.size();
}

/// The stride that leaves at most so many points of a section. Points that were seeded row by row may leave every k-th in lines
/// far apart, and a flow that stretches them opens gaps: of some strides the first that leaves few squares empty, or the best.
std::size_t stride_shown(const Places& places, std::size_t most) {
  constexpr double enough = 0.85;  // two points to a square, at random, hold as many
  constexpr std::size_t tries = 8;
  const std::size_t least = (places.size() + most - 1) / most;
  if (least < 2 || fills_space(places)) return std::max<std::size_t>(1, least);
  std::array<double, 3> low = places.front(), high = low;
  for (const auto& x : places)
    for (std::size_t d = 0; d < 3; ++d) low[d] = std::min(low[d], x[d]), high[d] = std::max(high[d], x[d]);
  const double width = high[0] - low[0], height = std::max(high[1] - low[1], high[2] - low[2]);
  const double square = std::sqrt(std::max(2.0 * width * height / static_cast<double>(most), 1e-18));
  const auto all = static_cast<double>(squares_held(places, 1, square));
  std::size_t best = least;
  double most_held = 0.0;
  for (std::size_t every = least; every < least + tries && most_held < enough; ++every) {
    const double held = static_cast<double>(squares_held(places, every, square)) / all;
    if (held > most_held) best = every, most_held = held;
  }
  return best;
}

/// Which points of a frame stand for all: of a section every k-th.
std::vector<std::size_t> points_shown(const Places& places, std::size_t most, std::size_t every) {
  if (places.size() > most && fills_space(places)) return nearest_to_section(places, most);
  std::vector<std::size_t> chosen;
  for (std::size_t p = 0; p < places.size(); p += every) chosen.push_back(p);
  return chosen;
}

Frame thin_frame(const Frame& frame, std::size_t most, std::size_t every) {
  Frame thin;
  thin.time = frame.time;
  for (const std::size_t p : points_shown(frame.position, most, every)) {
    thin.position.push_back(frame.position[p]);
    if (p < frame.shear_rate.size()) thin.shear_rate.push_back(frame.shear_rate[p]);
    if (p < frame.flocculation.size()) thin.flocculation.push_back(frame.flocculation[p]);
    if (p < frame.age.size()) thin.age.push_back(frame.age[p]);
    if (p < frame.load.size()) thin.load.push_back(frame.load[p]);
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
  const std::size_t times_too_many = (frame.position.size() + most_points - 1) / most_points;
  if (times_too_many != times_too_many_)
    times_too_many_ = times_too_many, every_ = stride_shown(frame.position, most_points);
  kept_.push_back(thin_frame(frame, most_points, every_));
  ++came_;
}

MovingPicture moving_picture(const scene::Outcome& outcome, const std::vector<Frame>& frames) {
  MovingPicture picture;
  if (!outcome.stage || frames.empty()) return picture;
  const scene::Stage& stage = *outcome.stage;
  const std::vector<ShownField> fields = fields_of(frames);
  picture.caption = "The concrete over time; what was computed, point by point.";
  picture.fixed = stage.walls, picture.lifted = stage.lifted;
  picture.lift_speed = stage.lift_speed, picture.mirrored = stage.mirrored;
  picture.turning = stage.turning, picture.full = stage.full;
  for (const Frame& frame : frames) picture.frames.push_back(seen(frame, stage, fields));
  for (const ShownField& field : fields) picture.fields.push_back(field.colours);
  return picture;
}

}  // namespace tremie::report
