#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/flow_curve/law_choice.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie::fitting {

namespace {

constexpr std::size_t most_readings = 2000;

Readings readings_of(const TorqueRecord& record, FitResult& result) {
  std::vector<std::size_t> order(record.torque.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return record.omega[a] < record.omega[b]; });
  Readings all;
  for (const std::size_t i : order) {
    if (record.omega[i] <= 0.0)
      drop(result, record.line[i], record.omega[i], record.torque[i],
           "no speed: not a point of the flow curve");
    else if (record.torque[i] <= 0.0)
      drop(result, record.line[i], record.omega[i], record.torque[i], "no torque");
    else
      all.push(record.omega[i], record.torque[i], 1.0, record.line[i]);
  }
  return condense(all, most_readings, result);
}

bool has_viscosity(const FlowLaw& law) {
  return std::any_of(law.parameters.begin(), law.parameters.end(),
                     [](const LawParameter& p) { return p.row.member == &FitResult::mu; });
}

/// Of the fitted torque at a speed, by the delta method [(N m)^2].
double variance_of_torque(const FittedLaw& f, double omega, const Instrument& in) {
  const std::size_t n = f.free.size();
  const auto slope = f.at(omega, in).slope;
  double variance = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      variance += slope[f.free[i]] * slope[f.free[k]] * f.fit.covariance[i * n + k];
  return std::max(0.0, variance);
}

/// How many of the slowest readings lie on a branch where the torque rises as the speed falls, by more than
/// scatter: structure builds up there faster than the shear breaks it, and no Bingham material does that.
std::size_t below_torque_minimum(const Readings& r, const FitInput& input) {
  const auto lowest = std::min_element(r.torque.begin(), r.torque.end()) - r.torque.begin();
  const auto first = static_cast<std::size_t>(lowest);
  std::vector<char> slow(r.size(), 0);
  for (std::size_t i = 0; i < first; ++i) slow[i] = r.x[i] < r.x[first];
  const Readings fast = without(r, slow);
  if (fast.size() == r.size() || fast.size() < 3 || !several_speeds(fast)) return 0;
  const FittedLaw f = least_squares(fast, input, flow_laws().front());
  if (f.fit.degrees_of_freedom < 1.0) return 0;
  // the one-in-a-thousand point of a new reading, with a fifth for the uncertainty of the curve
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  for (std::size_t i = first; i-- > 0;) {
    const double expected = f.at(r.x[i], input.instrument).torque;
    if (slow[i] && std::sqrt(r.count[i]) * (r.torque[i] / expected - 1.0) > cut) return i + 1;
  }
  return 0;
}

/// How far the slowest readings lie below what the faster ones ask for by this law, as a share; 0 where they do not by
/// more than scatter. A layer of water at the vane carries it at low speed: wall slip.
double below_the_curve(const Readings& r, const FitInput& input, const FlowLaw& law) {
  const std::size_t slow = r.size() / 3, fewest = law.parameters.size() + 2;
  if (slow < 2) return 0.0;
  std::vector<char> leave_out(r.size(), 0);
  std::fill_n(leave_out.begin(), slow, 1);
  const Readings fast = without(r, leave_out);
  if (fast.size() < fewest || !several_speeds(fast)) return 0.0;
  const FittedLaw f = least_squares(fast, input, law);
  const double degrees = static_cast<double>(fast.size() - f.free.size());
  if (f.fit.degrees_of_freedom < 1.0 || f.yield_stress() <= 0.0) return 0.0;
  const bool first = &law == &flow_laws().front();
  const double cut = 1.2 * student_quantile(0.999, first ? degrees : f.fit.degrees_of_freedom);
  double sum = 0.0;
  for (std::size_t i = 0; i < slow; ++i) {
    const double torque = f.at(r.x[i], input.instrument).torque, miss = r.torque[i] / torque - 1.0;
    const double own = std::max(f.fit.scatter, 1e-6) / std::sqrt(r.count[i]);
    // a curve of three parameters is hardly known where it leaves its readings
    const double curve = first ? 0.0 : variance_of_torque(f, r.x[i], input.instrument) / (torque * torque);
    if (!(miss < -cut * std::sqrt(own * own + curve))) return 0.0;
    sum -= miss;
  }
  return sum / static_cast<double>(slow);
}

void report_plug(const Readings& r, const FittedLaw& f, const FitInput& input, FitResult& result) {
  result.sheared_radius = f.at(r.x.front(), input.instrument).sheared_radius;
  result.plug = *result.sheared_radius < input.instrument.container_radius * (1.0 - 1e-12);
  if (f.law->plug_below) result.plug_below = f.law->plug_below(f.all, input.instrument);
}

