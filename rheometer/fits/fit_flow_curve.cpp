#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
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

bool several_speeds(const Readings& r) { return r.size() >= 2 && r.x.back() > r.x.front() * (1.0 + 1e-9); }

/// A law with all of its parameters, given or fitted.
struct Fitted {
  const FlowLaw* law = nullptr;
  std::vector<double> all;
  std::vector<std::size_t> free;  ///< of `all`: those in fit.parameters
  LeastSquaresFit fit;

  double yield_stress() const { return all[0]; }
  FlowTorque at(double omega, const Instrument& in) const { return law->torque(all, omega, in); }
};

/// The parameter's value where the input gives it.
std::optional<double> given_value(const FitInput& input, const LawParameter& p) {
  return p.row.member == &FitResult::tau_0 ? input.tau_0
         : p.row.member == &FitResult::mu  ? input.mu
                                           : std::nullopt;
}

bool has_viscosity(const FlowLaw& law) {
  return std::any_of(law.parameters.begin(), law.parameters.end(),
                     [](const LawParameter& p) { return p.row.member == &FitResult::mu; });
}

std::vector<double> with(const Fitted& fitted, std::span<const double> p) {
  std::vector<double> all = fitted.all;
  for (std::size_t i = 0; i < p.size(); ++i) all[fitted.free[i]] = p[i];
  return all;
}

/// The parameters of the law that are not given.
Fitted least_squares(const Readings& r, const FitInput& input, const FlowLaw& law) {
  std::vector<FlowPoint> points;
  for (std::size_t i = 0; i < r.size(); ++i) points.push_back({r.x[i], r.torque[i]});
  Fitted fitted{&law, law.start(bingham_from_flow_curve(points, input.instrument)), {}, {}};
  LeastSquaresProblem problem;
  problem.observed = r.torque;
  problem.count = r.count;
  for (std::size_t k = 0; k < law.parameters.size(); ++k) {
    if (const auto value = given_value(input, law.parameters[k])) {
      fitted.all[k] = *value;
      continue;
    }
    fitted.free.push_back(k);
    problem.start.push_back(fitted.all[k]);
    problem.lower.push_back(law.parameters[k].lower);
    problem.upper.push_back(law.parameters[k].upper);
  }
  problem.model = [&](std::span<const double> p, std::span<double> torque, std::span<double> jacobian) {
    const std::vector<double> all = with(fitted, p);
    for (std::size_t i = 0, at = 0; i < r.size(); ++i) {
      const FlowTorque t = law.torque(all, r.x[i], input.instrument);
      torque[i] = t.torque;
      if (jacobian.empty()) continue;
      for (const std::size_t k : fitted.free) jacobian[at++] = t.slope[k];
    }
    return std::all_of(torque.begin(), torque.end(), [](double t) { return t > 0.0; });
  };
  fitted.fit = fit_least_squares(problem);
  fitted.all = with(fitted, fitted.fit.parameters);
  return fitted;
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
  const Fitted f = least_squares(fast, input, flow_laws().front());
  if (f.fit.degrees_of_freedom < 1.0) return 0;
  // the one-in-a-thousand point of a new reading, with a fifth for the uncertainty of the curve
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  for (std::size_t i = first; i-- > 0;) {
    const double expected = f.at(r.x[i], input.instrument).torque;
    if (slow[i] && std::sqrt(r.count[i]) * (r.torque[i] / expected - 1.0) > cut) return i + 1;
  }
  return 0;
}

/// How far the slowest readings lie below what the faster ones ask for, as a share; 0 where they do not by more than
/// scatter. A layer of water at the vane carries it at low speed: wall slip.
double below_the_curve(const Readings& r, const FitInput& input) {
  const std::size_t slow = r.size() / 3;
  if (slow < 2) return 0.0;
  std::vector<char> leave_out(r.size(), 0);
  std::fill_n(leave_out.begin(), slow, 1);
  const Readings fast = without(r, leave_out);
  if (fast.size() < 4 || !several_speeds(fast)) return 0.0;
  const Fitted f = least_squares(fast, input, flow_laws().front());
  if (f.fit.degrees_of_freedom < 1.0 || f.yield_stress() <= 0.0) return 0.0;
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  double sum = 0.0;
  for (std::size_t i = 0; i < slow; ++i) {
    const double miss = r.torque[i] / f.at(r.x[i], input.instrument).torque - 1.0;
    if (!(std::sqrt(r.count[i]) * miss < -cut)) return 0.0;
    sum -= miss;
  }
  return sum / static_cast<double>(slow);
}

