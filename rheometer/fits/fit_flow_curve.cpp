#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <stdexcept>

#include "rheometer/fits/fit_common.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/statistics.hpp"

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

/// Parameters of either law; k is mu and n is 1 for Bingham.
struct Fitted {
  FlowLaw law = FlowLaw::bingham;
  HerschelBulkleyFluid fluid;
  std::vector<std::size_t> free;  ///< of tau_0, k, n: those in fit.parameters
  LeastSquaresFit fit;

  Bingham bingham() const { return {fluid.tau_0, fluid.k}; }
  std::optional<std::size_t> place_of(std::size_t index) const {
    const auto at = std::find(free.begin(), free.end(), index);
    return at == free.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - free.begin()));
  }
};

HerschelBulkleyTorque torque_of(FlowLaw law, const HerschelBulkleyFluid& f, double omega,
                                const Instrument& in) {
  if (law == FlowLaw::herschel_bulkley) return herschel_bulkley_torque(f, omega, in);
  const CouetteState s = reiner_riwlin({f.tau_0, f.k}, omega, in);
  return {s.torque, s.sheared_radius, s.d_torque_d_tau_0, s.d_torque_d_mu, 0.0};
}

HerschelBulkleyFluid with(const Fitted& fitted, std::span<const double> p) {
  HerschelBulkleyFluid f = fitted.fluid;
  double* const all[] = {&f.tau_0, &f.k, &f.n};
  for (std::size_t i = 0; i < p.size(); ++i) *all[fitted.free[i]] = p[i];
  return f;
}

/// The parameters of the law that are not given.
Fitted least_squares(const Readings& r, const FitInput& input, FlowLaw law) {
  std::vector<FlowPoint> points;
  for (std::size_t i = 0; i < r.size(); ++i) points.push_back({r.x[i], r.torque[i]});
  const Bingham start = bingham_from_flow_curve(points, input.instrument);
  const bool hb = law == FlowLaw::herschel_bulkley;
  Fitted fitted{law, {input.tau_0.value_or(start.tau_0), input.mu.value_or(start.mu), 1.0}, {}, {}};
  if (hb) fitted.fluid.k = std::max(fitted.fluid.k, 1e-6);
  if (!input.tau_0) fitted.free.push_back(0);
  if (!input.mu) fitted.free.push_back(1);
  if (hb) fitted.free.push_back(2);

  LeastSquaresProblem problem;
  problem.observed = r.torque;
  problem.count = r.count;
  const double first[] = {fitted.fluid.tau_0, fitted.fluid.k, 1.0}, lower[] = {0.0, hb ? 1e-9 : 0.0, 0.2},
               upper[] = {1e9, 1e9, 2.0};
  for (const std::size_t k : fitted.free) {
    problem.start.push_back(first[k]);
    problem.lower.push_back(lower[k]);
    problem.upper.push_back(upper[k]);
  }
  problem.model = [&](std::span<const double> p, std::span<double> torque, std::span<double> jacobian) {
    const HerschelBulkleyFluid f = with(fitted, p);
    for (std::size_t i = 0, at = 0; i < r.size(); ++i) {
      const HerschelBulkleyTorque t = torque_of(law, f, r.x[i], input.instrument);
      torque[i] = t.torque;
      if (jacobian.empty()) continue;
      const double slope[] = {t.d_tau_0, t.d_k, t.d_n};
      for (const std::size_t k : fitted.free) jacobian[at++] = slope[k];
    }
    return std::all_of(torque.begin(), torque.end(), [](double t) { return t > 0.0; });
  };
  fitted.fit = fit_least_squares(problem);
  fitted.fluid = with(fitted, fitted.fit.parameters);
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
  const Fitted f = least_squares(fast, input, FlowLaw::bingham);
  if (f.fit.degrees_of_freedom < 1.0) return 0;
  // the one-in-a-thousand point of a new reading, with a fifth for the uncertainty of the curve
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  for (std::size_t i = first; i-- > 0;) {
    const double expected = reiner_riwlin(f.bingham(), r.x[i], input.instrument).torque;
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
  const Fitted f = least_squares(fast, input, FlowLaw::bingham);
  if (f.fit.degrees_of_freedom < 1.0 || f.fluid.tau_0 <= 0.0) return 0.0;
  const double cut = 1.2 * student_quantile(0.999, f.fit.degrees_of_freedom) * std::max(f.fit.scatter, 1e-6);
  double sum = 0.0;
  for (std::size_t i = 0; i < slow; ++i) {
    const double miss = r.torque[i] / reiner_riwlin(f.bingham(), r.x[i], input.instrument).torque - 1.0;
    if (!(std::sqrt(r.count[i]) * miss < -cut)) return 0.0;
    sum -= miss;
  }
  return sum / static_cast<double>(slow);
}

void report_plug(const Readings& r, const Fitted& f, const FitInput& input, FitResult& result) {
  const double ratio = input.instrument.container_radius / input.instrument.vane_radius;
  result.sheared_radius = torque_of(f.law, f.fluid, r.x.front(), input.instrument).sheared_radius;
  result.plug = *result.sheared_radius < input.instrument.container_radius * (1.0 - 1e-12);
  if (f.law == FlowLaw::bingham && f.fluid.tau_0 > 0.0 && f.fluid.k > 0.0)
    result.plug_below = f.fluid.tau_0 / (2.0 * f.fluid.k) * (ratio * ratio - 1.0 - 2.0 * std::log(ratio));
}

/// Delta method for the band around the fitted curve.
void report_band(const Fitted& f, const FitInput& input, FitResult& result) {
  const std::size_t n = f.free.size();
  for (const double omega : result.curve.x) {
    const HerschelBulkleyTorque t = torque_of(f.law, f.fluid, omega, input.instrument);
    const double slope[] = {t.d_tau_0, t.d_k, t.d_n};
    double variance = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k)
        variance += slope[f.free[i]] * slope[f.free[k]] * f.fit.covariance[i * n + k];
    result.curve.standard_error.push_back(std::sqrt(std::max(0.0, variance)));
  }
}