void report_band(const FittedLaw& f, const FitInput& input, FitResult& result) {
  for (const double omega : result.curve.x)
    result.curve.standard_error.push_back(std::sqrt(variance_of_torque(f, omega, input.instrument)));
}

/// Notes "consistency, flow_index: not identifiable from this record" for the law's parameters after the yield stress that have
/// no value.
void note_unidentifiable(const FittedLaw& f, FitResult& result) {
  std::string names;
  const auto& parameters = f.law->parameters;
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    if (!(f.all[k] > 0.0) || value_of(result, parameters[k].row)) continue;
    names += (names.empty() ? "" : ", ") + parameters[k].row.name;
  }
  if (!names.empty()) result.notes.push_back(names + ": not identifiable from this record");
}

void report_covariance(const FittedLaw& f, FitResult& result) {
  const std::size_t n = f.free.size(), all = f.all.size();
  if (!(f.fit.degrees_of_freedom > 0.0)) return;
  const double t = student_quantile(0.975, f.fit.degrees_of_freedom) / 1.96;
  result.law_covariance.assign(all * all, 0.0);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < n; ++k)
      result.law_covariance[f.free[i] * all + f.free[k]] = t * t * f.fit.covariance[i * n + k];
}

void report_parameters(const Readings& r, const FittedLaw& f, const FitInput& input, FitResult& result) {
  const std::size_t n = f.free.size();
  const double degrees = f.fit.degrees_of_freedom;
  const double slowest = shear_stress_at(input.instrument.vane_radius, r.torque.front(), input.instrument);
  const double fastest = shear_stress_at(input.instrument.vane_radius, r.torque.back(), input.instrument);
  const double apparent = fastest / newtonian_shear_rate(r.x.back(), input.instrument);
  for (const LawParameter& p : f.law->parameters)
    if (const auto value = given_value(input, p)) set_value(result, p.row, given(*value));
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = f.free[i];
    const FitParameter& row = f.law->parameters[k].row;
    const double value = f.all[k];
    const bool viscosity = row.member == &FitResult::mu;
    // A viscosity that makes less than 1e-5 of the torque is lost in how far the model solves its equations.
    if (!f.fit.told[i] || (viscosity && !(value > 1e-5 * apparent))) continue;
    const double scale = k == 0 ? std::max(value, slowest) : viscosity ? std::max(value, apparent) : value;
    set_value(result, row, estimate(value, f.fit.covariance[i * n + i], degrees, scale));
  }
  if (!f.law->in_place_of_viscosity.empty())
    result.notes.push_back("plastic_viscosity: " + f.law->in_place_of_viscosity);
  if (f.yield_stress() <= 0.0)
    result.notes.push_back(
        "yield_stress: the torque rises at least in proportion to the speed; its interval starts at 0");
  if (degrees <= 0.0)
    result.notes.push_back(
        "as many readings as parameters: the curve passes through all, and no interval can be told");
  if (!result.tau_0) result.notes.push_back("yield_stress: not identifiable from this record");
  note_unidentifiable(f, result);
}

/// The torque falls as the speed rises, over the whole record and by more than scatter: no material of either law does.
bool torque_falls(const Readings& r) {
  if (r.size() < 4) return r.torque.back() < 0.97 * r.torque.front();
  const StraightLine line = straight_line(r.x, r.torque);
  return line.slope < -student_quantile(0.999, line.n - 2.0) * line.deviation / std::sqrt(line.spread_x) &&
         line.slope * (r.x.back() - r.x.front()) < -0.03 * line.mean_y;
}

void withdraw(const FittedLaw& f, const FitInput& input, FitResult& result) {
  std::string names;
  for (const LawParameter& p : f.law->parameters) {
    if (given_value(input, p)) continue;
    set_value(result, p.row, std::nullopt);
    names += (names.empty() ? "" : ", ") + p.row.name;
  }
  result.plug_below.reset();
  result.notes.push_back(names + ": not identifiable from a model that does not fit");
}

void require_flow_curve(const Readings& r, const FitInput& input) {
  if (input.mu && input.law != "auto" && !has_viscosity(flow_law(input.law)))
    throw std::invalid_argument(flow_law(input.law).words + " has no plastic viscosity that could be given");
  if (input.tau_0 && input.mu)
    throw std::invalid_argument(
        "both the yield stress and the plastic viscosity are given; nothing is left to fit");
  if (r.size() < 2)
    throw std::invalid_argument(
        "a flow curve needs at least two rows with a speed and a torque greater than 0; " +
        std::to_string(r.size()) + " found");
  if (!several_speeds(r))
    throw std::invalid_argument("all rows have the same speed; a flow curve needs two speeds or more");
}

