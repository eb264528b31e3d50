#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/protocol/protocol.hpp"
#include "rheometer/records/torque_limit.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

/// Slope [N m/rad] of the torque over the vane's angle while it rises from its first value to half the peak; the rows
/// of the first tenth of the rise are left out, as the drive still gathers speed there.
std::optional<double> rise(const ProtocolRecord& r, std::size_t begin, std::size_t peak) {
  const double first = r.torque[begin], top = r.torque[peak];
  std::vector<double> angle, torque;
  double turned = 0.0;
  for (std::size_t i = begin; i <= peak; ++i) {
    if (i > begin) turned += 0.5 * (r.omega[i] + r.omega[i - 1]) * (r.time[i] - r.time[i - 1]);
    const double share = (r.torque[i] - first) / (top - first);
    if (share > 0.5) break;
    if (i > begin && share < 0.1) continue;
    angle.push_back(turned);
    torque.push_back(r.torque[i]);
  }
  if (angle.size() < 3) return std::nullopt;
  const double slope = straight_line(angle, torque).slope;
  return slope > 0.0 ? std::optional(slope) : std::nullopt;
}

/// Angle [rad] that the vane has turned from its start to the peak.
double angle_until(const ProtocolRecord& r, std::size_t begin, std::size_t peak) {
  double turned = 0.0;
  for (std::size_t i = std::max<std::size_t>(begin, 1); i <= peak; ++i)
    turned += 0.5 * (r.omega[i] + r.omega[i - 1]) * (r.time[i] - r.time[i - 1]);
  return turned;
}

/// Whether rows up to the peak share their times, as in an export that rounds them to fewer digits than its rows need.
bool times_are_rounded(const ProtocolRecord& r, std::size_t begin, std::size_t peak) {
  int shared = 0;
  for (std::size_t i = begin + 1; i <= peak; ++i) shared += r.time[i] == r.time[i - 1] ? 1 : 0;
  return shared >= 2;
}

/// G of an elastic material between the vane and the container: T = 4 pi h G angle/(R_i^-2 - R_o^-2). Blades take of it
/// what they take of a Newtonian fluid, whose equations have strains in place of rates.
std::optional<double> modulus(std::optional<double> slope, const Instrument& in,
                              const ProtocolOptions& options, std::vector<std::string>& notes) {
  if (!slope) {
    notes.push_back("shear_modulus: fewer than 3 rows between the start of the shear and half its peak");
    return std::nullopt;
  }
  const double of_blades = options.blades ? blade_factor(*options.blades, in, 0.0) : 1.0;
  const double material = 1.0 / *slope - options.compliance;
  if (!(material > 0.05 / *slope)) {
    notes.push_back("shear_modulus: the instrument's own compliance explains the rise");
    return std::nullopt;
  }
  const double share =
      1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (in.container_radius * in.container_radius);
  return share / (4.0 * std::numbers::pi * in.vane_height * material) / of_blades;
}

}  // namespace

StartUpReading read_start_up(const ProtocolRecord& r, const Section& s, const Instrument& in,
                             const ProtocolOptions& options, std::vector<std::string>& notes) {
  StartUpReading reading;
  std::size_t peak = s.begin;
  for (std::size_t i = s.begin; i < s.end; ++i)
    if (r.torque[i] > r.torque[peak]) peak = i;
  reading.peak_torque = r.torque[peak];
  reading.end_torque = r.torque[s.end - 1];
  reading.peak_time = r.time[peak] - (s.begin > 0 ? r.time[s.begin - 1] : r.time[s.begin]);
  reading.peak_angle = angle_until(r, s.begin, peak);
  // the torque has to fall again, by more than a reading's scatter
  reading.peak_inside = peak > s.begin && peak + 2 < s.end && reading.end_torque < 0.98 * reading.peak_torque;
  const auto section = [&](const std::vector<double>& v) {
    return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(s.begin),
                               v.begin() + static_cast<std::ptrdiff_t>(s.end));
  };
  const auto limit = torque_limit(section(r.time), section(r.torque));
  if (limit && *std::max_element(r.torque.begin(), r.torque.end()) <= limit->torque * (1.0 + 1e-9)) {
    reading.peak_inside = false;
    notes.push_back(
        text_of("static_yield_stress: %ld rows in a row have the largest torque: the instrument's limit cuts "
                "the peak off",
                limit->rows));
  } else if (reading.peak_inside) {
    reading.static_yield_stress = shear_stress_at(in.vane_radius, reading.peak_torque, in);
    if (times_are_rounded(r, s.begin, peak))
      notes.push_back(
          "shear_modulus: several rows share one time, so the rise over the angle is not identifiable");
    else
      reading.rise = rise(r, s.begin, peak),
      reading.shear_modulus = modulus(reading.rise, in, options, notes);
  } else {
    notes.push_back(peak <= s.begin + 1
                        ? "static_yield_stress: the torque does not rise, so no start-up was recorded"
                        : "static_yield_stress: no peak, the torque still rises at the end of the "
                          "section or stays level");
  }
  return reading;
}

