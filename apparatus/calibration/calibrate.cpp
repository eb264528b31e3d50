#include "apparatus/calibration/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "apparatus/calibration/chains.hpp"
#include "apparatus/study/design.hpp"

namespace tremie::calibration {
namespace {

constexpr double enough = 1.0 / 3.0;  ///< of the measurement's error: what the emulator's may be
constexpr double margin = 0.8;   ///< of that: the error of the cells, which comes last, widens the posterior
constexpr double far_off = 3.0;  ///< standard errors at which a measurement contradicts the others
constexpr double most_r_hat = 1.05, fewest_draws = 200.0;
constexpr double contradiction = 0.01;  ///< chance of a chi square so large that calls for a reason

/// A reading's emulator, and its predictions at the posterior's points.
struct Emulated {
  std::size_t test = 0, reading = 0;
  bool trained = false;
  Emulator emulator;
  std::vector<Prediction> predictions;
  std::vector<std::size_t> trials;  ///< those with a number
  double error = 0.0;               ///< error_near_posterior of the last weighted posterior
};

struct State {
  const Lab& lab;
  const Settings& settings;
  std::vector<Point> points;  ///< of the posterior
  std::vector<Emulated> emulated;
  std::vector<std::vector<double>> discretisation;
  Calibration result;
};

const Measurement& reading_of(const State& s, const Emulated& e) {
  return s.lab.tests[e.test].readings[e.reading];
}

bool is_measured(const State& s, const Emulated& e) { return e.test < s.lab.measured; }

void train_one(State& s, Emulated& e) {
  std::vector<Point> points;
  std::vector<double> values;
  e.trials.clear();
  for (std::size_t i = 0; i < s.result.trials.size(); ++i) {
    const auto value = study::trusted_number(s.result.trials[i].rows[e.test], e.reading);
    if (!value || !std::isfinite(*value)) continue;
    points.push_back(s.result.trials[i].point);
    values.push_back(*value);
    e.trials.push_back(i);
  }
  e.trained = points.size() >= 5 * s.lab.unknowns.size();
  if (!e.trained) return;
  e.emulator = train(points, values, reading_of(s, e).logarithmic);
  e.predictions = predict(e.emulator, s.points);
}

/// The variance of what a measurement may differ by from an emulated run.
double variance_of(const State& s, const Emulated& e, const Prediction& p) {
  const double error = reading_of(s, e).error, cells = s.discretisation[e.test][e.reading];
  return error * error + p.variance + cells * cells;
}

double log_likelihood_of(const State& s, const Emulated& e, const Prediction& p) {
  const Measurement& m = reading_of(s, e);
  return log_likelihood(m.value, m.error, p, s.discretisation[e.test][e.reading]);
}

/// At every point of s.points, of all measurements but one.
std::vector<double> log_likelihoods(const State& s, const Emulated* left_out = nullptr) {
  std::vector<double> sums(s.points.size(), 0.0);
  for (const Emulated& e : s.emulated) {
    if (!is_measured(s, e) || !e.trained || &e == left_out) continue;
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += log_likelihood_of(s, e, e.predictions[i]);
  }
  return sums;
}

void update_posterior(State& s) { s.result.posterior = make_posterior(s.points, log_likelihoods(s)); }

/// Draws of Markov chains in place of weighted points, which are few where the posterior is narrow in many directions.
void draw_chains(State& s) {
  const Chains chains = sample(s.result.posterior, [&](const Point& x) {
    double sum = 0.0;
    for (const Emulated& e : s.emulated)
      if (is_measured(s, e) && e.trained) sum += log_likelihood_of(s, e, predict(e.emulator, {x}).front());
    return sum;
  });
  s.points = chains.points;
  for (Emulated& e : s.emulated)
    if (e.trained) e.predictions = predict(e.emulator, s.points);
  update_posterior(s);  // for its best point
  s.result.posterior.weights.assign(s.points.size(), 1.0 / static_cast<double>(s.points.size()));
  s.result.r_hat = chains.r_hat;
  s.result.effective_points = chains.effective;
}

/// The quadrature of one or two unknowns anew, over the box alone in which the posterior lies: sharp readings leave a few of the
/// points that span the ranges.
void refine_points(State& s) {
  constexpr double negligible = 1e-9;
  const std::size_t n = s.lab.unknowns.size();
  const Posterior& p = s.result.posterior;
  Point low(n, 1.0), high(n, 0.0);
  for (std::size_t i = 0; i < p.points.size(); ++i)
    for (std::size_t k = 0; k < n && p.weights[i] > negligible * p.weights[p.best]; ++k) {
      low[k] = std::min(low[k], p.points[i][k]);
      high[k] = std::max(high[k], p.points[i][k]);
    }
  const double spacing = 1.0 / std::pow(static_cast<double>(s.points.size()), 1.0 / static_cast<double>(n));
  for (std::size_t k = 0; k < n; ++k) {
    low[k] = std::max(0.0, low[k] - spacing);
    high[k] = std::min(1.0, high[k] + spacing);
  }
  for (Point& x : s.points)
    for (std::size_t k = 0; k < n; ++k) x[k] = low[k] + (high[k] - low[k]) * x[k];
  for (Emulated& e : s.emulated)
    if (e.trained) e.predictions = predict(e.emulator, s.points);
  update_posterior(s);
}

double distance(const Point& a, const Point& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// How much a run's residual counts: as much as the likeliest of the points about it, within a twentieth of the range. Where
/// t500 grows without bound, a fifth of the range away, one left-out run would outweigh all that lie in the posterior.
constexpr double about = 0.05;
double nearness(const Posterior& posterior, const Point& run) {
  const double most = posterior.weights[posterior.best];
  double largest = 0.0;
  for (std::size_t i = 0; i < posterior.points.size(); ++i) {
    if (posterior.weights[i] < 1e-6 * most) continue;
    const double d = distance(posterior.points[i], run) / about;
    largest = std::max(largest, posterior.weights[i] / most * std::exp(-0.5 * d * d));
  }
  return largest;
}

/// Root mean square of the left-out residuals, each by how near to the posterior its run lies. A run at the rim of
/// the design, where leaving it out means to extrapolate, says little of the emulator where it is used.
double error_near_posterior(const State& s, const Emulated& e) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t k = 0; k < e.trials.size(); ++k) {
    const double weight = nearness(s.result.posterior, s.result.trials[e.trials[k]].point);
    sum += weight * e.emulator.left_out[k] * e.emulator.left_out[k];
    weights += weight;
  }
  return weights > 0.0 ? std::sqrt(sum / weights) : INFINITY;
}

bool emulators_suffice(const State& s) {
  return std::all_of(s.emulated.begin(), s.emulated.end(), [&](const Emulated& e) {
    return !is_measured(s, e) || !e.trained ||
           error_near_posterior(s, e) < margin * enough * reading_of(s, e).error;
  });
}

/// Whether a point lies `gap` from every run, and twice that from those chosen beside it.
bool apart(const State& s, const std::vector<Point>& chosen, const Point& p, double gap) {
  const auto far = [&](const Point& q, double least) { return distance(p, q) >= least; };
  return std::all_of(chosen.begin(), chosen.end(), [&](const Point& q) { return far(q, 2.0 * gap); }) &&
         std::all_of(s.result.trials.begin(), s.result.trials.end(),
                     [&](const Trial& trial) { return far(trial.point, gap); });
}

/// A measured reading that too few runs have to be emulated, though some have it.
const Emulated* scarce_reading(const State& s) {
  const auto e = std::find_if(s.emulated.begin(), s.emulated.end(), [&](const Emulated& one) {
    return is_measured(s, one) && !one.trained && !one.trials.empty();
  });
  return e == s.emulated.end() ? nullptr : &*e;
}

/// The points of the quadrature nearest to the runs that have a scarce reading.
std::vector<Point> points_beside(const State& s, const Emulated& e, std::size_t count) {
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    double nearest = INFINITY;
    for (const std::size_t k : e.trials)
      nearest = std::min(nearest, distance(s.result.trials[k].point, s.points[i]));
    near.emplace_back(nearest, i);
  }
  std::sort(near.begin(), near.end());
  std::vector<Point> chosen;
  for (const auto& [distance_to_run, i] : near)
    if (chosen.size() < count && apart(s, chosen, s.points[i], about)) chosen.push_back(s.points[i]);
  return chosen;
}