/// Neighbours at an end of the curve that miss to the same side are a part that the law does not describe.
void note_end_left_out(const Readings& r, const FittedLaw& f, FitResult& result) {
  constexpr std::size_t fewest = 3;
  for (const bool fast : {true, false}) {
    const auto misses = [&](std::size_t k) {
      const std::size_t i = fast ? r.size() - 1 - k : k;
      return f.fit.outlier[i] ? f.fit.residual[i] : 0.0;
    };
    std::size_t run = 0;
    while (run < r.size() && misses(run) * misses(0) > 0.0) ++run;
    if (run >= fewest)
      result.notes.push_back(text_of(
          "law: the %zu %s readings lie %s the curve and were left out; the values hold for the others", run,
          fast ? "fastest" : "slowest", misses(0) > 0.0 ? "above" : "below"));
  }
}

/// Why the law does not describe the readings.
std::vector<std::string> reasons_of(const Readings& r, const FittedLaw& f) {
  std::vector<std::string> reasons;
  if (const LawParameter* p = at_bound(f))
    reasons.push_back(
        "the " + p->row.label +
        text_of(" lies at the end of its range, %.3g to %.3g: the law does not describe the record", p->lower,
                p->upper));
  if (torque_falls(r))
    reasons.push_back(
        "the torque falls as the speed rises, which neither a Bingham nor a Herschel-Bulkley "
        "material does: structure still broke down, or a layer slips at the vane");
  if (const std::string why = misfit_of(r, f.fit, "the torque does not follow this law over the speed");
      !why.empty())
    reasons.push_back(why);
  return reasons;
}

/// A fit by the input's law; `better` where another law should be taken in its place or beside it.
FitResult fit_by_law(const TorqueRecord& record, const FitInput& input, std::optional<BetterLaw>& better) {
  FitResult result;
  result.kind = RecordKind::flow_curve;
  Readings r = readings_of(record, result);
  require_flow_curve(r, input);
  std::vector<char> leave_out(r.size(), 0);
  std::fill_n(leave_out.begin(), below_torque_minimum(r, input), 1);
  r = dropping(r, leave_out, "below the torque minimum: the torque rises as the speed falls", result);
  const FittedLaw f = choose_law(r, input, result);
  result.model = f.law->name;
  report(r, f.fit, result);
  const auto kept = static_cast<double>(result.curve.x.size());
  result.effective_readings = static_cast<double>(result.readings) * f.fit.independent / std::max(1.0, kept);
  report_parameters(r, f, input, result);
  note_end_left_out(r, f, result);
  report_covariance(f, result);
  report_plug(r, f, input, result);
  report_band(f, input, result);
  if (f.all[1] <= 0.0)
    result.notes.push_back(
        "plastic_viscosity: the torque does not rise with the speed, so it is not identifiable from this "
        "record");
  for (const std::string& why : reasons_of(r, f)) result.reasons.push_back(why);
  better = better_law(r, input, f, !result.reasons.empty());
  if (better) {
    result.law_in_doubt = true;
    result.notes.push_back("yield_stress: depends on the law: " + better->words + "; --law " +
                           better->fitted.law->name);
  }
  if (!result.reasons.empty()) withdraw(f, input, result);
  if (const double slip = below_the_curve(r, input, *f.law); slip > 0.0)
    result.reasons.push_back("wall slip is likely: the slowest third of the readings lies " +
                             std::to_string(std::lround(100.0 * slip)) +
                             " % below the curve of the faster ones; the yield stress may be too low");
  return result;
}

}  // namespace

FitResult fit_flow_curve(const TorqueRecord& record, const FitInput& input) {
  std::optional<BetterLaw> better, none;
  FitResult result = fit_by_law(record, input, better);
  if (!better || !better->refuses) return result;
  FitInput by_other = input;
  by_other.law = better->fitted.law->name;
  FitResult other = fit_by_law(record, by_other, none);
  if (!other.reasons.empty()) return result;
  const std::string& first = flow_law(input.law).words;
  other.choice = "law " + other.model + ": " + first + " is refused; " + better->words;
  other.notes.push_back("law: " + first + " does not describe this record; the values are " +
                        better->fitted.law->words + "'s");
  other.candidates.insert(other.candidates.begin(), result.candidates.front());
  other.candidates.front().chosen = false;
  return other;
}

}  // namespace tremie::fitting