void report_parameters(const Readings& r, const Fitted& f, const FitInput& input, FitResult& result) {
  const std::size_t n = f.free.size();
  const double degrees = f.fit.degrees_of_freedom;
  const auto estimate = [&](std::size_t index, double value, double scale) -> std::optional<Estimate> {
    const auto k = f.place_of(index);
    if (!k || !f.fit.told[*k]) return std::nullopt;
    return tell(value, f.fit.covariance[*k * n + *k], degrees, scale);
  };
  const double slowest = shear_stress_at(input.instrument.vane_radius, r.torque.front(), input.instrument);
  const double fastest = shear_stress_at(input.instrument.vane_radius, r.torque.back(), input.instrument);
  const double apparent = fastest / newtonian_shear_rate(r.x.back(), input.instrument);
  const bool hb = f.law == FlowLaw::herschel_bulkley;
  result.tau_0 =
      input.tau_0 ? given(*input.tau_0) : estimate(0, f.fluid.tau_0, std::max(f.fluid.tau_0, slowest));
  if (hb) {
    result.consistency = estimate(1, f.fluid.k, f.fluid.k);
    result.flow_index = estimate(2, f.fluid.n, f.fluid.n);
    result.notes.push_back(
        "plastic_viscosity: Herschel-Bulkley has a consistency and a flow index in its place");
  } else if (input.mu) {
    result.mu = given(*input.mu);
  } else if (f.fluid.k > 0.0) {
    result.mu = estimate(1, f.fluid.k, std::max(f.fluid.k, apparent));
  }
  if (f.fluid.tau_0 <= 0.0)
    result.notes.push_back(
        "yield_stress: the torque rises at least in proportion to the speed; its interval starts at 0");
  if (degrees <= 0.0)
    result.notes.push_back(
        "as many readings as parameters: the curve passes through all, and no interval can be told");
  if (!result.tau_0) result.notes.push_back("yield_stress: the record cannot tell it");
  if (!hb && !result.mu && f.fluid.k > 0.0)
    result.notes.push_back("plastic_viscosity: the record cannot tell it");
  if (hb && (!result.consistency || !result.flow_index))
    result.notes.push_back("consistency, flow_index: the record cannot tell them");
}

