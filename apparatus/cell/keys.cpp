#include <fmt/format.h>

#include <stdexcept>

#include "apparatus/cell/cell.hpp"
#include "apparatus/common/law_keys.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/scene/document.hpp"
#include "apparatus/scene/input_error.hpp"
#include "rheometer/records/torque_record.hpp"

namespace tremie::cell {

namespace {

using scene::Dimension;
using scene::Kind;
using scene::Section;
using scene::Values;

Section top_section() {
  return {
      .name = "",
      .help = "",
      .keys = {
          {.name = "history",
           .kind = Kind::text,
           .example = "history.csv",
           .help = "a CSV of time_s,shear_rate_per_s beside the scene, in place of the tables [[history]]"}}};
}

Section history_section() {
  Section section{
      .name = "history", .help = "A piece of the shear rate's history, linear in time.", .repeated = true};
  section.keys = {
      {.name = "duration",
       .dimension = Dimension::time,
       .range = scene::positive,
       .required = true,
       .example = "100 s"},
      {.name = "from", .dimension = Dimension::rate, .range = scene::not_negative, .fallback = "0 1/s"},
      {.name = "to",
       .dimension = Dimension::rate,
       .range = scene::not_negative,
       .example = "0 1/s",
       .help = "without it the rate stays"}};
  return section;
}

Section test_section() {
  return {.name = "test", .help = "Before the history.", .keys = {scene::rest_key("0 s", "")}};
}

Section model_section() {
  Section section{.name = "model", .help = "How it is computed."};
  section.keys = scene::law_model_keys();
  section.keys.push_back({.name = "time_step",
                          .dimension = Dimension::time,
                          .range = scene::positive,
                          .words = {"auto"},
                          .fallback = "auto",
                          .help = "of the flocculation's update; auto: about 2000 over the history"});
  return section;
}

/// The rows of the CSV as the tables that they stand for, so that the resolved scene needs no other file.
void inline_csv(Values& values, const std::filesystem::path& folder) {
  const scene::Origin origin = values.at("history").origin;
  const std::string path = (folder / values.word("history")).string();
  std::vector<ShearSegment> segments;
  try {
    segments = parse_shear_history(read_text_file(path), path);
  } catch (const RecordError& error) {
    throw scene::InputError(error.what());
  }
  values.drop("history");
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string place = fmt::format("history[{}]", i);
    values.sections[place] = origin;
    const auto put = [&](const char* key, double value) {
      values.set_number(place + "." + key, value, origin.layer, "");
      values.entries[place + "." + key].origin = origin;
    };
    put("duration", segments[i].duration);
    put("from", segments[i].from);
    put("to", segments[i].to);
  }
}

std::vector<ShearSegment> read_history(const Values& values) {
  std::vector<ShearSegment> history;
  for (std::size_t i = 0; i < values.count("history"); ++i) {
    const std::string place = fmt::format("history[{}].", i);
    const double from = values.number(place + "from");
    history.push_back({values.number(place + "duration"), from,
                       values.has(place + "to") ? values.number(place + "to") : from});
  }
  return history;
}

}  // namespace

Scene build(scene::Loaded& loaded) {
  Values& values = loaded.values;
  if (values.has("history")) {
    const auto folder = std::filesystem::path(loaded.path).parent_path();
    loaded.files.push_back(folder / values.word("history"));
    inline_csv(values, folder);
  }
  Scene scene;
  scene.name = loaded.name;
  scene.cell.mix = scene::read_mix(values);
  scene.cell.rest = values.number("test.rest");
  scene.cell.history = read_history(values);
  if (scene.cell.history.empty())
    throw scene::InputError(loaded.path +
                            ": history: missing; give tables [[history]] with duration, from and to, or "
                            "history = \"file.csv\" above the first table");
  scene.cell.time_step = values.number_unless("model.time_step", "auto");
  scene.law = scene::read_law(values);
  return scene;
}

scene::ApparatusKeys keys() {
  return {.name = "cell",
          .help = "One material cell at a prescribed shear rate: tremie cell.",
          .schema = scene::joined(
              {{top_section()}, scene::mix_sections(), {test_section(), history_section(), model_section()}}),
          .settle = [](Values& values) { scene::settle_mix_with(values, {.elastic = true}); },
          .command = "cell"};
}

CellResult run(const Scene& scene) {
  try {
    return run_cell(scene.cell, scene.law);
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(scene.name + ": " + error.what());
  }
}

}  // namespace tremie::cell