void report_plug(const Readings& r, const Fitted& f, const FitInput& input, FitResult& result) {
  result.sheared_radius = f.at(r.x.front(), input.instrument).sheared_radius;
  result.plug = *result.sheared_radius < input.instrument.container_radius * (1.0 - 1e-12);
  if (f.law->plug_below) result.plug_below = f.law->plug_below(f.all, input.instrument);
}

/// Delta method for the band around the fitted curve.
void report_band(const Fitted& f, const FitInput& input, FitResult& result) {
  const std::size_t n = f.free.size();
  for (const double omega : result.curve.x) {
    const auto slope = f.at(omega, input.instrument).slope;
    double variance = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k)
        variance += slope[f.free[i]] * slope[f.free[k]] * f.fit.covariance[i * n + k];
    result.curve.standard_error.push_back(std::sqrt(std::max(0.0, variance)));
  }
}

/// "consistency, flow_index: the record cannot tell them" of the law's parameters behind the yield stress.
void note_unidentifiable(const Fitted& f, FitResult& result) {
  std::string names;
  bool missing = false;
  const auto& parameters = f.law->parameters;
  for (std::size_t k = 1; k < parameters.size(); ++k) {
    names += (names.empty() ? "" : ", ") + parameters[k].row.name;
    missing = missing || (f.all[k] > 0.0 && !value_of(result, parameters[k].row));
  }
  if (missing)
    result.notes.push_back(names + ": the record cannot tell " + (parameters.size() > 2 ? "them" : "it"));
}

void report_parameters(const Readings& r, const Fitted& f, const FitInput& input, FitResult& result) {
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
    if (!f.fit.told[i] || (viscosity && !(value > 0.0))) continue;
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
  if (!result.tau_0) result.notes.push_back("yield_stress: the record cannot tell it");
  note_unidentifiable(f, result);
}

double mean_square(const LeastSquaresFit& f) {
  double sum = 0.0;
  for (const double e : f.residual) sum += e * e;
  return sum / static_cast<double>(f.residual.size());
}

/// The parameter that lies at an end of its law's range, which is no measurement of it; null where none does.
const LawParameter* at_bound(const Fitted& f) {
  constexpr double near = 1e-3;
  for (std::size_t k = 0; k < f.all.size(); ++k) {
    const LawParameter& p = f.law->parameters[k];
    if (p.has_range() && (f.all[k] < p.lower + near || f.all[k] > p.upper - near)) return &p;
  }
  return nullptr;
}

double akaike(const Readings& r, const Fitted& f) {
  return corrected_akaike(mean_square(f.fit), static_cast<double>(r.size()), static_cast<int>(f.free.size()));
}

/// The laws that are asked for and that the readings suffice for.
std::vector<Fitted> fit_candidates(const Readings& r, const FitInput& input) {
  std::vector<Fitted> fits;
  for (const FlowLaw& law : flow_laws()) {
    if (input.law != "auto" && input.law != law.name) continue;
    const bool first = &law == &flow_laws().front();
    if (!first && (input.mu || r.size() <= law.parameters.size())) continue;
    fits.push_back(least_squares(r, input, law));
  }
  if (!fits.empty()) return fits;
  static const char* const numbers[] = {"one", "two", "three", "four"};
  const FlowLaw& law = flow_law(input.law);
  throw std::invalid_argument(law.words + " needs at least " + numbers[law.parameters.size()] + " rows; " +
                              std::to_string(r.size()) + " found");
}

/// "law bingham: Herschel-Bulkley's AICc is not smaller by more than 4, on 12 readings".
std::string choice_of(const std::vector<Fitted>& fits, std::size_t best, std::size_t readings) {
  std::string others;
  for (std::size_t i = 1; i < fits.size(); ++i) others += (i > 1 ? ", " : "") + fits[i].law->words + "'s";
  return "law " + fits[best].law->name +
         (best > 0 ? ": its AICc is smaller by more than 4, on "
                   : ": " + others + " AICc is not smaller by more than 4, on ") +
         std::to_string(readings) + " readings";
}

/// Every reading is one speed held for a while or a mean: they count as independent.
Fitted choose(const Readings& r, const FitInput& input, FitResult& result) {
  const std::vector<Fitted> fits = fit_candidates(r, input);
  std::vector<double> aicc;
  for (const Fitted& f : fits) aicc.push_back(fits.size() > 1 && at_bound(f) ? HUGE_VAL : akaike(r, f));
  // The first, the law of fewest parameters, unless another is clearly better: within 4 the data support both
  // (Burnham and Anderson 2002), and the last digits of the torques would choose.
  constexpr double clearly = 4.0;
  std::size_t best = 0;
  for (std::size_t i = 1; i < fits.size(); ++i)
    if (aicc[i] < aicc[0] - clearly && (best == 0 || aicc[i] < aicc[best])) best = i;
  for (std::size_t i = 0; i < fits.size(); ++i)
    add_candidate(fits[i].law->name, r, fits[i].fit, aicc[i], aicc[best], i == best, result);
  if (fits.size() > 1) result.choice = choice_of(fits, best, r.size());
  return fits[best];
}

