#pragma once

// Whether the parameters of a decay hang on how it was recorded. Private to rheometer/.

#include "rheometer/fits/fit.hpp"

namespace tremie::fitting {

/// A decay at one speed with neither yield stress nor viscosity known: four parameters or more of one bent line. Fits the
/// record anew with its clock moved by a reading, without its first and its last fifth, and by every fourth row. A
/// parameter's interval is widened to what these give; one that is then wider than its value is not identifiable. Without
/// the first fifth another flocculation starts, so that the material's own parameters alone are compared.
void judge_stability(const TorqueRecord& record, const FitInput& input, FitResult& result);

}  // namespace tremie::fitting
