#include "rheometer/whole_fit/tribometer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <stdexcept>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/fits/fit_common.hpp"
#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/regression/least_squares.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

using fitting::Readings;

enum : std::size_t { at_tau_i, at_k_i, at_end_torque, at_end_viscosity };
constexpr std::size_t parameter_count = 4, of_interface = 2;
using Parameters = std::array<double, parameter_count>;

/// The wall that slides, in its instrument.
struct SmoothSide {
  Instrument instrument;
  std::optional<double> tau_0, mu;  ///< of the concrete [Pa], [Pa s]
  double radius = 0.0;              ///< of the wall [m]
};

/// Readings of all series in their order, each with its fill height.
struct Rows {
  Readings readings;
  std::vector<double> height;
  bool several_heights = false;
};

Rows rows_of(const std::vector<TribometerSeries>& series, FitResult& result) {
  Rows rows;
  for (const TribometerSeries& s : series) {
    if (!(std::isfinite(s.fill_height) && s.fill_height > 0.0))
      throw std::invalid_argument("a fill height must be greater than 0");
    if (s.record.kind != RecordKind::flow_curve || s.record.sheared_evenly)
      throw std::invalid_argument("a tribometer's record has speeds and torques");
    rows.several_heights =
        rows.several_heights || std::abs(s.fill_height / series[0].fill_height - 1.0) > 0.05;
    for (std::size_t i = 0; i < s.record.torque.size(); ++i) {
      const double omega = s.record.omega[i], torque = s.record.torque[i];
      if (!(omega > 0.0 && torque > 0.0)) {
        fitting::drop(result, s.record.line[i], omega, torque, omega > 0.0 ? "no torque" : "no speed");
        continue;
      }
      rows.readings.push(omega, torque, 1.0, s.record.line[i]);
      rows.height.push_back(s.fill_height);
    }
  }
  const auto [slowest, fastest] = std::minmax_element(rows.readings.x.begin(), rows.readings.x.end());
  const std::size_t unknowns = rows.several_heights ? 4 : 2;
  if (rows.readings.size() < unknowns || !(*fastest > *slowest * (1.0 + 1e-9)))
    throw std::invalid_argument("a tribometer's fit needs two speeds or more and at least " +
                                std::to_string(unknowns) + " rows; " + std::to_string(rows.readings.size()) +
                                " found");
  return rows;
}