/// Where the emulators are least sure, among points that the measurements leave likely; beside the runs that have it, where
/// a measured reading is scarce.
std::vector<Point> next_points(const State& s, std::size_t count) {
  if (const Emulated* scarce = scarce_reading(s)) return points_beside(s, *scarce, count);
  const auto& posterior = s.result.posterior;
  std::vector<std::pair<double, std::size_t>> scored;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    double unsure = 1e-6;
    for (const Emulated& e : s.emulated)
      if (is_measured(s, e) && e.trained)
        unsure += e.predictions[i].variance / (reading_of(s, e).error * reading_of(s, e).error);
    scored.emplace_back(std::sqrt(posterior.weights[i]) * unsure, i);
  }
  std::sort(scored.rbegin(), scored.rend());
  std::vector<Point> chosen;
  for (double gap = 0.04; chosen.size() < count && gap > 1e-4; gap *= 0.5)
    for (const auto& [score, i] : scored) {
      if (chosen.size() == count) break;
      if (posterior.weights[i] > 1e-4 * posterior.weights[posterior.best] &&
          apart(s, chosen, s.points[i], gap))
        chosen.push_back(s.points[i]);
    }
  return chosen;
}

void learn(State& s) {
  for (Emulated& e : s.emulated) train_one(s, e);
  update_posterior(s);
}

