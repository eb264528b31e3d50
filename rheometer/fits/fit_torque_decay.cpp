#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "rheometer/fits/apparent_alpha.hpp"
#include "rheometer/fits/decay_least_squares.hpp"
#include "rheometer/fits/decay_stability.hpp"
#include "rheometer/fits/fit_common.hpp"
#include "rheometer/fits/flow_law.hpp"
#include "rheometer/fits/parameters.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/thixotropic_couette.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie::fitting {

namespace {

constexpr std::size_t most_readings = 2000;
constexpr std::size_t least_left = 6;  ///< behind a rise; more than a decay has unknowns
const std::string before_peak = "before the torque's peak";

// --- the record
// ---------------------------------------------------------------------------------------------------

std::vector<double> running_median(const std::vector<double>& v) {
  std::vector<double> result(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::size_t from = i < 2 ? 0 : i - 2, to = std::min(v.size(), i + 3);
    result[i] =
        median({v.begin() + static_cast<std::ptrdiff_t>(from), v.begin() + static_cast<std::ptrdiff_t>(to)});
  }
  return result;
}

/// Scatter of a reading [N m] from second differences, which a smooth decay hardly moves.
double scatter_of(const std::vector<double>& torque) {
  std::vector<double> second;
  for (std::size_t i = 2; i < torque.size(); ++i)
    second.push_back(torque[i] - 2.0 * torque[i - 1] + torque[i - 2]);
  return robust_deviation(second) / std::sqrt(6.0);
}

/// Single readings far from all their neighbours: a stone in the gap, a bit that was lost. The first reading, which may be
/// the peak, is none.
std::vector<char> spikes_of(const Readings& r) {
  std::vector<char> spike(r.size(), 0);
  if (r.size() < 8) return spike;
  const std::vector<double> smooth = running_median(r.torque);
  const double noise = scatter_of(r.torque);
  for (std::size_t i = 1; i < r.size(); ++i)
    spike[i] = std::abs(r.torque[i] - smooth[i]) > std::max(10.0 * noise, 0.4 * smooth[i]);
  return spike;
}

/// The highest of some rows, each smoothed over `half` neighbours to both sides.
std::size_t highest_of(const std::vector<double>& torque, std::size_t from, std::size_t to,
                       std::size_t half) {
  std::size_t best = from;
  double most = 0.0;
  for (std::size_t i = from; i < to; ++i) {
    const std::size_t low = i < half ? 0 : i - half, high = std::min(torque.size(), i + half + 1);
    double sum = 0.0;
    for (std::size_t j = low; j < high; ++j) sum += torque[j];
    const double mean = sum / static_cast<double>(high - low);
    if (mean > most) most = mean, best = i;
  }
  return best;
}

/// Number of leading rows in which the torque still rises: the vane starts, the material is strained elastically. A
/// record that begins within its noise of the peak has none. Behind a rise the peak is the highest of the first rows
/// within the noise, as those just before it are too low for a decay by less than the noise of one. A record that rises
/// to its end keeps the rows that a fit takes, which then says so.
std::size_t rising_rows(const Readings& r) {
  if (r.size() < 8) return 0;
  const std::vector<double> smooth = running_median(r.torque);
  const auto peak = std::max_element(smooth.begin(), smooth.end());
  const double low = *peak - 2.0 * scatter_of(r.torque);
  const auto limit = static_cast<std::size_t>(peak - smooth.begin());
  std::size_t n = 0;
  while (n < limit && r.torque[n] < low) ++n;
  if (n == 0) return 0;
  const std::size_t half = r.size() / 400, behind = std::max<std::size_t>(5, 2 * half);
  const std::size_t start = highest_of(r.torque, n, std::min(r.size(), n + behind), half);
  return std::min(start, r.size() - least_left);
}

/// A vane's start and an elastic strain are over within a turn. A torque that rises for longer tells of structure that builds
/// up, and what is fitted behind its peak is not what the record began with.
void judge_rise(const Readings& all, std::size_t rising, double omega, FitResult& result) {
  if (4 * rising <= all.size()) return;
  const double turns = std::abs(omega) * (all.x[rising] - all.x.front()) / (2.0 * std::numbers::pi);
  if (turns > 1.0)
    result.reasons.push_back(
        "the torque rises for " + text_of("%.2g", turns) +
        " turns of the vane before its peak: structure builds up there, and lambda is that of the peak, "
        "not of the record's start");
}

/// Rows with a torque from the start of the shear on; times counted from there.
Readings readings_of(const TorqueRecord& record, double omega, FitResult& result) {
  Readings all;
  for (std::size_t i = 0; i < record.torque.size(); ++i) {
    if (record.time[i] < 0.0)
      drop(result, record.line[i], record.time[i], record.torque[i], "before time 0");
    else if (record.torque[i] <= 0.0)
      drop(result, record.line[i], record.time[i], record.torque[i], "no torque");
    else
      all.push(record.time[i], record.torque[i], 1.0, record.line[i]);
  }
  all = dropping(all, spikes_of(all), "spike among its neighbours", result);
  const std::size_t rising = rising_rows(all);
  judge_rise(all, rising, omega, result);
  std::vector<char> leave_out(all.size(), 0);
  std::fill_n(leave_out.begin(), rising, 1);
  Readings kept = dropping(all, leave_out, before_peak, result);
  if (kept.size() < 2) return kept;
  const double step = (kept.x.back() - kept.x.front()) / static_cast<double>(kept.size() - 1);
  if (rising > 0 || kept.x.front() > 1.5 * step) {
    const double zero = kept.x.front();
    for (double& t : kept.x) t -= zero;
    result.notes.push_back("time: counted from " + std::to_string(zero) +
                           " s of the record, the first row that is used");
  } else {
    result.notes.push_back("time: the shear is taken to start at time 0 of the record");
  }
  return condense(kept, most_readings, result);
}

// --- the report
// ---------------------------------------------------------------------------------------------------

/// Error of a parameter by the model's grid and tolerance, relative: no interval is narrower than this.
constexpr double model_error = 5e-4;

/// Estimates of the parameters and of what follows from them, by the delta method.
struct Identified {
  const Layout& layout;
  const LeastSquaresFit& fit;
  DecayParameters p;
  std::vector<DecayParameters> by_curve;  ///< moves_by_curve()

