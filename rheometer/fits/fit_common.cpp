#include "rheometer/fits/fit_common.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "rheometer/records/torque_limit.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

/// A record in a wrong unit fits as well as in the right one. Fresh concretes, mortars and pastes shear at
/// stresses from a few Pa to, rested, a few kPa, and vanes turn at a few rev/s at most; what is far beyond is
/// told.
void judge_sizes(const TorqueRecord& record, const FitInput& input, FitResult& result) {
  const double stress =
      shear_stress_at(input.instrument.vane_radius,
                      *std::max_element(record.torque.begin(), record.torque.end()), input.instrument);
  if (stress < 1.0 || stress > 2e4)
    result.reasons.push_back("the largest shear stress at the vane is " + std::to_string(stress) +
                             " Pa, which no fresh concrete has: is the unit of the torque or stress right?");
  const double speed = record.kind == RecordKind::flow_curve
                           ? *std::max_element(record.omega.begin(), record.omega.end())
                           : input.omega.value_or(0.0);
  if (speed > angular_speed(10.001))
    result.reasons.push_back("the vane turns at " + std::to_string(speed / angular_speed(1.0)) +
                             " rev/s: is the speed's unit right?");
}

/// A peak that the instrument cuts off, and speeds at which it cannot carry more.
void judge_limit(const TorqueRecord& record, FitResult& result) {
  std::vector<double> x = record.time, torque = record.torque;
  if (record.kind == RecordKind::flow_curve) {
    std::vector<std::pair<double, double>> rows;
    for (std::size_t i = 0; i < torque.size(); ++i) rows.emplace_back(record.omega[i], torque[i]);
    std::sort(rows.begin(), rows.end());
    x.clear(), torque.clear();
    for (const auto& [omega, value] : rows) x.push_back(omega), torque.push_back(value);
  }
  if (const auto limit = torque_limit(x, torque))
    result.reasons.push_back(
        text_of("%ld rows in a row have the same largest %s, %.5g %s, and the others fall away from it: the "
                "instrument's limit, "
                "above which nothing is recorded",
                limit->rows, record.sheared_evenly ? "stress" : "torque", limit->torque,
                record.sheared_evenly ? "Pa" : "N.m"));
}

/// What the parameters hold for: a gap of 3 grains is no continuum, 5 are the usual demand (Feys et al. 2018).
void judge_gap(const FitInput& in, FitResult& result) {
  if (is_evenly_sheared(in.instrument)) return;
  const double gap = in.instrument.container_radius - in.instrument.vane_radius;
  if (in.max_aggregate > 0.0 && gap < 5.0 * in.max_aggregate) {
    const bool jams = gap < 3.0 * in.max_aggregate;
    (jams ? result.reasons : result.notes)
        .push_back(text_of(
            "the gap of %.3g mm is %.2g maximum grains: %s; the parameters hold for this gap, not for the "
            "material",
            1e3 * gap, gap / in.max_aggregate,
            jams ? "under 3, where grains jam" : "under 5, where grains still matter"));
  }
  if (!result.plug || !*result.plug || !result.sheared_radius) return;
  const double sheared = *result.sheared_radius - in.instrument.vane_radius;
  result.notes.push_back(
      text_of("plug: at the least sheared reading the material beyond %.3g mm stands still",
              1e3 * *result.sheared_radius));
  if (in.max_aggregate > 0.0 && sheared < 3.0 * in.max_aggregate)
    result.notes.push_back(
        text_of("the sheared layer is as thin as %.2g mm, %.2g maximum grains, at a reading", 1e3 * sheared,
                sheared / in.max_aggregate));
}

}  // namespace

FitResult fit(const TorqueRecord& record, const FitInput& input) {
  check(input.instrument);
  const auto positive = [](const std::optional<double>& v, const char* what) {
    if (v && !(std::isfinite(*v) && *v > 0.0))
      throw std::invalid_argument(std::string(what) + " must be greater than 0");
  };
  positive(input.tau_0, "the yield stress");
  positive(input.mu, "the plastic viscosity");
  positive(input.omega, "the speed");
  positive(input.rest, "the rest");
  FitResult result = record.kind == RecordKind::flow_curve ? fitting::fit_flow_curve(record, input)
                                                           : fitting::fit_torque_decay(record, input);
  judge_sizes(record, input, result);
  judge_limit(record, result);
  judge_gap(input, result);
  return result;
}

