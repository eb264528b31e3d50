#include "rheometer/protocol/breakdown.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "rheometer/protocol/joint_fall_fit.hpp"
#include "rheometer/reference/instrument.hpp"
#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/random_effects.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

constexpr double least_ratio_of_speeds = 2.0;
constexpr int most_modes = 4;

/// What all fits of a record share.
struct Falls {
  FallRows rows;
  std::vector<double> scatter;  ///< of each fall, by a first fit: weights of all others
  std::vector<char> left_out;   ///< outliers of the chosen fit
  double independent = 0.0;     ///< readings, the correlation of their noise taken off

  double aicc(const FallFit& fit) const {
    return corrected_akaike(mean_square(rows, fit, scatter, left_out), independent,
                            static_cast<int>(fit.fit.parameters.size()));
  }
};

/// Fits by one set of parameters with one mode more each, as far as the rows tell them.
std::vector<FallFit> fits_by_modes(const FallRows& rows, RateOfFalls rate, const std::vector<double>& scatter,
                                   int most) {
  std::vector<FallFit> fits;
  for (int modes = 1; modes <= most; ++modes) {
    auto fit = fit_falls(rows, {rate, modes}, scatter, fits.empty() ? nullptr : &fits.back());
    if (!fit || !tells_shape(*fit)) break;
    fits.push_back(std::move(*fit));
  }
  return fits;
}

/// Correlation of the noise of successive readings, without what a smooth curve explains; mean over the falls.
double noise_correlation(const FallRows& rows, const FallFit& fit) {
  double sum = 0.0;
  for (std::size_t s = 0; s < rows.falls.size(); ++s) {
    std::vector<double> time, residual;
    for (std::size_t i = rows.begin[s]; i < rows.begin[s + 1]; ++i) {
      if (fit.fit.outlier[i]) continue;
      time.push_back(rows.falls[s].time[i - rows.begin[s]]);
      residual.push_back(fit.fit.residual[i]);
    }
    sum += lack_of_fit(time, residual).correlation / static_cast<double>(rows.falls.size());
  }
  return sum;
}

/// The number of modes with the smallest AICc, by one set of parameters.
std::optional<FallFit> best_shape(Falls& falls, RateOfFalls rate) {
  const std::vector<FallFit> rough = fits_by_modes(falls.rows, rate, {}, 2);
  if (rough.empty()) return std::nullopt;
  falls.scatter = rough.back().scatter;
  const std::vector<FallFit> fits = fits_by_modes(falls.rows, rate, falls.scatter, most_modes);
  if (fits.empty()) return std::nullopt;
  falls.left_out = fits.back().fit.outlier;
  const auto readings =
      static_cast<double>(std::count(falls.left_out.begin(), falls.left_out.end(), static_cast<char>(0)));
  falls.independent = effective_number(readings, noise_correlation(falls.rows, fits.back()));
  const auto best = std::min_element(fits.begin(), fits.end(), [&](const FallFit& x, const FallFit& y) {
    return falls.aicc(x) < falls.aicc(y);
  });
  return std::isfinite(falls.aicc(*best)) ? *best
                                          : fits.back();  // smooth misfits leave nothing to penalise by
}

/// The mode with the largest share: it has the factor 1.
std::size_t main_mode(const std::vector<BreakdownMode>& modes) {
  const auto largest = std::max_element(modes.begin(), modes.end(),
                                        [](const auto& x, const auto& y) { return x.share < y.share; });
  return static_cast<std::size_t>(largest - modes.begin());
}

/// ln of the rates at which the main mode of each fall breaks down, with their covariance row by row.
struct LogRates {
  std::vector<double> value, covariance;
};