  /// A gradient over the parameters as a variance; empty where it leans on a parameter that is not identifiable.
  std::optional<double> variance(const DecayParameters& gradient) const {
    const std::size_t n = layout.free.size();
    double sum = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double g = gradient[layout.free[i]];
      if (g != 0.0 && !fit.told[i]) return std::nullopt;
      for (std::size_t k = 0; k < n; ++k) sum += g * gradient[layout.free[k]] * fit.covariance[i * n + k];
    }
    for (const DecayParameters& move : by_curve) {
      double along = 0.0;
      for (std::size_t i = 0; i < move.size(); ++i) along += gradient[i] * move[i];
      sum += along * along;
    }
    return sum;
  }

  std::optional<ParameterEstimate> operator()(double value, const DecayParameters& gradient,
                                              double scale) const {
    const auto v = variance(gradient);
    const double own = model_error * value;
    return v ? estimate(value, *v + own * own, fit.degrees_of_freedom, scale) : std::nullopt;
  }
};

/// The parameters of the flow curve that is known, none of which the decay tells.
void report_known_law(const KnownLaw& known, FitResult& result) {
  const FlowLaw& law = flow_law(known.name);
  for (std::size_t k = 0; k < law.parameters.size(); ++k)
    set_value(result, law.parameters[k].row, given(known.parameters[k]));
  if (!law.in_place_of_viscosity.empty())
    result.notes.push_back("plastic_viscosity: " + law.in_place_of_viscosity);
}

