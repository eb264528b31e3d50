// Stands in for the vane's engine until it is there: a Newtonian torque that decays, enough to fill every
// file.

#include "apparatus/icar_vane/icar_vane.hpp"

#include <cmath>
#include <numbers>

#include "libmpm/law/flocculation.hpp"

namespace tremie::icar_vane {
namespace {

double torque_at(const Scene& scene, double speed, double time) {
  const Vane& v = scene.vane;
  const double gap = 1.0 / (v.radius * v.radius) - 1.0 / (v.container_radius * v.container_radius);
  const double omega = 2.0 * std::numbers::pi * speed;
  const double steady = 4.0 * std::numbers::pi * v.height *
                        (omega * scene.mix.mu + std::copysign(0.8 * scene.mix.tau_0, speed)) / gap;
  return scene.mix.thixotropy ? steady * (1.0 + std::exp(-0.4 * time)) : steady;
}

double end_of(const Scene& scene) {
  return scene.speeds.empty()
             ? scene.duration
             : scene.pre_shear_time + static_cast<double>(scene.speeds.size()) * scene.hold_time;
}

double speed_at(const Scene& scene, double time) {
  if (scene.speeds.empty()) return scene.speed;
  if (time <= scene.pre_shear_time) return scene.pre_shear_speed;
  const auto i = static_cast<std::size_t>((time - scene.pre_shear_time) / scene.hold_time);
  return scene.speeds[std::min(i, scene.speeds.size() - 1)];
}

Frame frame_at(double time) {
  Frame frame;
  frame.time = time;
  frame.position = {{0.07, 0.0, 0.0}};
  frame.velocity = {{0.0, 0.1, 0.0}};
  frame.volume = {1e-6};
  frame.pressure = {0.0};
  frame.shear_rate = {1.0};
  return frame;
}

}  // namespace

Outcome run(const Scene& scene, const Observer& observer) {
  Outcome outcome;
  outcome.series.push_back({.time = 0.0, .speed = speed_at(scene, 0.0)});
  const int n = 50;
  for (int i = 1; i <= n; ++i) {
    Sample s{.time = end_of(scene) * i / n, .time_step = end_of(scene) / n};
    s.speed = speed_at(scene, s.time);
    s.torque = s.torque_wall = s.torque_power = torque_at(scene, s.speed, s.time);
    if (scene.mix.thixotropy) s.flocculation_mean = s.flocculation_apparent = 1.0;
    outcome.series.push_back(s);
    if (observer.on_step) observer.on_step(s);
    if (observer.interrupted && *observer.interrupted) outcome.status = Status::interrupted;
  }
  Results& r = outcome.results;
  r.torque_peak = outcome.series[1].torque;
  r.torque_end = r.torque_wall_end = r.torque_power_end = outcome.series.back().torque;
  r.shear_rate_nominal = 4.0 * std::numbers::pi * std::abs(scene.speed);
  for (double speed : scene.speeds) r.flow_curve.push_back({speed, torque_at(scene, speed, 1e3)});
  if (scene.speeds.size() >= 2) r.reiner_riwlin = ReinerRiwlin{scene.mix.tau_0, scene.mix.mu};
  if (scene.mix.thixotropy && scene.speeds.empty()) {
    r.flocculation_apparent_start = 1.0;
    r.alpha_apparent = 0.02;
    r.alpha_window = scene.duration;
  }
  for (int i = 0; i < 10; ++i) {
    ProfilePoint p{.radius = 0.0635 + 0.008 * i, .velocity = 0.1 - 0.01 * i, .shear_rate = 5.0 / (1.0 + i)};
    if (scene.mix.thixotropy) p.flocculation = 0.1 * i;
    r.profile.push_back(p);
  }
  outcome.cost.steps = n;
  outcome.final_frame = frame_at(end_of(scene));
  if (observer.on_frame) observer.on_frame(outcome.final_frame);
  return outcome;
}

Estimate estimate(const Scene&) { return {1, 1, 100, 50}; }

}  // namespace tremie::icar_vane
