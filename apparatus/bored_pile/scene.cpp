// From the checked values of a scene to plain numbers, and what they must fulfil together.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "apparatus/bored_pile/bored_pile.hpp"
#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"

namespace tremie::bored_pile {

using namespace scene;

namespace {

/// The largest outer radius of a pipe that leaves two cells beside it [m].
double widest_pipe(const Scene& scene) {
  const double most = std::max(0.0, scene.radius - 2.0 * scene.model.cell[0]), W = scene.width;
  return W > 0.0 ? std::min(0.5 * W, std::sqrt(2.0 * W * most / std::numbers::pi)) : most;
}

/// The pipe must fit into the pile, and what is poured into both.
void check_pile(const Values& values, const Scene& scene) {
  const Pipe& pipe = scene.pipe;
  const auto length = [](double x) { return write_quantity(x, Dimension::length); };
  if (pipe.outer_radius <= pipe.inner_radius)
    values.fail("pipe.outer_radius",
                fmt::format("is not larger than inner_radius, \"{}\"", length(pipe.inner_radius)));
  const auto [h, h_up] = scene.model.cell;
  const double reach = pipe_reach(scene);
  if (reach + 2.0 * h > scene.radius || (scene.width > 0.0 && 2.0 * pipe.outer_radius > scene.width))
    values.fail(
        "pipe.outer_radius",
        fmt::format(
            "leaves less than two cells between pipe and pile; allowed: at most \"{}\" on these cells",
            write_at_most(widest_pipe(scene), Dimension::length)));
  if (pipe.start + 4.0 * h_up > scene.depth)
    values.fail("pipe.start",
                fmt::format("the mouth stands above the pile; allowed: less than \"{}\" on these cells",
                            length(std::max(0.0, scene.depth - 4.0 * h_up))));
  if (h > reach || h_up > pipe.pull)
    values.fail("model.cell", fmt::format("does not resolve the pipe; allowed: at most [\"{}\", \"{}\"]",
                                          length(reach), length(pipe.pull)));
  if (scene.fluid_density >= scene.mix.density)
    values.fail("fluid.density",
                fmt::format("the concrete would float; allowed: less than mix.density, \"{}\"",
                            write_quantity(scene.mix.density, Dimension::density)));
  const double first = area_within(scene, scene.radius) * (pipe.start + 3.0 * h_up);
  if (scene.loads.front().volume < first)
    values.fail(values.count("load") > 0 ? "load[0].volume" : "pile.depth",
                fmt::format("the first load does not cover the pipe's mouth; allowed: at least \"{}\"",
                            write_quantity(first, Dimension::volume)));
  const auto [n, n_up] = scene.model.points_per_cell;
  check_points(values, scene.radius / h * n * scene.depth / h_up * n_up);
}

/// The drag of a row of bars holds from three diameters on; the cover needs cells of its own.
void check_cage(const Values& values, const Scene& scene) {
  const Cage& cage = *scene.cage;
  const auto length = [](double x) { return write_quantity(x, Dimension::length); };
  const double h = scene.model.cell[0], least = scene.pipe.outer_radius + h, most = scene.radius - 2.0 * h;
  if (cage.radius < least || cage.radius > most)
    values.fail(
        "cage.radius",
        fmt::format("needs a cell to the pipe and two to the wall; allowed: \"{}\" to \"{}\" on these "
                    "cells",
                    length(least), length(std::max(least, most))));
  const auto row = [&](const char* key, double diameter, double spacing) {
    if (diameter > spacing / 3.0)
      values.fail(
          key, fmt::format("leaves gaps for which no drag is known; allowed: at most a third of the spacing, "
                           "\"{}\"",
                           length(spacing / 3.0)));
  };
  row("cage.bar_diameter", cage.bar_diameter, cage.bar_spacing());
  if (cage.hoop_spacing > 0.0) row("cage.hoop_diameter", cage.hoop_diameter, cage.hoop_spacing);
}

std::optional<Cage> read_cage(const Values& values) {
  if (!values.has_section("cage")) return std::nullopt;
  return Cage{values.number("cage.radius"), static_cast<int>(values.integer("cage.bars")),
              values.number("cage.bar_diameter"), values.number("cage.hoop_spacing"),
              values.number("cage.hoop_diameter")};
}

/// The mix of load i: what the load leaves out is the scene's.
Mix read_mix_of_load(const Values& values, const Scene& scene, std::size_t i) {
  Mix mix = scene.mix;
  const auto key = [i](const char* name) { return fmt::format("load[{}].{}", i, name); };
  const auto read = [&](const char* name, double& number) {
    if (values.has(key(name))) number = values.number(key(name));
  };
  if (values.has(key("plastic_viscosity")) && is_viscous(scene.model.law))
    values.fail(
        key("plastic_viscosity"),
        "has no meaning beside mix.consistency, which holds for all loads; allowed here: yield_stress, "
        "structuration_rate");
  if (values.has(key("structuration_rate")) && !mix.thixotropy)
    values.fail(key("structuration_rate"), "needs [mix.thixotropy], whose kinetics hold for all loads");
  read("yield_stress", mix.tau_0), read("plastic_viscosity", mix.mu);
  if (!mix.thixotropy) return mix;
  read("structuration_rate", mix.thixotropy->A_thix);
  if (mix.tau_0 == 0.0)
    values.fail(key("yield_stress"), "is 0 with [mix.thixotropy]; allowed: greater than 0 Pa");
  return mix;
}

/// The mixes of the loads; empty where all are the scene's.
std::vector<Mix> read_mixes(const Values& values, const Scene& scene) {
  const auto is_scenes = [&](const Mix& mix) {
    return mix.tau_0 == scene.mix.tau_0 && mix.mu == scene.mix.mu &&
           (!mix.thixotropy || mix.thixotropy->A_thix == scene.mix.thixotropy->A_thix);
  };
  std::vector<Mix> mixes;
  for (std::size_t i = 0; i < values.count("load"); ++i) mixes.push_back(read_mix_of_load(values, scene, i));
  if (std::all_of(mixes.begin(), mixes.end(), is_scenes)) return {};
  if (scene.model.method == MethodKind::newton)
    values.fail("model.method", "\"newton\" knows one mix for all loads; allowed: \"auto\", \"admm\"");
  return mixes;
}

std::vector<Load> read_loads(const Values& values) {
  std::vector<Load> loads;
  for (std::size_t i = 0; i < values.count("load"); ++i) {
    const auto of = [&](const char* key) { return values.number(fmt::format("load[{}].{}", i, key)); };
    loads.push_back({of("volume"), of("age"), of("pause"), of("rest")});
  }
  return loads;
}

}  // namespace

double pile_volume(const Scene& scene) { return area_within(scene, scene.radius) * scene.depth; }

double pour_time(const Scene& scene) {
  double volume = 0.0, pauses = 0.0;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) {
    if (volume < pile_volume(scene) && i > 0) pauses += scene.loads[i].pause;
    volume += scene.loads[i].volume;
  }
  return pauses + std::min(volume, pile_volume(scene)) / scene.rate;
}

Scene read_scene(const Values& values) {
  Scene scene;
  scene.mix = read_mix(values);
  scene.radius = values.number("pile.radius"), scene.depth = values.number("pile.depth");
  if (values.has("pile.width")) scene.width = values.number("pile.width");
  const auto embedment = values.numbers("pipe.embedment");
  scene.pipe = {values.number("pipe.inner_radius"),
                values.number("pipe.outer_radius"),
                embedment[0],
                embedment[1],
                values.number("pipe.pull"),
                values.number("pipe.start"),
                values.number("pipe.above")};
  scene.fluid_density = values.number("fluid.density");
  scene.rate = values.number("test.rate"), scene.workable = values.number("test.workable");
  scene.loads = read_loads(values);
  if (scene.loads.empty()) scene.loads = {{.volume = pile_volume(scene)}};
  scene.walls = read_wall_law(values, "walls");
  scene.model = read_model(values);
  scene.frame_interval = read_output(values).frame_interval;
  scene.cage = read_cage(values);
  scene.mixes = read_mixes(values, scene);
  check_pile(values, scene);
  if (scene.cage) check_cage(values, scene);
  return scene;
}

}  // namespace tremie::bored_pile