LogRates log_rates_of(const FallFit& f) {
  const std::size_t all = f.fit.parameters.size(), main = main_mode(modes_of(f));
  const std::size_t at = f.first_of_shape + main - 1;  // of its factor, where it is not the first
  const auto covariance = [&](std::size_t i, std::size_t j) { return f.fit.covariance[i * all + j]; };
  LogRates rates;
  for (std::size_t i = f.first_of_rate; i < f.first_of_shape; ++i) {
    rates.value.push_back(f.fit.parameters[i] + (main > 0 ? f.fit.parameters[at] : 0.0));
    for (std::size_t j = f.first_of_rate; j < f.first_of_shape; ++j)
      rates.covariance.push_back(
          covariance(i, j) + (main > 0 ? covariance(i, at) + covariance(at, j) + covariance(at, at) : 0.0));
  }
  return rates;
}

std::vector<BreakdownMode> relative_to_main(std::vector<BreakdownMode> modes) {
  const double factor = modes[main_mode(modes)].factor;
  for (BreakdownMode& mode : modes) mode.factor /= factor;
  std::sort(modes.begin(), modes.end(), [](const auto& x, const auto& y) { return x.share > y.share; });
  return modes;
}

bool has_two_speeds(const std::vector<double>& shear_rate) {
  const auto [slowest, fastest] = std::minmax_element(shear_rate.begin(), shear_rate.end());
  return !shear_rate.empty() && *fastest >= least_ratio_of_speeds * *slowest;
}

void report_law(const Falls& falls, const FallFit& fit, const LogRates& rates, Breakdown& b) {
  std::vector<double> x;
  for (const double rate : falls.rows.shear_rate) x.push_back(std::log(rate));
  const LineOfEstimates line =
      line_of_estimates(x, rates.value, rates.covariance, fit.fit.degrees_of_freedom);
  const auto power = [&](double half) { return std::exp(line.intercept + half); };
  b.exponent = ParameterEstimate{line.slope, std::nullopt, false};
  b.rate = ParameterEstimate{power(0.0), std::nullopt, false};
  if (std::isfinite(line.half_of_slope) && std::isfinite(line.half_of_intercept)) {
    b.exponent->ci95 = Interval{line.slope - line.half_of_slope, line.slope + line.half_of_slope};
    b.rate->ci95 = Interval{power(-line.half_of_intercept), power(line.half_of_intercept)};
  }
  if (line.between > 0.0)
    b.notes.push_back(
        text_of("rate_exponent: the falls' own rates scatter about k gamma_dot^a by %.0f %%, which the "
                "intervals contain",
                100.0 * line.between));
  b.notes.push_back(
      "rate_exponent: by the shear rate of a Newtonian fluid at the vane; where a slow vane shears a thinner "
      "layer, "
      "the rates differ by less and a is larger by that share");
}

/// The torque of a fall by the law from its onset on, as it was before.
std::optional<double> half_time_by_law(const Falls& falls, const FallFit& fit, std::size_t s,
                                       const Fall& whole, double rate) {
  Fall by_law = whole;
  const std::size_t onset = onset_of(whole);
  for (std::size_t i = onset; i < whole.time.size(); ++i)
    by_law.torque[i] = fitted_torque(falls.rows, fit, s, whole.time[i] - whole.time[onset], rate);
  return excess_half_time(by_law);
}

void report_falls(const std::vector<Fall>& whole, const Falls& falls, const FallFit& fit,
                  const LogRates& rates, Breakdown& b) {
  const std::vector<BreakdownMode> modes = modes_of(fit);
  const double to_fit = 1.0 / modes[main_mode(modes)].factor;
  for (std::size_t s = 0; s < falls.rows.falls.size(); ++s) {
    const auto same = [&](const auto& t) { return t.section == falls.rows.falls[s].section; };
    BreakdownTime& time = *std::find_if(b.times.begin(), b.times.end(), same);
    time.breakdown_rate = std::exp(rates.value[s]);
    time.scatter = fit.scatter[s];
    if (b.rate)
      time.half_time_by_law =
          half_time_by_law(falls, fit, s, *std::find_if(whole.begin(), whole.end(), same),
                           to_fit * b.rate->value * std::pow(time.rate, b.exponent->value));
  }
}

