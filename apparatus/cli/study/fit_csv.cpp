#include "apparatus/cli/study/fit_csv.hpp"

#include <cmath>

#include "apparatus/scene/units.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::cli {

std::string fit_csv(const FitResult& r) {
  const bool decay = r.kind == RecordKind::torque_decay;
  std::string text =
      decay ? "time_s,torque_N_m,torque_fit_N_m,residual_percent,flocculation_apparent\n"
            : "speed_rev_per_s,torque_N_m,torque_fit_N_m,residual_percent,torque_fit_error_N_m\n";
  const auto number = [](double v) { return std::isfinite(v) ? scene::write_number(v) : std::string{}; };
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    const double x = decay ? r.curve.x[i] : r.curve.x[i] / two_pi, fitted = r.curve.fitted[i];
    const double last =
        decay ? (i < r.lambda_apparent.size() ? r.lambda_apparent[i] : NAN) : r.curve.standard_error[i];
    text += number(x) + ',' + number(r.curve.observed[i]) + ',' + number(fitted) + ',' +
            number(100.0 * (r.curve.observed[i] / fitted - 1.0)) + ',' + number(last) + '\n';
  }
  return text;
}

}  // namespace tremie::cli
