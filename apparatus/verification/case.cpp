#include "apparatus/verification/case.hpp"

#include <algorithm>
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

bool all_kept(const std::vector<Case>& cases) {
  const auto kept = [](const auto& part) {
    return std::all_of(part.bounds.begin(), part.bounds.end(), [](const Bound& b) { return b.kept(); });
  };
  return std::all_of(cases.begin(), cases.end(), [&](const Case& one) {
    return std::all_of(one.problems.begin(), one.problems.end(), kept) &&
           std::all_of(one.tables.begin(), one.tables.end(), kept);
  });
}

}  // namespace tremie::verification
