#pragma once

namespace tremie {

/// Whether this build has the references that SUNDIALS integrates: flocculation_ode, elastic_ode and
/// thixotropic_couette.
/// Where it has not, calling one of them throws std::runtime_error.
bool has_integrated_references();

}  // namespace tremie
