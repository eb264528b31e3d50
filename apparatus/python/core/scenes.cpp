// Scenes run in process: the program's own calls, with the result in memory or in a folder too.

#include <pybind11/stl.h>

#include <any>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/python/core/arrays.hpp"
#include "apparatus/python/core/parts.hpp"
#include "apparatus/python/core/watch.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/report/run_files/result_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/report/summary.hpp"

namespace tremie::python {
namespace {

/// A scene as the caller has it: a file, or the text of one (`name` then stands for it in messages).
struct Source {
  std::string name;
  std::optional<std::string> text;
  std::vector<std::string> overrides;
};

/// For this command of tremie.
scene::Scene read(const Source& source, const std::string& command) {
  return source.text ? scene::read_text(*source.text, source.name, source.overrides, command)
                     : scene::read(source.name, source.overrides, command);
}

struct RunSettings {
  int threads = 0;      ///< 0: as many as pay
  bool frames = false;  ///< keep the points over time
  std::string out;      ///< folder; empty: none
  bool force = false;
  std::string command;  ///< that repeats the run, for the report
};

py::dict columns_of(std::vector<scene::Column>& columns) {
  py::dict arrays;
  for (auto& column : columns) arrays[column.name.c_str()] = array_of(std::move(column.values));
  return arrays;
}

py::dict dict_of(Frame& frame) {
  py::dict d;
  d["time_s"] = frame.time;
  d["position_m"] = array_of(std::move(frame.position));
  d["velocity_m_per_s"] = array_of(std::move(frame.velocity));
  d["volume_m3"] = array_of(std::move(frame.volume));
  d["pressure_Pa"] = array_of(std::move(frame.pressure));
  d["shear_rate_per_s"] = array_of(std::move(frame.shear_rate));
  if (frame.flocculation.empty())
    d["flocculation"] = py::none();
  else
    d["flocculation"] = array_of(std::move(frame.flocculation));
  if (!frame.age.empty()) d["age_s"] = array_of(std::move(frame.age));
  if (!frame.load.empty()) d["load"] = array_of(std::move(frame.load));
  return d;
}

/// Takes the buffers out of the outcome.
py::dict dict_of(const std::string& resolved, const std::vector<std::string>& notes, scene::Outcome& outcome,
                 std::vector<Frame>& frames) {
  py::dict d;
  d["summary"] = report::summary_json(outcome);
  d["scene"] = resolved;
  d["notes"] = notes;
  d["lines"] = outcome.lines;
  d["timeseries"] = columns_of(outcome.series);
  py::dict tables;
  for (auto& table : outcome.tables) tables[table.file.c_str()] = columns_of(table.columns);
  d["tables"] = tables;
  py::list list;
  for (Frame& frame : frames) list.append(dict_of(frame));
  d["frames"] = list;
  return d;
}

scene::Outcome run_and_write(const scene::Scene& scene, const RunSettings& settings, scene::Observer observer,
                             const report::RunFolder& folder, std::vector<Frame>& frames,
                             std::vector<std::string>& notes) {
  report::ResultFiles files(folder.staging(), scene.resolved, settings.command,
                            report::frames_written(scene.output));
  observer.on_frame = [&](const Frame& frame) {
    files.frame(frame);
    if (settings.frames) frames.push_back(frame);
  };
  scene::Outcome outcome = scene::run(scene, observer);
  if (outcome.status != Status::interrupted) notes = files.finish(outcome);
  return outcome;
}

py::dict run(const Source& source, const RunSettings& settings, const py::object& progress) {
  Watch watch(progress);
  scene::Outcome outcome;
  std::vector<Frame> frames;
  std::vector<std::string> notes;
  scene::Scene scene;
  {
    const py::gil_scoped_release unlocked;
    scene = read(source, "run");
    scene::set_threads(scene, settings.threads > 0 ? settings.threads : scene::default_threads(scene));
    scene::Observer observer = watch.observer();
    if (settings.out.empty()) {
      if (settings.frames) observer.on_frame = [&](const Frame& frame) { frames.push_back(frame); };
      outcome = scene::run(scene, observer);
    } else {
      report::RunFolder folder(settings.out, settings.force, scene.files);
      outcome = run_and_write(scene, settings, observer, folder, frames, notes);
      if (outcome.status != Status::interrupted) folder.publish();
    }
  }
  watch.rethrow();
  notes.insert(notes.begin(), scene.notes.begin(), scene.notes.end());
  return dict_of(scene.resolved, notes, outcome, frames);
}

py::dict run_cell(const Source& source) {
  scene::Outcome outcome;
  scene::Scene scene;
  {
    const py::gil_scoped_release unlocked;
    scene = read(source, "cell");
    outcome = scene::run(scene);
  }
  std::vector<Frame> none;
  return dict_of(scene.resolved, {}, outcome, none);
}

}  // namespace

void add_scenes(py::module_& module) {
  using namespace py::literals;
  module.def(
      "run",
      [](const std::string& name, const std::optional<std::string>& text,
         const std::vector<std::string>& overrides, int threads, bool frames, const std::string& out,
         bool force, const std::string& command, const py::object& progress) {
        return run({name, text, overrides}, {threads, frames, out, force, command}, progress);
      },
      "name"_a, "text"_a, "overrides"_a, "threads"_a, "frames"_a, "out"_a, "force"_a, "command"_a,
      "progress"_a);
  module.def(
      "cell",
      [](const std::string& name, const std::optional<std::string>& text,
         const std::vector<std::string>& overrides) {
        return run_cell({name, text, overrides});
      },
      "name"_a, "text"_a, "overrides"_a);
  module.def("mixes", &scene::mix_names);
}

}  // namespace tremie::python