/// A sentence where another law describes the readings of the first far better and gives another yield stress: a
/// difference of 10 in AICc leaves the first no support (Burnham and Anderson 2002). Empty otherwise.
std::string better_law(const Readings& r, const FitInput& input, const Fitted& first) {
  constexpr double no_support = 10.0, another = 0.1;
  constexpr std::size_t fewest = 6, most = 1000;
  if (input.law != flow_laws().front().name || input.mu || input.tau_0 || r.size() < fewest ||
      r.size() > most)
    return {};
  double least = akaike(r, first) - no_support;
  std::string text;
  for (const FlowLaw& law : std::span(flow_laws()).subspan(1)) {
    const Fitted f = least_squares(r, input, law);
    const double tau_0 = first.yield_stress(), other = f.yield_stress(), aicc = akaike(r, f);
    if (at_bound(f) || aicc > least || std::abs(other - tau_0) < another * tau_0) continue;
    least = aicc;
    text = "yield_stress: hangs on the law: " + law.words +
           text_of(" describes these readings far better (scatter %.2g %% for %.2g %%) and has %.3g Pa",
                   100.0 * f.fit.scatter, 100.0 * first.fit.scatter, other);
    for (std::size_t k = 0; k < f.all.size(); ++k)
      if (law.parameters[k].has_range())
        text += text_of(" with %s = %.2g", law.parameters[k].row.symbol.c_str(), f.all[k]);
    text += "; --law " + law.name;
  }
  return text;
}

/// The torque falls as the speed rises, over the whole record and by more than scatter: no material of either law does.
bool torque_falls(const Readings& r) {
  if (r.size() < 4) return r.torque.back() < 0.97 * r.torque.front();
  const StraightLine line = straight_line(r.x, r.torque);
  return line.slope < -student_quantile(0.999, line.n - 2.0) * line.deviation / std::sqrt(line.spread_x) &&
         line.slope * (r.x.back() - r.x.front()) < -0.03 * line.mean_y;
}

void withdraw(const FitInput& input, FitResult& result) {
  if (!input.tau_0) result.tau_0.reset();
  if (!input.mu) result.mu.reset();
  result.of_law.clear();
  result.plug_below.reset();
  result.notes.push_back("yield_stress, plastic_viscosity: a model that does not fit does not tell them");
}

}  // namespace

FitResult fit_flow_curve(const TorqueRecord& record, const FitInput& input) {
  FitResult result;
  result.kind = RecordKind::flow_curve;
  Readings r = readings_of(record, result);
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

  std::vector<char> leave_out(r.size(), 0);
  std::fill_n(leave_out.begin(), below_torque_minimum(r, input), 1);
  r = dropping(r, leave_out, "below the torque minimum: the torque rises as the speed falls", result);
  const double slip = below_the_curve(r, input);
  const Fitted f = choose(r, input, result);
  result.model = f.law->name;
  report(r, f.fit, result);
  result.effective_readings = static_cast<double>(result.readings);
  report_parameters(r, f, input, result);
  report_plug(r, f, input, result);
  report_band(f, input, result);
  if (f.all[1] <= 0.0)
    result.notes.push_back(
        "plastic_viscosity: the torque does not rise with the speed, so the record cannot tell it");
  if (const LawParameter* p = at_bound(f))
    result.reasons.push_back(
        "the " + p->row.label +
        text_of(" lies at the end of its range, %.3g to %.3g: the law does not describe the record", p->lower,
                p->upper));
  if (torque_falls(r))
    result.reasons.push_back(
        "the torque falls as the speed rises, which neither a Bingham nor a Herschel-Bulkley "
        "material does: structure still broke down, or a layer slips at the vane");
  if (const std::string why = misfit_of(r, f.fit, "the torque does not follow this law over the speed");
      !why.empty())
    result.reasons.push_back(why);
  if (const std::string better = better_law(r, input, f); !better.empty()) {
    result.law_in_doubt = true;
    result.notes.push_back(better);
  }
  if (!result.reasons.empty()) withdraw(input, result);
  if (slip > 0.0)
    result.reasons.push_back("wall slip is likely: the slowest third of the readings lies " +
                             std::to_string(std::lround(100.0 * slip)) +
                             " % below the curve of the faster ones; the yield stress may be too low");
  return result;
}

}  // namespace tremie::fitting
