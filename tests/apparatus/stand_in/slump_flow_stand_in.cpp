// Stands in for apparatus/slump_flow where that target is not there: a spread that follows a simple law, so
// that the reader, the writers and the program can be tested without the engine.

#include <cmath>
#include <stdexcept>

#include "apparatus/slump_flow/slump_flow.hpp"

namespace tremie::slump_flow {
namespace {

Frame frame_at(double time, double radius, const Scene& scene) {
  Frame frame;
  frame.time = time;
  const double height = 5.498e-3 / (3.14159 * radius * radius);
  for (int i = 0; i < 60; ++i) {
    for (int j = 0; j < 12; ++j) {
      const double r = radius * (i + 0.5) / 60,
                   z = height * (j + 0.5) / 12 * std::sqrt(1.0 - r * r / radius / radius);
      frame.position.push_back({r, 0.0, z});
      frame.velocity.push_back({r * std::exp(-time), 0.0, -z * std::exp(-time)});
      frame.volume.push_back(height / 12 * radius / 60 * 2 * 3.14159 * r);
      frame.pressure.push_back(2400 * 9.81 * (height - z));
      frame.shear_rate.push_back(10.0 * r / radius * std::exp(-time));
      if (scene.mix.thixotropy) frame.flocculation.push_back(5.78 * (1 - 0.5 * r / radius));
    }
  }
  return frame;
}

}  // namespace

Outcome run(const Scene& scene, const Observer& observer) {
  if (scene.model.scheme != SchemeKind::implicit || scene.model.space != SpaceKind::axisymmetric)
    throw std::invalid_argument("the stand-in runs implicit axisymmetric scenes alone");
  Outcome outcome;
  const double end_radius = 0.1 + 0.18 * std::pow(54.0 / std::max(1.0, scene.mix.tau_0), 0.2);
  const double dt = 0.1;
  double next_frame = 0.0;
  for (int step = 0; step * dt <= scene.duration + 1e-9; ++step) {
    if (observer.interrupted && *observer.interrupted) {
      outcome.status = Status::interrupted;
      break;
    }
    const double t = step * dt, radius = end_radius - (end_radius - 0.1) * std::exp(-t);
    Sample s;
    s.time = t;
    s.spread = 2 * radius;
    s.spread_max_point = 2.01 * radius;
    s.height = 0.3 * std::exp(-t) + 0.02;
    s.max_speed = std::exp(-t);
    s.shear_rate_mean = 10 * std::exp(-t);
    s.time_step = dt;
    s.iterations = 5;
    if (scene.mix.thixotropy) s.flocculation_mean = 5.78 * std::exp(-0.01 * t);
    outcome.series.push_back(s);
    if (observer.on_step) observer.on_step(s);
    if (t >= next_frame && observer.on_frame) {
      observer.on_frame(frame_at(t, radius, scene));
      next_frame += scene.frame_interval;
    }
    outcome.final_frame = frame_at(t, radius, scene);
    outcome.results.spread = s.spread;
    outcome.results.spread_max_point = s.spread_max_point;
    outcome.results.height = s.height;
    outcome.cost.steps = step;
    outcome.cost.simulated = t;
  }
  if (observer.on_frame && !outcome.series.empty()) observer.on_frame(outcome.final_frame);
  if (scene.mix.thixotropy) outcome.results.flocculation_mean_start = 5.78;
  if (scene.mix.thixotropy) outcome.results.flocculation_mean_end = outcome.series.back().flocculation_mean;
  outcome.results.shear_rate_mean_peak = 10.0;
  outcome.cost.points = 720;
  outcome.cost.bytes_per_point = scene.mix.thixotropy ? 208 : 200;
  if (scene.mix.tau_0 > 4999.0) outcome.checks.reasons.push_back("the stand-in does not trust stiff mixes");
  return outcome;
}

Estimate estimate(const Scene& scene) { return {720, 300, scene.mix.thixotropy ? 208 : 200, 300}; }

std::string spread_class(double spread) {
  const double rounded = std::round(spread * 100.0) * 10.0;
  if (rounded >= 550 && rounded <= 650) return "SF1";
  if (rounded >= 660 && rounded <= 750) return "SF2";
  return rounded >= 760 && rounded <= 850 ? "SF3" : "";
}

}  // namespace tremie::slump_flow
