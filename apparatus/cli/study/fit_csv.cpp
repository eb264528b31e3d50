#include "apparatus/cli/study/fit_csv.hpp"

#include <cmath>

#include "apparatus/scene/units.hpp"

namespace tremie::cli {

std::string fit_csv(const FitResult& r) {
  const bool decay = r.kind == RecordKind::torque_decay;
  const ShownUnits shown = shown_units(r.sheared_evenly);
  const std::string torque = shown.torque_key, stem = torque.substr(0, r.sheared_evenly ? 12 : 6),
                    unit = torque.substr(stem.size());
  std::string text = std::string(decay ? "time_s" : shown.speed_key) + "," + torque + "," + stem + "_fit" +
                     unit + ",residual_percent," +
                     (decay ? "flocculation_apparent" : stem + "_fit_error" + unit) + "\n";
  const auto number = [](double v) { return std::isfinite(v) ? scene::write_number(v) : std::string{}; };
  for (std::size_t i = 0; i < r.curve.x.size(); ++i) {
    const double x = decay ? r.curve.x[i] : r.curve.x[i] / shown.speed, fitted = r.curve.fitted[i];
    const double last =
        decay ? (i < r.lambda_apparent.size() ? r.lambda_apparent[i] : NAN) : r.curve.standard_error[i];
    text += number(x) + ',' + number(r.curve.observed[i]) + ',' + number(fitted) + ',' +
            number(100.0 * (r.curve.observed[i] / fitted - 1.0)) + ',' + number(last) + '\n';
  }
  return text;
}

}  // namespace tremie::cli
