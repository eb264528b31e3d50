#include "rheometer/whole_fit/fit_with_blades.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace tremie {
namespace {

double viscosity_of(const FitResult& fit) {
  if (fit.mu && fit.mu->value > 0.0) return fit.mu->value;
  throw std::invalid_argument(
      "the blades' part hangs on the plastic viscosity, which this record does not tell; give it");
}

}  // namespace

VaneFit fit_with_blades(const TorqueRecord& record, const FitInput& input, const BladeTable& table) {
  if (!input.mu && record.kind != RecordKind::flow_curve)
    throw std::invalid_argument(
        "the blades' part hangs on the plastic viscosity, which a record at one speed hardly tells; give "
        "--plastic-viscosity, of a flow curve");
  double mu = input.mu ? *input.mu : viscosity_of(fit(record, input));
  for (int turn = 0; turn < 30; ++turn) {
    TorqueRecord cylinder = record;
    VaneFit result;
    result.least_factor = 1e300, result.most_factor = 0.0;
    for (std::size_t i = 0; i < record.torque.size(); ++i) {
      const double omega =
          record.kind == RecordKind::flow_curve ? record.omega[i] : input.omega.value_or(0.0);
      if (!(omega > 0.0 && record.torque[i] > 0.0)) continue;
      cylinder.torque[i] = torque_of_cylinder(table, input.instrument, mu, omega, record.torque[i]);
      const double factor = record.torque[i] / cylinder.torque[i];
      result.least_factor = std::min(result.least_factor, factor);
      result.most_factor = std::max(result.most_factor, factor);
    }
    if (result.most_factor == 0.0) result.least_factor = result.most_factor = 1.0;  // nothing turns
    result.fit = fit(cylinder, input);
    if (input.mu) return result;
    const double before = mu;
    mu = viscosity_of(result.fit);
    if (std::abs(mu - before) < 1e-6 * mu) return result;
  }
  throw std::invalid_argument(
      "the blades' part and the plastic viscosity do not settle together; give the viscosity");
}

}  // namespace tremie