bool run_more(State& s, const std::vector<Point>& points) {
  if (!run_trials(s.lab, points, s.settings, s.result.trials)) {
    s.result.interrupted = true;
    return false;
  }
  learn(s);
  if (s.settings.say)
    s.settings.say(fmt::format("{} runs of each of {} tests", s.result.trials.size(), s.lab.tests.size()));
  return true;
}

// --- what is reported -----------------------------------------------------------------------------------

void report_parameters(State& s) {
  for (std::size_t i = 0; i < s.lab.unknowns.size(); ++i) {
    const auto& unknown = s.lab.unknowns[i];
    const double low = quantile(s.result.posterior, i, 0.025), high = quantile(s.result.posterior, i, 0.975);
    const auto at = [&](double share) { return study::level_at(unknown, share).number; };
    s.result.parameters.push_back({unknown.key, study::unit_of(unknown),
                                   at(quantile(s.result.posterior, i, 0.5)), at(low), at(high),
                                   told(low, high)});
  }
}

std::vector<std::array<double, 2>> left_out_of(const State& s, const Emulated& e) {
  std::vector<std::array<double, 2>> pairs;
  for (std::size_t k = 0; k < e.trials.size(); ++k) {
    const double run = *study::trusted_number(s.result.trials[e.trials[k]].rows[e.test], e.reading);
    pairs.push_back({run, run + e.emulator.left_out[k]});
  }
  return pairs;
}

void report_readings(State& s) {
  for (const Emulated& e : s.emulated) {
    const Measurement& m = reading_of(s, e);
    if (!is_measured(s, e)) continue;
    const std::string label = s.lab.tests[e.test].label;
    if (!e.trained) {
      s.result.reasons.push_back(
          fmt::format("{}.{} is left out: only {} of {} runs within the ranges have one", label, m.key,
                      e.trials.size(), s.result.trials.size()));
      continue;
    }
    const Prediction& best = e.predictions[s.result.posterior.best];
    const double deviation = (m.value - best.mean) / std::sqrt(variance_of(s, e, best));
    s.result.chi_square += deviation * deviation;
    s.result.readings.push_back({label, s.lab.tests[e.test].words, m.result, m.value, m.error, e.error,
                                 s.discretisation[e.test][e.reading], best.mean, deviation,
                                 left_out_of(s, e)});
  }
}

/// Each reading as the others forecast it, its own error included.
void find_contradictions(State& s) {
  for (const Emulated& e : s.emulated) {
    if (!is_measured(s, e) || !e.trained) continue;
    const Measurement& m = reading_of(s, e);
    const Posterior others = make_posterior(s.points, log_likelihoods(s, &e));
    auto predictions = e.predictions;
    const double cells = s.discretisation[e.test][e.reading];
    for (Prediction& p : predictions) p.variance += cells * cells + m.error * m.error;
    const auto at = [&](double q) { return mixture_quantile(others, predictions, q); };
    const Contradiction c{s.lab.tests[e.test].label + "." + m.key,
                          s.lab.tests[e.test].words,
                          m.result,
                          m.value,
                          at(0.5),
                          at(0.005),
                          at(0.995)};
    if (m.value < c.low || m.value > c.high) s.result.contradictions.push_back(c);
  }
}

/// The chance of a chi square of n degrees of freedom above x.
double chance_above(double x, double n) { return cdf(complement(boost::math::chi_squared(n), x)); }

void report_contradictions(State& s) {
  const ReadingReport* worst = nullptr;
  for (const ReadingReport& r : s.result.readings) {
    if (!worst || std::abs(r.deviation) > std::abs(worst->deviation)) worst = &r;
    if (std::abs(r.deviation) > far_off)
      s.result.reasons.push_back(fmt::format(
          "{} ({}) {} = {:.4g} lies {:.1f} standard errors from the best fit, {:.4g}: it contradicts "
          "the other measurements or lies outside of what the model can do within the ranges",
          r.test, r.words, r.result, r.measured, std::abs(r.deviation), r.best_fit));
  }
  for (const Contradiction& c : s.result.contradictions)
    s.result.reasons.push_back(fmt::format(
        "{} ({}) {} = {:.4g} contradicts the other readings, which forecast {:.4g}, {:.4g} to {:.4g} "
        "by 99 %",
        c.reading, c.words, c.result, c.measured, c.forecast, c.low, c.high));
  if (!worst) {
    s.result.reasons.push_back("no measurement could be emulated");
    return;
  }
  const double free = std::max(
      1.0, static_cast<double>(s.result.readings.size()) - static_cast<double>(s.lab.unknowns.size()));
  if (s.result.reasons.empty() && chance_above(s.result.chi_square, free) < contradiction)
    s.result.reasons.push_back(fmt::format(
        "the measurements contradict each other: chi square {:.1f}; the farthest off is {} ({}) {}, by "
        "{:.1f} standard errors",
        s.result.chi_square, worst->test, worst->words, worst->result, std::abs(worst->deviation)));
}

