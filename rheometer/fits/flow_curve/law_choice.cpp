#include "rheometer/fits/flow_curve/law_choice.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>

#include "rheometer/regression/lack_of_fit.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie::fitting {

namespace {

constexpr double resolution = 1e-6;  ///< relative: what lies below is the rounding of a record and of a fit

double mean_square(const LeastSquaresFit& f) {
  double sum = 0.0;
  for (const double e : f.residual) sum += e * e;
  return sum / static_cast<double>(f.residual.size());
}

double akaike(const Readings& r, const FittedLaw& f) {
  return corrected_akaike(mean_square(f.fit), static_cast<double>(r.size()), static_cast<int>(f.free.size()));
}

/// Whether the law describes the readings: it is not refused, and no parameter lies at an end of its range.
bool describes(const Readings& r, const FittedLaw& f) {
  return !at_bound(f) && misfit_of(r, f.fit, "").empty() && misfit(f) < 0.1;
}

/// The level at which a law with one parameter more is preferred.
double level_for(std::size_t readings) { return readings < 6 ? 0.05 : 0.01; }

std::string text_of(const NestedTest& t, const FittedLaw& first, const FittedLaw& rich) {
  return tremie::text_of("%s misses %zu readings by %.2g %%, %s by %.2g %% (F = %.3g, by chance in %.2g %%)",
                         first.law->words.c_str(), t.readings, 100.0 * t.first_misfit,
                         rich.law->words.c_str(), 100.0 * t.rich_misfit, t.f, 100.0 * t.probability);
}

}  // namespace

NestedTest nested_test(const Readings& all, const FitInput& input, const FittedLaw& first,
                       const FittedLaw& rich) {
  std::vector<char> left_out(all.size(), 0);
  for (std::size_t i = 0; i < all.size(); ++i) left_out[i] = first.fit.outlier[i] || rich.fit.outlier[i];
  const Readings r = without(all, left_out);
  NestedTest test;
  test.readings = r.size();
  const auto n = static_cast<double>(r.size()), p = static_cast<double>(rich.free.size()),
             q = p - static_cast<double>(first.free.size());
  if (!(n > p) || !several_speeds(r)) return test;
  const FittedLaw a = least_squares(r, input, *first.law, Outliers::kept),
                  b = least_squares(r, input, *rich.law, Outliers::kept);
  test.first_misfit = misfit(a), test.rich_misfit = misfit(b);
  const double of_first = test.first_misfit * test.first_misfit * n,
               of_rich = std::max(test.rich_misfit * test.rich_misfit, resolution * resolution) * n;
  const double inflation = n / b.fit.independent;
  test.f = std::max(0.0, of_first - of_rich) / q / inflation / (of_rich / (n - p));
  test.probability = fisher_tail(test.f, q, b.fit.independent - p);
  return test;
}

std::vector<FittedLaw> fit_candidates(const Readings& r, const FitInput& input) {
  std::vector<FittedLaw> fits;
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

FittedLaw choose_law(const Readings& r, const FitInput& input, FitResult& result) {
  const std::vector<FittedLaw> fits = fit_candidates(r, input);
  std::size_t best = 0;
  double least = 1.0;
  for (std::size_t i = 1; i < fits.size(); ++i) {
    const NestedTest test = nested_test(r, input, fits.front(), fits[i]);
    const bool better = test.probability < level_for(test.readings) && test.probability < least;
    const bool stands = describes(r, fits[i]);
    result.choice += (i > 1 ? "; " : "") + text_of(test, fits.front(), fits[i]) +
                     (better && !stands ? ", but does not describe them either" : "");
    if (better && stands) best = i, least = test.probability;
  }
  std::vector<double> aicc;
  for (const FittedLaw& f : fits) aicc.push_back(fits.size() > 1 && at_bound(f) ? HUGE_VAL : akaike(r, f));
  for (std::size_t i = 0; i < fits.size(); ++i)
    add_candidate(fits[i].law->name, r, fits[i].fit, aicc[i], aicc[best], i == best, result);
  if (fits.size() > 1) result.choice = "law " + fits[best].law->name + ": " + result.choice;
  return fits[best];
}

std::optional<BetterLaw> better_law(const Readings& r, const FitInput& input, const FittedLaw& first,
                                    bool refused) {
  constexpr double another = 0.1;
  constexpr std::size_t fewest = 5;
  if (input.law != flow_laws().front().name || input.mu || input.tau_0 || r.size() < fewest)
    return std::nullopt;
  std::optional<BetterLaw> better;
  double least = r.size() < 8 ? 0.01 : 0.001;
  for (const FlowLaw& law : std::span(flow_laws()).subspan(1)) {
    FittedLaw f = least_squares(r, input, law);
    const double tau_0 = first.yield_stress(), other = f.yield_stress();
    const NestedTest test = nested_test(r, input, first, f);
    if (!describes(r, f) || !(test.probability < least)) continue;
    const bool refuses = refused || (test.first_misfit > 0.05 && test.first_misfit > 3.0 * test.rich_misfit);
    if (!refuses && std::abs(other - tau_0) < another * tau_0) continue;
    least = test.probability;
    std::string words =
        law.words +
        tremie::text_of(" describes these readings far better (scatter %.2g %% for %.2g %%) and has %.3g Pa",
                        100.0 * f.fit.scatter, 100.0 * first.fit.scatter, other);
    for (std::size_t k = 0; k < f.all.size(); ++k)
      if (law.parameters[k].has_range())
        words += tremie::text_of(" with %s = %.2g", law.parameters[k].row.symbol.c_str(), f.all[k]);
    better = BetterLaw{std::move(f), test, words, refuses};
  }
  return better;
}

}  // namespace tremie::fitting