/// One set of parameters for all falls, modes added one by one; empty where the falls do not tell it.
std::optional<FallFit> fit_of_law(const Falls& falls, FallModel model) {
  const int modes = model.modes;
  std::optional<FallFit> fit;
  for (model.modes = 1; model.modes <= modes; ++model.modes) {
    auto next = fit_falls(falls.rows, model, falls.scatter, fit ? &*fit : nullptr);
    if (!next) return std::nullopt;
    fit = std::move(next);
  }
  return fit;
}

/// Roussel's law, its power and rate_power with one mode and with those of `shape`.
void compare_kinetics(const Falls& falls, const FallFit& shape, Breakdown& b) {
  std::vector<std::pair<std::string, FallModel>> laws{{"roussel", {RateOfFalls::strain}},
                                                      {"power", {RateOfFalls::strain, 1, true}},
                                                      {"rate_power", {RateOfFalls::power}}};
  if (shape.model.modes > 1) laws.push_back({"rate_power, modes", {RateOfFalls::power, shape.model.modes}});
  for (const auto& law : laws) {
    const auto fit = fit_of_law(falls, law.second);
    if (!fit) continue;
    Candidate c;
    c.name = law.first;
    c.parameters = static_cast<int>(fit->fit.parameters.size());
    c.scatter = std::sqrt(mean_square(falls.rows, *fit, {}, falls.left_out));
    c.correlation = fit->fit.correlation;
    if (const double aicc = falls.aicc(*fit); std::isfinite(aicc)) c.aicc = aicc;
    b.candidates.push_back(std::move(c));
  }
  double least = std::numeric_limits<double>::infinity();
  for (const Candidate& c : b.candidates) least = std::min(least, c.aicc.value_or(least));
  for (Candidate& c : b.candidates) {
    if (!c.aicc) continue;
    c.difference = *c.aicc - least;
    c.chosen = *c.aicc == least && b.choice.empty();
    if (c.chosen)
      b.choice = text_of("%s: the smallest AICc of %zu laws, each by one set of parameters over all falls",
                         c.name.c_str(), b.candidates.size());
  }
}

}  // namespace

Breakdown breakdown_of(const std::vector<Fall>& all, const Instrument& instrument, bool compare) {
  Breakdown b;
  std::vector<Fall> whole;
  std::vector<double> shear_rate;
  for (const Fall& f : all) {
    const auto half = excess_half_time(f);
    if (!half || !(f.omega > 0.0)) continue;
    whole.push_back(f);
    shear_rate.push_back(newtonian_shear_rate(plastic_speed(f), instrument));
    b.times.push_back({f.section, f.omega, shear_rate.back(), *half, f.time[onset_of(f)], {}, {}, {}});
  }
  if (std::any_of(whole.begin(), whole.end(), [](const Fall& f) { return f.compliance > 0.0; }))
    b.notes.push_back(
        "breakdown_rate: by plastic shear rates: the vane's speed in a start-up plus the elastic rotation "
        "released as the torque falls");
  Falls falls{rows_of(whole, shear_rate), {}, {}, 0.0};
  const bool two_speeds = has_two_speeds(falls.rows.shear_rate);
  if (!two_speeds)
    b.notes.push_back(
        "rate_exponent: not identifiable from one speed; it needs decays at two speeds, one at least twice "
        "the other");
  if (falls.rows.falls.empty()) return b;
  // one set of parameters first, so that a mode is the same for all falls; then each fall's own rate near it
  const auto law = best_shape(falls, two_speeds ? RateOfFalls::power : RateOfFalls::strain);
  auto fit = law;
  if (law) fit = fit_falls(falls.rows, {RateOfFalls::of_each, law->model.modes}, falls.scatter, &*law);
  if (!fit) {
    b.notes.push_back("breakdown_rate: the falls tell no rate of breakdown");
    return b;
  }
  const LogRates rates = log_rates_of(*fit);
  if (fit->model.modes > 1) b.modes = relative_to_main(modes_of(*fit));
  if (two_speeds) report_law(falls, *fit, rates, b);
  report_falls(whole, falls, *fit, rates, b);
  if (two_speeds && compare) compare_kinetics(falls, *fit, b);
  return b;
}

}  // namespace tremie
