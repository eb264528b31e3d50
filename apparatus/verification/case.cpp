#include "apparatus/verification/case.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace tremie::verification {

double observed_order(const Series& series) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const Run& run : series.runs) {
    if (!(run.error > 0.0) || !(run.h > 0.0)) continue;
    const double x = std::log(run.h), y = std::log(run.error);
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  if (n < 2.0) return std::numeric_limits<double>::quiet_NaN();
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

void bound_errors(Problem& problem, const std::string& where, double limit, std::optional<std::size_t> run) {
  for (const Series& s : problem.series)
    problem.bounds.push_back(
        {.what = s.scheme + where, .value = s.runs[run.value_or(s.runs.size() - 1)].error, .limit = limit});
}

std::string unconverged(std::int64_t steps) {
  return steps ? fmt::format("{} unconverged steps", steps) : "";
}

}  // namespace tremie::verification