namespace {

/// The line by the stresses without their viscous part, where each peak has one.
void add_line_by_law(const std::vector<SectionReading>& sections, Structuration& result) {
  std::vector<double> rest, stress;
  for (const SectionReading& s : sections) {
    if (!s.start_up || !s.start_up->static_by_law || !(s.section.rest_before > 0.0)) continue;
    rest.push_back(s.section.rest_before);
    stress.push_back(*s.start_up->static_by_law);
  }
  if (rest.size() != result.rest.size()) return;
  const StraightLine line = straight_line(rest, stress);
  result.A_thix_by_law = ParameterEstimate{line.slope, std::nullopt, false};
  result.at_no_rest_by_law = ParameterEstimate{line.at(0.0), std::nullopt, false};
  if (line.n < 3.0) return;
  const double half = line.half_width_of_slope(), half_0 = line.half_width(0.0);
  result.A_thix_by_law->ci95 = Interval{line.slope - half, line.slope + half};
  result.at_no_rest_by_law->ci95 = Interval{line.at(0.0) - half_0, line.at(0.0) + half_0};
}

}  // namespace

std::optional<double> static_yield_stress_of(const KnownLaw& law, double torque, double omega,
                                             const Instrument& in) {
  if (!flow_law(law.name).viscous) return std::nullopt;
  const ViscousStress v = viscous_stress(law);
  const auto with = [&](double tau_y) { return steady_torque({tau_y, v.k, v.n}, omega, in).torque; };
  if (!(v.k > 0.0) || with(0.0) >= torque) return std::nullopt;
  double low = 0.0, high = shear_stress_at(in.vane_radius, torque, in);
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (with(middle) < torque ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Structuration structuration_of(const std::vector<SectionReading>& sections) {
  Structuration result;
  for (const SectionReading& s : sections) {
    if (!s.start_up || !s.start_up->static_yield_stress || !(s.section.rest_before > 0.0)) continue;
    result.rest.push_back(s.section.rest_before);
    result.stress.push_back(*s.start_up->static_yield_stress);
  }
  const StraightLine line = straight_line(result.rest, result.stress);
  if (line.n < 2.0 || !(line.spread_x > 1e-6 * line.mean_x * line.mean_x)) {
    result.notes.push_back("structuration_rate: needs the peaks after two rests of different length");
    return result;
  }
  add_line_by_law(sections, result);
  result.A_thix = ParameterEstimate{line.slope, std::nullopt, false};
  result.at_no_rest = ParameterEstimate{line.at(0.0), std::nullopt, false};
  if (line.n < 3.0) {
    result.notes.push_back("structuration_rate: two peaks tell no interval");
    return result;
  }
  const double half = line.half_width_of_slope(), half_0 = line.half_width(0.0);
  result.A_thix->ci95 = Interval{line.slope - half, line.slope + half};
  result.at_no_rest->ci95 = Interval{line.at(0.0) - half_0, line.at(0.0) + half_0};
  result.scatter = line.deviation / line.mean_y;
  std::vector<std::size_t> order(result.rest.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return result.rest[a] < result.rest[b]; });
  const auto between = [&](std::size_t a, std::size_t b) -> std::optional<double> {
    const double rest = result.rest[b] - result.rest[a];
    return rest > 0.0 ? std::optional((result.stress[b] - result.stress[a]) / rest) : std::nullopt;
  };
  result.saturation = saturation_of(result.rest, result.stress);
  result.forecasts = forecasts_of(result.rest, result.stress);
  result.early = between(order[0], order[1]);
  result.late = between(order[order.size() - 2], order.back());
  if (*result.scatter > 0.05 && result.early && result.late &&
      std::abs(*result.early - *result.late) > 0.3 * line.slope) {
    result.notes.push_back(
        text_of("structuration_rate: the peaks do not lie on a line over the rest: %.3g Pa/s between the two "
                "shortest "
                "rests, %.3g Pa/s between the two longest; the one value is a mean",
                *result.early, *result.late));
  }
  return result;
}

}  // namespace tremie
