#include "rheometer/vane/fit_with_blades.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {
namespace {

constexpr const char* only_bingham = "the blades' factors are those of a Bingham material";

void refuse_other_law(const FitResult& fit) {
  if (fit.kind == RecordKind::flow_curve && fit.model != flow_laws().front().name)
    throw BladesRefused(std::string(only_bingham) + ", which this flow curve is not: " + fit.choice);
}

double viscosity_of(const FitResult& fit) {
  if (fit.mu && fit.mu->value > 0.0) return fit.mu->value;
  throw BladesRefused(
      "the blades' part depends on the plastic viscosity, which is not identifiable from this record; "
      "give it");
}

/// A viscosity to start from. What the blades take of the torques can hide that the material is a Bingham one.
double first_viscosity(const TorqueRecord& record, const FitInput& input) {
  const FitResult fit = tremie::fit(record, input);
  if (fit.model == flow_laws().front().name) return viscosity_of(fit);
  std::vector<FlowPoint> points;
  for (std::size_t i = 0; i < record.torque.size(); ++i)
    if (record.omega[i] > 0.0 && record.torque[i] > 0.0)
      points.push_back({record.omega[i], record.torque[i]});
  const double mu = bingham_from_flow_curve(points, input.instrument).mu;
  if (!(mu > 0.0)) refuse_other_law(fit);
  return mu;
}

/// The viscosity where the input knows it.
std::optional<double> known_viscosity(const FitInput& input) {
  return input.curve ? std::optional(viscosity_for_blades(*input.curve)) : input.mu;
}

/// A note where a reading's Bingham number lies beyond the blades' table: the slowest reading's, with the largest yield
/// stress.
void note_beyond_blades(const TorqueRecord& record, const FitInput& in, const BladeTable& table,
                        FitResult& result) {
  const auto& yield = result.static_yield_stress ? result.static_yield_stress : result.tau_0;
  double slowest = in.omega.value_or(0.0);
  for (const double omega : record.omega)
    if (omega > 0.0 && (slowest <= 0.0 || omega < slowest)) slowest = omega;
  if (!yield || !result.mu || !(slowest > 0.0)) return;
  const double last = largest_bingham_number(table, in.instrument);
  const double Bi = yield->value / (result.mu->value * slowest);
  if (Bi > 1.001 * last)
    result.notes.push_back(
        text_of("blades: the Bingham number, up to %.3g, lies beyond the table's %.3g, whose factor is taken",
                Bi, last));
}

}  // namespace

double viscosity_for_blades(const KnownLaw& known) {
  if (const FlowLaw& law = flow_law(known.name); known.name != flow_laws().front().name)
    throw BladesRefused(std::string(only_bingham) + "; the record's flow curve has the law " + law.words);
  return viscous_stress(known).k;
}

VaneFit fit_with_blades(const TorqueRecord& record, const FitInput& input, const BladeTable& table) {
  const std::optional<double> known = known_viscosity(input);
  if (!known && record.kind != RecordKind::flow_curve)
    throw BladesRefused(
        "the blades' part depends on the plastic viscosity, hardly identifiable from a record at one speed; "
        "give --plastic-viscosity, from a flow curve");
  double mu = known ? *known : first_viscosity(record, input);
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
    if (known) return result;
    refuse_other_law(result.fit);
    const double before = mu;
    mu = viscosity_of(result.fit);
    if (std::abs(mu - before) < 1e-6 * mu) return result;
  }
  throw BladesRefused(
      "the blades' part and the plastic viscosity do not settle together; give the viscosity");
}

FitResult noted_fit_with_blades(const TorqueRecord& record, const FitInput& in, const BladeTable& table) {
  VaneFit vane = fit_with_blades(record, in, table);
  vane.fit.notes.push_back(text_of(
      "torques are the cylinder's: the record's divided by %.3f to %.3f, what four thin blades take of it",
      vane.least_factor, vane.most_factor));
  note_beyond_blades(record, in, table, vane.fit);
  if (vane.fit.alpha && !vane.fit.alpha->given)
    vane.fit.notes.push_back(
        "alpha: with blades it reads some 30 % too small, more than its interval: the concrete between the "
        "blades is not broken down; without --blades the two errors nearly cancel");
  return vane.fit;
}

}  // namespace tremie