void report_parameters(const Readings& r, const Identified& identified, const FitInput& in,
                       FitResult& result) {
  const auto& [tau_0, mu, lambda_0, breakdown, n] = identified.p;
  const double alpha = alpha_of(identified.p);
  const double stress =
      shear_stress_at(in.instrument.vane_radius, identified.fit.fitted.front(), in.instrument);
  const double rate = newtonian_shear_rate(*in.omega, in.instrument);
  if (in.curve) {
    report_known_law(*in.curve, result);
  } else {
    result.tau_0 = in.tau_0 ? given(tau_0) : identified(tau_0, {1, 0, 0, 0, 0}, tau_0);
    result.mu = in.mu ? given(mu) : identified(mu, {0, 1, 0, 0, 0}, mu);
  }
  result.lambda_0 = identified(lambda_0, {0, 0, 1, 0, 0}, std::max(lambda_0, 0.5));
  result.static_yield_stress = identified((1 + lambda_0) * tau_0, {1 + lambda_0, 0, tau_0, 0, 0}, stress);
  const bool power = decay_fit(in.kinetics).free_exponent;
  if (lambda_0 > 0.0 && breakdown > 0.0) {
    const DecayParameters gradient{0, 0, power ? (1.0 - n) * alpha / lambda_0 : 0.0, alpha / breakdown,
                                   power ? -std::log(lambda_0) * alpha : 0.0};
    result.alpha = identified(alpha, gradient, std::max(alpha, 1.0 / (rate * r.x.back())));
  }
  const bool by_time = decay_fit(in.kinetics).needs_speeds;
  if (by_time) std::swap(result.alpha, result.breakdown_rate);
  if (power) result.exponent = identified(n, {0, 0, 0, 0, 1}, n);
  if (in.rest)
    result.A_thix = identified(lambda_0 * tau_0 / *in.rest, {lambda_0 / *in.rest, 0, tau_0 / *in.rest, 0, 0},
                               std::max(lambda_0 * tau_0, 0.5 * tau_0) / *in.rest);
  const auto note = [&](const std::optional<ParameterEstimate>& e, const char* name, const char* why) {
    if (!e) result.notes.push_back(std::string(name) + ": not identifiable from this record" + why);
  };
  note(result.tau_0, "yield_stress", " at one speed together with the others; --yield-stress gives it");
  if (!in.curve)
    note(result.mu, "plastic_viscosity",
         " at one speed together with the others; --plastic-viscosity gives it");
  note(result.lambda_0, "flocculation_start", "");
  if (by_time)
    note(result.breakdown_rate, "breakdown_rate", "");
  else
    note(result.alpha, "alpha", "");
  if (by_time)
    result.notes.push_back(
        "rate_exponent: not identifiable from one speed; breakdown_rate is k gamma_dot^a at this one. tremie "
        "fit --protocol takes decays at two speeds");
  if (power) note(result.exponent, "exponent", "");
  if (in.rest)
    note(result.A_thix, "structuration_rate", "");
  else
    result.notes.push_back("structuration_rate: needs the rest before the test, --rest");
}

void report_flow(const Readings& r, const DecayParameters& p, const FitInput& in, FitResult& result) {
  CouetteFlow flow;
  flow.bingham = {p[i_tau_0], p[i_mu]};
  flow.omega = *in.omega;
  flow.flow_index = flow_index_of(in);
  flow.thixotropy = thixotropy_of(p, in);
  const CouetteDecay d =
      thixotropic_couette(flow, std::vector{0.0, 0.5 * r.x.back(), r.x.back()}, in.instrument);
  result.sheared_radius = *std::min_element(d.sheared_radius.begin(), d.sheared_radius.end());
  result.plug = *result.sheared_radius < in.instrument.container_radius * (1.0 - 1e-9);
}

/// The paper's reading. Its lambda = 0 is the torque of the dynamic material, where tau_0 and mu are known or
/// identifiable.
void report_apparent(const Readings& r, const FitInput& in, const Identified& identified, FitResult& result) {
  ApparentReading a;
  const double tau_0 = identified.p[i_tau_0], mu = identified.p[i_mu];
  const double n = flow_index_of(in);
  const bool dynamic = in.curve || (result.tau_0 && result.mu);
  a.offset_torque =
      dynamic ? steady_torque({tau_0, mu, n}, *in.omega, in.instrument).torque : mean_torque(r, 0.9, 1.0);
  a.offset = !dynamic   ? "median of the last tenth of the record"
             : n == 1.0 ? "Reiner-Riwlin torque of the dynamic yield stress and plastic viscosity"
                        : "steady torque by the law of the flow curve";
  a.newtonian_rate = newtonian_shear_rate(*in.omega, in.instrument);
  if (dynamic && result.lambda_0) {
    const double excess =
        (shear_stress_at(in.instrument.vane_radius, identified.fit.fitted.front(), in.instrument) -
         static_yield_stress(identified.p[i_lambda], tau_0)) /
        mu;
    a.rate_at_vane = n == 1.0 ? excess : std::pow(std::max(0.0, excess), 1.0 / n);
    if (!(*a.rate_at_vane > 0.0) && n != 1.0) a.rate_at_vane.reset();
  }
  for (const double torque : result.curve.observed)
    result.lambda_apparent.push_back(apparent_lambda(torque, a.offset_torque, tau_0, in.instrument));
  const double end = r.x.back();
  for (const double window : {2.0, 5.0, 10.0, 20.0, std::numeric_limits<double>::infinity()}) {
    if (std::isfinite(window) && window >= end) continue;
    const double used = std::min(window, end);
    const auto c = exponential_coefficient(result.curve.x, result.lambda_apparent, used);
    if (!c) continue;
    a.windows.push_back({used, *c, *c / a.newtonian_rate,
                         a.rate_at_vane ? std::optional(*c / *a.rate_at_vane) : std::nullopt});
  }
  if (!a.windows.empty()) result.apparent = a;
}