/// Shear stress at the wall at the speed omega: by slip, and by the concrete's own shear where it is known.
double wall_stress(double tau_i, double k_i, double omega, const SmoothSide& in) {
  const double R = in.radius, slipping = tau_i + k_i * R * omega;
  if (!in.tau_0) return slipping;
  const auto speed = [&](double tau) {
    const double torque = two_pi * R * R * in.instrument.vane_height * tau;
    const double own = reiner_riwlin_speed({*in.tau_0, *in.mu}, torque, in.instrument);
    return own + (tau > tau_i ? (tau - tau_i) / std::max(k_i * R, 1e-12) : 0.0);
  };
  double low = 0.0, high = slipping;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (speed(middle) < omega ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double torque_of(const Parameters& p, double omega, double height, const SmoothSide& in) {
  const double R = in.radius;
  return two_pi * R * R * height * wall_stress(p[at_tau_i], p[at_k_i], omega, in) + p[at_end_torque] +
         p[at_end_viscosity] * omega;
}

/// A line through the stresses, as if the side carried all.
Parameters start_of(const Rows& rows, const SmoothSide& in) {
  const double R = in.radius;
  std::vector<double> slip, stress;
  for (std::size_t i = 0; i < rows.height.size(); ++i) {
    slip.push_back(R * rows.readings.x[i]);
    stress.push_back(rows.readings.torque[i] / (two_pi * R * R * rows.height[i]));
  }
  const StraightLine line = straight_line(slip, stress);
  return {std::max(0.1 * line.mean_y, line.at(0.0)), std::max(1e-3 * line.mean_y, line.slope), 0.0, 0.0};
}

LeastSquaresFit least_squares(const Rows& rows, const SmoothSide& in) {
  const Parameters start = start_of(rows, in);
  const std::size_t free = rows.several_heights ? parameter_count : of_interface;
  LeastSquaresProblem problem;
  problem.observed = rows.readings.torque;
  problem.count = rows.readings.count;
  problem.start.assign(start.begin(), start.begin() + static_cast<std::ptrdiff_t>(free));
  problem.lower = {0.0, 0.0, -1e9, -1e9};
  problem.upper.assign(free, 1e9);
  problem.lower.resize(free);
  problem.model = [&](std::span<const double> p, std::span<double> torque, std::span<double> jacobian) {
    Parameters all{};
    std::copy(p.begin(), p.end(), all.begin());
    for (std::size_t i = 0; i < torque.size(); ++i) {
      const double omega = rows.readings.x[i], height = rows.height[i];
      torque[i] = torque_of(all, omega, height, in);
      if (jacobian.empty()) continue;
      for (std::size_t k = 0; k < free; ++k) {
        Parameters moved = all;
        const double step = 1e-5 * std::max(std::abs(all[k]), 1e-2 * std::max(1e-6, start[k % 2]));
        moved[k] += step;
        jacobian[i * free + k] = (torque_of(moved, omega, height, in) - torque[i]) / step;
      }
    }
    return std::all_of(torque.begin(), torque.end(), [](double t) { return t > 0.0; });
  };
  LeastSquaresOptions options;
  options.taken.resize(rows.height.size());
  std::iota(options.taken.begin(), options.taken.end(), 0);
  return fit_least_squares(problem, options);
}

/// Of the stress at the wall, by the delta method.
double error_of_stress(const LeastSquaresFit& fit, const Parameters& p, double omega, const SmoothSide& in) {
  const double stress = wall_stress(p[at_tau_i], p[at_k_i], omega, in);
  const double step_tau = 1e-3 * std::max(p[at_tau_i], 1e-3 * stress),
               step_k = 1e-3 * std::max(p[at_k_i], 1e-9);
  const double slope[] = {(wall_stress(p[at_tau_i] + step_tau, p[at_k_i], omega, in) - stress) / step_tau,
                          (wall_stress(p[at_tau_i], p[at_k_i] + step_k, omega, in) - stress) / step_k};
  const std::size_t n = fit.parameters.size();
  double variance = 0.0;
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t k = 0; k < 2; ++k) variance += slope[i] * slope[k] * fit.covariance[i * n + k];
  return std::sqrt(std::max(0.0, variance));
}

/// The torque of the side at the first fill height, over the speed.
FittedCurve curve_of_side(const Rows& rows, const LeastSquaresFit& fit, const Parameters& p,
                          const SmoothSide& in) {
  const double area_times_radius = two_pi * in.radius * in.radius * rows.height.front();
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < rows.height.size(); ++i)
    if (!fit.outlier[i]) order.push_back(i);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.readings.x[a] < rows.readings.x[b]; });
  FittedCurve curve;
  for (const std::size_t i : order) {
    const double omega = rows.readings.x[i], scale = rows.height.front() / rows.height[i],
                 ends = p[at_end_torque] + p[at_end_viscosity] * omega;
    curve.x.push_back(omega);
    curve.observed.push_back(scale * (rows.readings.torque[i] - ends));
    curve.fitted.push_back(scale * (fit.fitted[i] - ends));
    curve.standard_error.push_back(area_times_radius * error_of_stress(fit, p, omega, in));
  }
  return curve;
}