namespace fitting {

void Readings::push(double x_value, double torque_value, double rows, long line_number,
                    double rows_variance) {
  x.push_back(x_value);
  torque.push_back(torque_value);
  count.push_back(rows);
  line.push_back(line_number);
  variance.push_back(rows_variance);
}

void drop(FitResult& result, long line, double x, double torque, const std::string& reason, long rows) {
  if (result.dropped.size() < 100) result.dropped.push_back({line, x, torque, reason});
  result.dropped_count += rows;
  auto& reasons = result.dropped_reasons;
  const auto known =
      std::find_if(reasons.begin(), reasons.end(), [&](const auto& entry) { return entry.first == reason; });
  if (known == reasons.end())
    reasons.emplace_back(reason, rows);
  else
    known->second += rows;
}

long dropped_for(const FitResult& result, const std::string& reason) {
  for (const auto& [name, rows] : result.dropped_reasons)
    if (name == reason) return rows;
  return 0;
}

Readings condense(const Readings& all, std::size_t most, FitResult& result) {
  if (all.size() <= most) return all;
  result.notes.push_back(std::to_string(all.size()) + " rows averaged to " + std::to_string(most) +
                         " readings");
  Readings means;
  for (std::size_t k = 0; k < most; ++k) {
    const std::size_t begin = all.size() * k / most, end = all.size() * (k + 1) / most;
    const auto from = all.torque.begin() + static_cast<std::ptrdiff_t>(begin);
    std::vector<double> deviation(from, all.torque.begin() + static_cast<std::ptrdiff_t>(end));
    const double middle = median(deviation);
    for (double& d : deviation) d -= middle;
    // 6 deviations: one row in a thousand million of a normal sample; runs of a few rows are left whole
    const double cut =
        end - begin < 8 ? HUGE_VAL : std::max(6.0 * robust_deviation(deviation), 1e-6 * middle);
    double x = 0.0, torque = 0.0, count = 0.0, square = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      if (std::abs(deviation[i - begin]) > cut) {
        drop(result, all.line[i], all.x[i], all.torque[i], "outlier among its neighbours");
        continue;
      }
      x += all.x[i];
      torque += all.torque[i];
      square += deviation[i - begin] * deviation[i - begin];
      count += 1.0;
    }
    if (count == 0.0) continue;
    const double offset =
        torque / count - middle;  // of the mean from the median, which the deviations are about
    means.push(x / count, torque / count, count, all.line[begin],
               std::max(0.0, square / count - offset * offset));
  }
  return means;
}

Readings without(const Readings& all, const std::vector<char>& leave_out) {
  Readings kept;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (!leave_out[i]) kept.push(all.x[i], all.torque[i], all.count[i], all.line[i], all.variance[i]);
  return kept;
}

Readings dropping(const Readings& all, const std::vector<char>& leave_out, const std::string& reason,
                  FitResult& result) {
  for (std::size_t i = 0; i < all.size(); ++i)
    if (leave_out[i]) drop(result, all.line[i], all.x[i], all.torque[i], reason);
  return without(all, leave_out);
}

std::optional<ParameterEstimate> estimate(double value, double variance, double degrees, double scale) {
  if (!std::isfinite(value) || !std::isfinite(variance)) return std::nullopt;
  if (degrees <= 0.0) return ParameterEstimate{value, std::nullopt, false};
  const double half = student_quantile(0.975, degrees) * std::sqrt(variance);
  if (half > scale) return std::nullopt;
  return ParameterEstimate{value, Interval{std::max(0.0, value - half), value + half}, false};
}

ParameterEstimate given(double value) { return {value, Interval{value, value}, true}; }