std::string name_of(const Kinetics& k) { return std::string(word(k)); }

/// Root mean square over the readings that at least one of the models keeps: all are judged on the same readings.
double common_mean_square(const std::vector<DecayFit>& fits, const LeastSquaresFit& judged, double& n) {
  double sum = 0.0;
  n = 0.0;
  for (std::size_t i = 0; i < judged.residual.size(); ++i) {
    if (std::all_of(fits.begin(), fits.end(), [&](const DecayFit& f) { return f.fit.outlier[i] != 0; }))
      continue;
    sum += judged.residual[i] * judged.residual[i];
    n += 1.0;
  }
  return sum / std::max(1.0, n);
}

/// Compares the models by AICc on the number of independent readings, which the noise about the closest one tells.
std::size_t choose(const Readings& r, const std::vector<DecayFit>& fits, FitResult& result) {
  double n = 0.0, closest = std::numeric_limits<double>::infinity(), correlation = 0.0;
  for (const DecayFit& f : fits) {
    const double square = common_mean_square(fits, f.fit, n);
    if (square < closest) {
      const auto [x, residual] = kept_residuals(r, f.fit);
      correlation = lack_of_fit(x, residual).correlation;
    }
    closest = std::min(closest, square);
  }
  const double independent = effective_number(n, correlation);
  std::vector<double> aicc;
  for (const DecayFit& f : fits)
    aicc.push_back(corrected_akaike(common_mean_square(fits, f.fit, n), independent,
                                    static_cast<int>(f.layout.free.size())));
  const auto best = static_cast<std::size_t>(std::min_element(aicc.begin(), aicc.end()) - aicc.begin());
  for (std::size_t i = 0; i < fits.size(); ++i)
    add_candidate(name_of(fits[i].kinetics), r, fits[i].fit, aicc[i], aicc[best], i == best, result);
  result.choice = "kinetics " + name_of(fits[best].kinetics) + ": the smallest AICc of " +
                  std::to_string(fits.size()) + " kinetics, on " + std::to_string(std::lround(independent)) +
                  " independent readings of " + std::to_string(std::lround(n)) +
                  " (the correlation of the noise taken off)";
  if (!std::isfinite(aicc[best])) {
    result.choice = "kinetics " + name_of(fits[best].kinetics) + ", as nothing else was asked for; " +
                    std::to_string(std::lround(independent)) + " independent readings of " +
                    std::to_string(std::lround(n)) + " are too few to choose by AICc";
    return best;
  }
  double second = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < fits.size(); ++i)
    if (i != best) second = std::min(second, aicc[i] - aicc[best]);
  if (fits.size() > 1 && second < 2.0)
    result.choice += "; the next is within 2 of it, so the record hardly tells them apart";
  return best;
}

/// Kinetics that contain others at n = 1, as power contains Roussel's: a fit of them that ended above those starts again
/// from there.
void start_from_contained(const Readings& r, FitInput in, std::vector<DecayFit>& fits) {
  for (DecayFit& fit : fits) {
    const auto contained = std::find_if(fits.begin(), fits.end(), [&](const DecayFit& f) {
      return word(f.kinetics) == decay_fit(fit.kinetics).contains;
    });
    double n = 0.0;
    if (contained == fits.end() ||
        common_mean_square(fits, fit.fit, n) <= common_mean_square(fits, contained->fit, n))
      continue;
    DecayFit again = fit;
    again.layout.all = contained->parameters();
    again.layout.all[i_exponent] = 1.0;
    for (std::size_t k = 0; k < again.layout.free.size(); ++k)
      again.fit.parameters[k] = again.layout.all[again.layout.free[k]];
    in.kinetics = fit.kinetics;
    again = refined(r, in, again, intervals_of(in));
    if (common_mean_square(fits, again.fit, n) < common_mean_square(fits, fit.fit, n)) fit = again;
  }
}

