#pragma once

// `apparatus = "cell"`: one material cell at a prescribed shear rate.

#include <string>

#include "apparatus/common/apparatus.hpp"
#include "rheometer/cell/material_cell.hpp"

namespace tremie::cell {

/// A checked scene, SI units.
struct Scene {
  std::string name;  ///< the file's name without .toml
  MaterialCell cell;
  YieldLaw law = ExactBingham{};
};

/// The keys of the scene.
scene::ApparatusKeys keys();

/// Checked values as a scene; a CSV history beside the file becomes tables of the values. Throws
/// scene::InputError.
Scene build(scene::Loaded& loaded);

/// Runs the cell with the scene's law. Throws scene::InputError where the history cannot be run.
CellResult run(const Scene& scene);

/// The apparatus for the registry.
scene::Apparatus apparatus();

}  // namespace tremie::cell
