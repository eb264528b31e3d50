#include "rheometer/protocol/fall_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tremie {

namespace {

constexpr std::size_t most_rows = 300, least_rows = 6;
constexpr double same_speed = 1.05;
constexpr double least_fall = 0.25;  ///< of the torque at the onset: less tells no rate beside an unknown end

/// Rows of a fall from its onset on; time from there.
Fall thinned(const Fall& f) {
  const std::size_t onset = onset_of(f);
  Fall rest{f.omega, {}, {}, f.section, f.start_up};
  const double scale = 0.2 * excess_half_time(f).value_or(f.time.back()), start = f.time[onset];
  const double length = std::log1p((f.time.back() - start) / scale);
  const std::size_t rows = f.time.size() - onset;
  double next = 0.0;
  for (std::size_t i = onset; i < f.time.size(); ++i) {
    const double at = std::log1p((f.time[i] - start) / scale) / length;
    if (rows > most_rows && at < next) continue;
    if (!(f.torque[i] > 0.0)) continue;
    rest.time.push_back(f.time[i] - start);
    rest.torque.push_back(f.torque[i]);
    next = std::max(next + 1.0 / static_cast<double>(most_rows), at);
  }
  return rest;
}

}  // namespace

FallRows rows_of(const std::vector<Fall>& falls, const std::vector<double>& shear_rate) {
  FallRows rows;
  std::vector<double> speeds;
  rows.begin.push_back(0);
  for (std::size_t s = 0; s < falls.size(); ++s) {
    Fall fall = thinned(falls[s]);
    if (fall.time.size() < least_rows || fall.torque.back() > (1.0 - least_fall) * fall.torque.front())
      continue;
    const auto known = std::find_if(speeds.begin(), speeds.end(), [&](double omega) {
      return std::max(omega, fall.omega) < same_speed * std::min(omega, fall.omega);
    });
    rows.speed.push_back(static_cast<std::size_t>(known - speeds.begin()));
    if (known == speeds.end()) speeds.push_back(fall.omega);
    rows.begin.push_back(rows.begin.back() + fall.time.size());
    rows.shear_rate.push_back(shear_rate[s]);
    rows.falls.push_back(std::move(fall));
  }
  rows.speeds = speeds.size();
  return rows;
}

}  // namespace tremie
