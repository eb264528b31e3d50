#pragma once

// From measurements to the mix: emulators of every reading, trained where the posterior lies, and the
// posterior over the unknowns.

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/calibration/lab.hpp"
#include "apparatus/calibration/posterior.hpp"
#include "apparatus/study/rows/row.hpp"

namespace tremie::calibration {

/// Runs of every test at one point of the unknowns.
struct Trial {
  Point point;
  std::vector<study::Row> rows;  ///< a test each
};

/// How well a reading is emulated and met.
struct ReadingReport {
  std::string test, words, result;     ///< the test's label and words
  double measured = 0.0, error = 0.0;  ///< standard error
  double emulator_error = 0.0;         ///< root mean square of leaving one run out, near the posterior
  double discretisation_error = 0.0;   ///< of the runs' cells and steps, one standard error
  double best_fit = 0.0;               ///< at the posterior's best point
  double deviation = 0.0;              ///< measured - best_fit over the standard error of all of it
  /// Of each run: what it gave, and what the emulator through the others predicts there.
  std::vector<std::array<double, 2>> left_out = {};
};

/// A reading that the others forecast elsewhere.
struct Contradiction {
  std::string reading, words, result;            ///< "measured[1].slump", the test's words, "slump_mm"
  double measured = 0.0;                         ///< in the unit of the result, as all here
  double forecast = 0.0, low = 0.0, high = 0.0;  ///< by the other readings: median, ends of the 99 % interval
};

struct Estimated {
  std::string key, unit;
  double value = 0.0, low = 0.0, high = 0.0;  ///< SI; the median and the ends of the 95 % interval
  std::string told;
};

struct ForecastReading {
  std::string result;
  std::optional<double> value;  ///< the median; empty where hardly any run has the reading
  double low = 0.0, high = 0.0;
};

struct Calibration {
  std::vector<Estimated> parameters;
  std::vector<ReadingReport> readings;
  std::vector<Contradiction> contradictions;
  std::vector<std::vector<ForecastReading>> forecasts;
  std::vector<Trial> trials;
  Posterior posterior;
  double chi_square = 0.0;           ///< of the best fit
  double effective_points = 0.0;     ///< of the posterior's quadrature, or independent draws of its chains
  std::optional<double> r_hat = {};  ///< of the chains; three unknowns and more
  std::vector<std::string> reasons;  ///< why it is not to be trusted
  bool interrupted = false;
};

struct Settings {
  int jobs = 1;
  std::size_t first_trials = 0, most_trials = 0;     ///< 0: by the number of unknowns
  std::function<void(const std::string&)> say = {};  ///< progress
  const std::atomic<bool>* stop = nullptr;
};

/// Throws scene::InputError where a scene cannot be run at all.
Calibration calibrate(const Lab& lab, const Settings& settings);

/// The trials' rows for new points, in processes of their own; false where interrupted.
bool run_trials(const Lab& lab, const std::vector<Point>& points, const Settings& settings,
                std::vector<Trial>& trials);

/// Standard errors by cells and steps of each test's readings at a point, 0 where they cannot be estimated.
std::vector<std::vector<double>> discretisation_errors(const Lab& lab, const Point& point,
                                                       const Settings& settings);

}  // namespace tremie::calibration