/// Residuals in the order of speed, without outliers.
std::string misfit(const Readings& r, const LeastSquaresFit& f) {
  std::vector<double> x, residual;
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (f.outlier[i]) continue;
    x.push_back(r.x[i]);
    residual.push_back(f.residual[i]);
  }
  return misfit_of(x, residual, "the torque goes otherwise with the speed than this law");
}

const char* name_of(FlowLaw law) { return law == FlowLaw::bingham ? "bingham" : "herschel_bulkley"; }

double mean_square(const LeastSquaresFit& f) {
  double sum = 0.0;
  for (const double e : f.residual) sum += e * e;
  return sum / static_cast<double>(f.residual.size());
}

/// A flow index at an end of its range is no measurement of it.
bool at_bound(const Fitted& f) {
  return f.law == FlowLaw::herschel_bulkley && (f.fluid.n < 0.201 || f.fluid.n > 1.999);
}

/// Every reading is one speed held for a while or a mean: they count as independent.
Fitted choose(const Readings& r, const FitInput& input, FitResult& result) {
  std::vector<Fitted> fits;
  if (input.law != FlowLaw::herschel_bulkley) fits.push_back(least_squares(r, input, FlowLaw::bingham));
  if (input.law != FlowLaw::bingham && !input.mu && r.size() > 3)
    fits.push_back(least_squares(r, input, FlowLaw::herschel_bulkley));
  if (fits.empty())
    throw std::invalid_argument("Herschel-Bulkley needs at least four rows; " + std::to_string(r.size()) +
                                " found");
  const auto n = static_cast<double>(r.size());
  std::vector<double> aicc;
  for (const Fitted& f : fits)
    aicc.push_back(fits.size() > 1 && at_bound(f)
                       ? HUGE_VAL
                       : corrected_akaike(mean_square(f.fit), n, static_cast<int>(f.free.size())));
  // Bingham, the law of fewer parameters, unless Herschel-Bulkley is clearly better: within 4 the data support both
  // (Burnham and Anderson 2002), and the last digits of the torques would choose.
  constexpr double clearly = 4.0;
  const std::size_t best = fits.size() > 1 && aicc[1] < aicc[0] - clearly ? 1 : 0;
  for (std::size_t i = 0; i < fits.size(); ++i) {
    const bool finite = std::isfinite(aicc[i]);
    result.candidates.push_back({name_of(fits[i].law), static_cast<int>(fits[i].free.size()),
                                 scatter_of_rows(r, fits[i].fit), fits[i].fit.correlation,
                                 finite ? std::optional(aicc[i]) : std::nullopt,
                                 finite ? std::optional(aicc[i] - aicc[best]) : std::nullopt,
                                 misfit(r, fits[i].fit).empty(), i == best});
  }
  if (fits.size() > 1)
    result.choice = std::string("law ") + name_of(fits[best].law) +
                    (best == 1 ? ": its AICc is smaller by more than 4, on "
                               : ": Herschel-Bulkley's AICc is not smaller by more than 4, on ") +
                    std::to_string(r.size()) + " readings";
  return fits[best];
}

/// A sentence where Herschel-Bulkley describes the readings of a Bingham fit far better and gives another yield stress:
/// a difference of 10 in AICc leaves Bingham no support (Burnham and Anderson 2002). Empty otherwise.
std::string better_law(const Readings& r, const FitInput& input, const Fitted& bingham) {
  constexpr double no_support = 10.0, another = 0.1;
  constexpr std::size_t fewest = 6, most = 1000;
  if (input.law != FlowLaw::bingham || input.mu || input.tau_0 || r.size() < fewest || r.size() > most)
    return {};
  const Fitted hb = least_squares(r, input, FlowLaw::herschel_bulkley);
  const auto n = static_cast<double>(r.size());
  const auto aicc = [&](const Fitted& f) {
    return corrected_akaike(mean_square(f.fit), n, static_cast<int>(f.free.size()));
  };
  const double tau_0 = bingham.fluid.tau_0, other = hb.fluid.tau_0;
  if (at_bound(hb) || aicc(hb) > aicc(bingham) - no_support || std::abs(other - tau_0) < another * tau_0)
    return {};
  char text[240];
  std::snprintf(text, sizeof text,
                "yield_stress: hangs on the law: Herschel-Bulkley describes these readings far better "
                "(scatter %.2g %% for "
                "%.2g %%) and has %.3g Pa with n = %.2g; --law herschel_bulkley",
                100.0 * hb.fit.scatter, 100.0 * bingham.fit.scatter, other, hb.fluid.n);
  return text;
}