void report_emulators(State& s) {
  for (const ReadingReport& r : s.result.readings)
    if (r.emulator_error > enough * r.error)
      s.result.reasons.push_back(fmt::format(
          "the emulator of {} {} is good to {:.3g}, more than a third of the measurement's error, {:.3g}",
          r.test, r.result, r.emulator_error, r.error));
  if (s.result.r_hat) {
    if (*s.result.r_hat > most_r_hat || s.result.effective_points < fewest_draws)
      s.result.reasons.push_back(fmt::format(
          "the chains have not converged: R-hat {:.3f}, {:.0f} independent draws; at most {} and at least {}",
          *s.result.r_hat, s.result.effective_points, most_r_hat, fewest_draws));
    return;
  }
  s.result.effective_points = effective_points(s.result.posterior);
  if (s.result.effective_points < 12.0)
    s.result.reasons.push_back(fmt::format(
        "the posterior is narrower than its quadrature resolves ({:.0f} points): narrow the ranges",
        s.result.effective_points));
}

void report_forecasts(State& s) {
  s.result.forecasts.resize(s.lab.tests.size() - s.lab.measured);
  for (const Emulated& e : s.emulated) {
    if (is_measured(s, e)) continue;
    ForecastReading forecast{reading_of(s, e).result, {}, 0.0, 0.0};
    if (e.trained) {
      auto predictions = e.predictions;
      const double cells = s.discretisation[e.test][e.reading];
      for (Prediction& p : predictions) p.variance += cells * cells;
      forecast.value = mixture_quantile(s.result.posterior, predictions, 0.5);
      forecast.low = mixture_quantile(s.result.posterior, predictions, 0.025);
      forecast.high = mixture_quantile(s.result.posterior, predictions, 0.975);
    }
    s.result.forecasts[e.test - s.lab.measured].push_back(forecast);
  }
}

void report(State& s) {
  s.discretisation = discretisation_errors(s.lab, s.points[s.result.posterior.best], s.settings);
  update_posterior(s);
  const bool emulated = std::any_of(s.emulated.begin(), s.emulated.end(),
                                    [&](const Emulated& e) { return is_measured(s, e) && e.trained; });
  for (Emulated& e : s.emulated)
    if (e.trained) e.error = error_near_posterior(s, e);
  find_contradictions(s);  // on points all over the ranges, where the others alone may lead
  if (emulated && s.lab.unknowns.size() > 2)
    draw_chains(s);
  else if (emulated)
    refine_points(s);
  report_parameters(s);
  report_readings(s);
  report_contradictions(s);
  report_emulators(s);
  report_forecasts(s);
}

State start(const Lab& lab, const Settings& settings) {
  State s{lab, settings, quadrature_points(lab.unknowns.size()), {}, {}, {}};
  for (std::size_t test = 0; test < lab.tests.size(); ++test) {
    s.discretisation.emplace_back(lab.tests[test].readings.size(), 0.0);
    for (std::size_t reading = 0; reading < lab.tests[test].readings.size(); ++reading)
      s.emulated.push_back({test, reading, false, {}, {}, {}, 0.0});
  }
  return s;
}

}  // namespace

Calibration calibrate(const Lab& lab, const Settings& settings) {
  const std::size_t n = lab.unknowns.size();
  const std::size_t first = settings.first_trials ? settings.first_trials : 6 + 6 * n;
  const std::size_t most = settings.most_trials ? settings.most_trials : 30 * n;
  const std::size_t batch = std::max<std::size_t>(4, static_cast<std::size_t>(settings.jobs));
  State s = start(lab, settings);
  if (!run_more(s, study::unit_points(study::Method::latin_hypercube, first, n, 1))) return s.result;
  bool settled = false;
  while (s.result.trials.size() < most && !settled) {
    const auto points = next_points(s, std::min(batch, most - s.result.trials.size()));
    if (points.empty()) break;
    if (!run_more(s, points)) return s.result;
    settled = !scarce_reading(s) && emulators_suffice(s);
  }
  report(s);
  return s.result;
}

}  // namespace tremie::calibration
