#pragma once

#include <pybind11/pybind11.h>

namespace tremie::python {

/// Scenes: run, cell, and where the mixes lie.
void add_scenes(pybind11::module_& module);

/// The rheometer: fit, Reiner-Riwlin, the flocculation state by CVODE, estimates from a slump flow.
void add_rheometer(pybind11::module_& module);

}  // namespace tremie::python