/// Fits of the kinetics that are asked for, in order of their complexity; one that has no solution is left out.
std::vector<DecayFit> fit_candidates(const Readings& r, FitInput in) {
  if (!in.choose_kinetics) return {fit_decay(r, in)};
  std::vector<DecayFit> fits;
  std::string failure;
  const auto fit_all = [&](bool of_several_speeds) {
    for_each_kinetics([&](const auto& k) {
      in.kinetics = k;
      if (k.decay_fit.needs_speeds != of_several_speeds) return;
      // without a rest nothing is known to build up, and Roussel's equation is the gated one
      if (k.decay_fit.needs_rest && !in.rest) return;
      if (r.size() <= 2u + !in.tau_0 + !in.mu + k.decay_fit.free_exponent) return;
      try {
        fits.push_back(fit_decay(r, in));
      } catch (const std::runtime_error& error) {
        failure = error.what();
      }
    });
  };
  fit_all(false);
  start_from_contained(r, in, fits);
  // One speed tells the rate of the others alone: they are asked where breakdown by strain has another shape.
  if (std::none_of(fits.begin(), fits.end(),
                   [&](const DecayFit& f) { return misfit_of(r, f.fit, "").empty(); }))
    fit_all(true);
  if (fits.empty()) throw std::runtime_error(failure);
  return fits;
}

/// A torque that is level or rises shows no breakdown, whatever curve can be laid through it; with neither yield stress nor
/// viscosity known it then splits into anything.
void judge_fall(const Readings& r, std::size_t rows, const FitInput& in, FitResult& result) {
  const double first = mean_torque(r, 0.0, 0.05), last = mean_torque(r, 0.9, 1.0);
  const double noise = scatter_of(r.torque) / std::sqrt(std::max(1.0, 0.05 * static_cast<double>(r.size())));
  if (2 * static_cast<std::size_t>(dropped_for(result, before_peak)) > rows)
    result.reasons.push_back("the torque rises over most of the record: no decay");
  else if (last > 1.03 * first && last > first + 4.0 * noise)
    result.reasons.push_back(
        "the torque rises at the end of the record, which no breakdown at a constant speed does");
  else if (!(in.tau_0 && in.mu) && last > 0.97 * first && last >= first - 4.0 * noise)
    result.reasons.push_back(
        "the torque is level: nothing breaks down, and one torque determines neither yield stress nor "
        "viscosity nor flocculation");
}

/// No parameter is identifiable by a model that does not describe the record.
void withdraw(FitResult& result) {
  const auto forget = [&](std::optional<ParameterEstimate>& e, const std::string& name) {
    if (!e || e->given) return;
    e.reset();
    result.notes.push_back(name + ": not identifiable from a model that does not fit");
  };
  for (const FitParameter& p : parameters_of(result))
    if (p.member) forget(result.*p.member, p.name);
  forget(result.exponent, "exponent");
}

}  // namespace

FitResult fit_torque_decay(const TorqueRecord& record, const FitInput& input, Stability stability) {
  FitInput in = input;
  if (in.curve) in.tau_0 = in.curve->parameters.front(), in.mu = viscous_stress(*in.curve).k;
  if (!in.omega)
    throw std::invalid_argument("a torque decay needs the speed of the vane: --speed \"0.25 rev/s\"");
  FitResult result;
  result.kind = RecordKind::torque_decay;
  const Readings r = readings_of(record, *in.omega, result);
  const std::size_t unknowns =
      2u + !in.tau_0 + !in.mu + (!in.choose_kinetics && decay_fit(in.kinetics).free_exponent);
  if (r.size() <= unknowns)
    throw std::invalid_argument("a torque decay needs more than " + std::to_string(unknowns) + " rows for " +
                                std::to_string(unknowns) + " unknowns; " + std::to_string(r.size()) +
                                " found" + (result.dropped_count > 0 ? " behind the torque's peak" : ""));
  if (!(r.x.back() > 0.0)) throw std::invalid_argument("all rows have the same time");

  // so many rows tell more than the usual grid's error of 1e-4 of the torque
  const bool fine = record.torque.size() > 20000;
  const std::vector<DecayFit> fits = fit_candidates(r, in);
  DecayFit best = fits[choose(r, fits, result)];
  in.kinetics = best.kinetics;
  if (fine) best = refined(r, in, std::move(best), 2 * intervals_of(in));
  result.model = name_of(best.kinetics);
  judge_fall(r, record.torque.size(), in, result);
  const Identified identified{best.layout, best.fit, best.parameters(), moves_by_curve(r, in, best)};
  report(r, best.fit, result);
  result.effective_readings = best.fit.independent;
  if (const std::string why =
          misfit_of(r, best.fit, "the decay has another shape than these kinetics give it");
      !why.empty())
    result.reasons.push_back(why);
  report_parameters(r, identified, in, result);
  report_flow(r, identified.p, in, result);
  report_apparent(r, in, identified, result);
  if (!result.reasons.empty())
    withdraw(result);
  else if (stability == Stability::judged && !in.tau_0 && !in.mu)
    judge_stability(record, input, result);
  return result;
}

}  // namespace tremie::fitting