/// The torque falls as the speed rises, over the whole record and by more than scatter: no material of either law does.
bool torque_falls(const Readings& r) {
  const auto n = static_cast<double>(r.size());
  if (n < 4.0) return r.torque.back() < 0.97 * r.torque.front();
  double mx = 0.0, my = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < r.size(); ++i) mx += r.x[i] / n, my += r.torque[i] / n;
  for (std::size_t i = 0; i < r.size(); ++i) {
    const double x = r.x[i] - mx, y = r.torque[i] - my;
    xx += x * x, xy += x * y, yy += y * y;
  }
  const double slope = xy / xx, rest = std::max(0.0, yy - slope * xy) / (n - 2.0);
  return slope < -student_quantile(0.999, n - 2.0) * std::sqrt(rest / xx) &&
         slope * (r.x.back() - r.x.front()) < -0.03 * my;
}

void forget(const FitInput& input, FitResult& result) {
  if (!input.tau_0) result.tau_0.reset();
  if (!input.mu) result.mu.reset();
  result.consistency.reset();
  result.flow_index.reset();
  result.plug_below.reset();
  result.notes.push_back("yield_stress, plastic_viscosity: a model that does not fit does not tell them");
}

}  // namespace

FitResult fit_flow_curve(const TorqueRecord& record, const FitInput& input) {
  FitResult result;
  result.kind = RecordKind::flow_curve;
  Readings r = readings_of(record, result);
  if (input.mu && input.law == FlowLaw::herschel_bulkley)
    throw std::invalid_argument("Herschel-Bulkley has no plastic viscosity that could be given");
  if (input.tau_0 && input.mu)
    throw std::invalid_argument(
        "both the yield stress and the plastic viscosity are given; nothing is left to fit");
  if (r.size() < 2)
    throw std::invalid_argument(
        "a flow curve needs at least two rows with a speed and a torque greater than 0; " +
        std::to_string(r.size()) + " found");
  if (!several_speeds(r))
    throw std::invalid_argument("all rows have the same speed; a flow curve needs two speeds or more");

  const std::size_t slow = below_torque_minimum(r, input);
  std::vector<char> leave_out(r.size(), 0);
  for (std::size_t i = 0; i < slow; ++i) {
    drop(result, r.line[i], r.x[i], r.torque[i],
         "below the torque minimum: the torque rises as the speed falls");
    leave_out[i] = 1;
  }
  r = without(r, leave_out);
  const double slip = below_the_curve(r, input);
  const Fitted f = choose(r, input, result);
  result.model = name_of(f.law);
  report(r, f.fit, result);
  result.effective_readings = static_cast<double>(result.readings);
  report_parameters(r, f, input, result);
  report_plug(r, f, input, result);
  report_band(f, input, result);
  if (f.fluid.k <= 0.0)
    result.notes.push_back(
        "plastic_viscosity: the torque does not rise with the speed, so the record cannot tell it");
  if (at_bound(f))
    result.reasons.push_back(
        "the flow index lies at the end of its range, 0.2 to 2: the law does not describe the record");
  if (torque_falls(r))
    result.reasons.push_back(
        "the torque falls as the speed rises, which neither a Bingham nor a Herschel-Bulkley "
        "material does: structure still broke down, or a layer slips at the vane");
  if (const std::string why = misfit(r, f.fit); !why.empty()) result.reasons.push_back(why);
  if (const std::string better = better_law(r, input, f); !better.empty()) {
    result.law_in_doubt = true;
    result.notes.push_back(better);
  }
  if (!result.reasons.empty()) forget(input, result);
  if (slip > 0.0)
    result.reasons.push_back("wall slip is likely: the slowest third of the readings lies " +
                             std::to_string(std::lround(100.0 * slip)) +
                             " % below what the faster ones ask for; the yield stress may read low");
  return result;
}

}  // namespace tremie::fitting