void note_what_is_assumed(const Rows& rows, const Parameters& p, const SmoothSide& in, FitResult& result) {
  const double R = in.radius, fastest = *std::max_element(rows.readings.x.begin(), rows.readings.x.end());
  const double stress = wall_stress(p[at_tau_i], p[at_k_i], fastest, in);
  if (rows.several_heights)
    result.notes.push_back(
        text_of("ends: a torque of %.4g N.m at rest and %.4g N.m at the fastest speed, which does not grow "
                "with the fill "
                "height",
                p[at_end_torque], p[at_end_torque] + p[at_end_viscosity] * fastest));
  else
    result.notes.push_back(
        "ends: one fill height; the torque of the bottom counts as the side's, so that both "
        "parameters read "
        "high. Records at several fill heights, --fill-height \"100 mm; 200 mm\", tell them apart");
  if (!in.tau_0) {
    result.notes.push_back(
        "slip: all of the speed counts as slip; --yield-stress and --plastic-viscosity of the concrete take "
        "off what it "
        "shears itself");
    return;
  }
  const double slip = p[at_k_i] > 0.0 ? std::max(0.0, stress - p[at_tau_i]) / (p[at_k_i] * R * fastest) : 0.0;
  result.notes.push_back(
      text_of("slip: %.0f %% of the fastest speed; the rest is shear of the concrete", 100.0 * slip));
}

void judge(const Rows& rows, const LeastSquaresFit& fit, const Parameters& p, FitResult& result) {
  if (const std::string why = fitting::misfit_of(rows.readings, fit, "the wall is no interface of this law");
      !why.empty())
    result.reasons.push_back(why);
  if (!(p[at_k_i] > 0.0))
    result.reasons.push_back("the torque does not rise with the speed: no viscous layer at the wall");
  const double slowest = *std::min_element(fit.fitted.begin(), fit.fitted.end());
  if (rows.several_heights && p[at_end_torque] < -0.2 * slowest)
    result.reasons.push_back(
        "the torque extrapolated to zero fill height is negative: does --fill-height follow the order of "
        "the records?");
}

}  // namespace

FitResult fit_tribometer(const std::vector<TribometerSeries>& series, const FitInput& input,
                         SmoothWall wall) {
  check(input.instrument);
  const bool container = wall == SmoothWall::container;
  const SmoothSide side{input.instrument, input.tau_0, input.mu,
                        container ? input.instrument.container_radius : input.instrument.vane_radius};
  if (input.tau_0.has_value() != input.mu.has_value())
    throw std::invalid_argument(
        "a tribometer's fit takes both the yield stress and the plastic viscosity of the concrete, or "
        "neither");
  FitResult result;
  result.kind = RecordKind::flow_curve;
  result.model = interface_model;
  const Rows rows = rows_of(series, result);
  const LeastSquaresFit fit = least_squares(rows, side);
  Parameters p{};
  std::copy(fit.parameters.begin(), fit.parameters.end(), p.begin());
  fitting::report(rows.readings, fit, result);
  result.curve = curve_of_side(rows, fit, p, side);
  result.effective_readings = fit.independent;
  judge(rows, fit, p, result);
  if (container)
    result.notes.push_back("wall: the container's; what turns in it is rough and holds the concrete");
  note_what_is_assumed(rows, p, side, result);
  const double largest = *std::max_element(fit.fitted.begin(), fit.fitted.end()), R = side.radius;
  const double stress = largest / (two_pi * R * R * series.front().fill_height);
  for (std::size_t k = 0; k < 2 && result.reasons.empty(); ++k) {
    const FitParameter& row = interface_parameters()[k];
    const double variance = fit.covariance[k * fit.parameters.size() + k];
    const auto e = fit.told[k]
                       ? fitting::estimate(p[k], variance, fit.degrees_of_freedom, k == 0 ? stress : p[k])
                       : std::nullopt;
    set_value(result, row, e);
    if (!e) result.notes.push_back(row.name + ": not identifiable from this record");
  }
  return result;
}

std::vector<double> fill_heights(const std::string& text) {
  std::vector<double> heights;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t to = std::min(text.find_first_of(";,", from), text.size());
    const std::string field = text.substr(from, to - from);
    std::size_t used = 0;
    double value = 0.0;
    try {
      value = std::stod(field, &used);
    } catch (const std::logic_error&) {  // no number: refused below
    }
    std::string unit = field.substr(used);
    std::erase(unit, ' ');
    const double factor = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1.0 : 0.0;
    if (!(value > 0.0 && factor > 0.0))
      throw std::invalid_argument("\"" + field + "\" is no fill height; write \"100 mm; 150 mm\"");
    heights.push_back(factor * value);
    from = to + 1;
  }
  return heights;
}

}  // namespace tremie
