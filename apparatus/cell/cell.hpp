#pragma once

// `apparatus = "cell"`: one material cell at a prescribed shear rate, from a scene to a result in one call
// each.

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/common/model.hpp"
#include "apparatus/common/outcome.hpp"
#include "apparatus/common/readings.hpp"
#include "apparatus/scene/keys.hpp"
#include "apparatus/scene/load.hpp"
#include "rheometer/reference/material_cell.hpp"

namespace tremie::cell {

/// A checked scene, SI units.
struct Scene {
  std::string name;  ///< the file's name without .toml
  MaterialCell cell;
  YieldLaw law = ExactBingham{};
  std::string resolved;  ///< the same scene as TOML, a CSV history as tables; reads back to the same scene
};

/// The keys of the scene.
scene::ApparatusKeys keys();

/// Checked values as a scene; a CSV history beside the file becomes tables of the values. Throws
/// scene::InputError.
Scene build(scene::Loaded& loaded);

/// Reads and checks; a CSV history lies beside the scene. Throws scene::InputError.
Scene read(const std::filesystem::path& path, const std::vector<std::string>& overrides = {});

/// A scene from its text; `name` stands for the file in messages and for the folder of a CSV history.
Scene read_text(const std::string& text, const std::string& name,
                const std::vector<std::string>& overrides = {});

/// Runs the cell with the scene's law. Throws scene::InputError where the history cannot be run.
CellResult run(const Scene& scene);

/// What the names of readings mean.
std::vector<scene::Described> glossary();

/// The result under the names of timeseries.csv and summary.json.
scene::Outcome outcome(const Scene& scene, const CellResult& result);

}  // namespace tremie::cell