Residuals kept_residuals(const Readings& readings, const LeastSquaresFit& fit) {
  Residuals kept;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (fit.outlier[i]) continue;
    kept.x.push_back(readings.x[i]);
    kept.residual.push_back(fit.residual[i]);
  }
  return kept;
}

std::string misfit_of(const Readings& readings, const LeastSquaresFit& fit, const std::string& what) {
  const auto [x, residual] = kept_residuals(readings, fit);
  const LackOfFit l = lack_of_fit(x, residual);
  const double whole = std::hypot(l.systematic, l.noise);
  const double correlation = successive_correlation(residual);
  const bool smooth = l.systematic >= 0.02 && l.probability < 1e-3;
  // a jump is no smooth curve: far above the noise of neighbouring readings, and neighbours miss alike
  const bool rough = whole >= 0.05 && whole > 5.0 * l.roughness_noise && correlation > 0.5;
  if (residual.size() < 8 || (!smooth && !rough)) return {};
  return text_of(
             "the model does not fit: it misses the readings by %.2g %%, %.2g %% of it along a smooth curve, "
             "where "
             "neighbouring readings scatter by %.2g %%: ",
             100.0 * whole, 100.0 * l.systematic, 100.0 * l.roughness_noise) +
         what;
}

void add_candidate(const std::string& name, const Readings& readings, const LeastSquaresFit& fit, double aicc,
                   double least, bool chosen, FitResult& result) {
  const auto finite = [&](double value) { return std::isfinite(aicc) ? std::optional(value) : std::nullopt; };
  result.candidates.push_back({.name = name,
                               .parameters = static_cast<int>(fit.parameters.size()),
                               .scatter = scatter_of_rows(readings, fit),
                               .correlation = fit.correlation,
                               .aicc = finite(aicc),
                               .difference = finite(aicc - least),
                               .fits = misfit_of(readings, fit, "").empty(),
                               .chosen = chosen});
}

double scatter_of_rows(const Readings& readings, const LeastSquaresFit& fit) {
  double square = 0.0, rows = 0.0, left = 0.0;
  bool means = false;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (fit.outlier[i]) continue;
    const double of_rows = readings.variance[i] / (fit.fitted[i] * fit.fitted[i]);
    square += readings.count[i] * (fit.residual[i] * fit.residual[i] + of_rows);
    rows += readings.count[i], left += 1.0;
    means = means || readings.count[i] > 1.0;
  }
  return means && left > 0.0 ? std::sqrt(square / rows) : fit.scatter;
}

void report(const Readings& readings, const LeastSquaresFit& fit, FitResult& result) {
  double square = 0.0, left_out = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (fit.outlier[i]) {
      drop(result, readings.line[i], readings.x[i], readings.torque[i], "outlier from the fitted curve",
           std::lround(readings.count[i]));
      left_out += 1.0;
      continue;
    }
    result.curve.x.push_back(readings.x[i]);
    result.curve.observed.push_back(readings.torque[i]);
    result.curve.fitted.push_back(fit.fitted[i]);
    result.readings += std::lround(readings.count[i]);
    square += fit.residual[i] * fit.residual[i];
  }
  result.scatter = scatter_of_rows(readings, fit);
  result.correlation = fit.correlation;
  const auto n = static_cast<double>(readings.size());
  const double misfit = 100.0 * std::sqrt(square / std::max(1.0, n - left_out));
  // An instrument's readings scatter by a few per cent; at this size the record is another material, unit or
  // speed.
  if (misfit > 10.0)
    result.reasons.push_back(
        "the fitted curve misses the readings by " + std::to_string(std::lround(misfit)) +
        " % (root mean square): check the units, the speed and the values given as known");
  // A stray reading is an outlier; a twentieth of a long record is a part that the model does not describe.
  if (readings.size() >= 50 && left_out > 0.05 * n)
    result.reasons.push_back(
        std::to_string(std::lround(100.0 * left_out / n)) +
        " % of the readings are off the fitted curve and were left out: the material does not "
        "follow the model, or a value given as known is wrong");
}

}  // namespace fitting

}  // namespace tremie
