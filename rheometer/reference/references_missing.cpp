// Takes the place of the references that SUNDIALS integrates in a build without it.

#include <stdexcept>

#include "rheometer/reference/flocculation_ode.hpp"
#include "rheometer/reference/references.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"

namespace tremie {
namespace {

std::runtime_error missing() {
  return std::runtime_error("this build has no integrated references: it was built without SUNDIALS");
}

}  // namespace

bool has_integrated_references() { return false; }

OdeResult flocculation_ode(std::span<const ShearPiece>, const Thixotropy&, double, double,
                           std::span<const double>, const OdeOptions&) {
  throw missing();
}

CouetteDecay thixotropic_couette(const CouetteFlow&, std::span<const double>, const Instrument&,
                                 const CouetteOptions&) {
  throw missing();
}

}  // namespace tremie
