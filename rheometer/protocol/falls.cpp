#include "rheometer/protocol/falls.hpp"

#include <algorithm>
#include <cmath>

#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

double end_of(const std::vector<double>& torque) {
  const std::size_t n = std::max<std::size_t>(1, torque.size() / 20);
  return median({torque.end() - static_cast<std::ptrdiff_t>(n), torque.end()});
}

bool times_are_rounded(const ProtocolRecord& r, const Section& s) {
  int shared = 0;
  for (std::size_t i = s.begin + 1; i < s.end; ++i) shared += r.time[i] == r.time[i - 1] ? 1 : 0;
  return shared >= 2;
}

/// Seconds between two rows of a section whose times are rounded.
double mean_row_interval(const ProtocolRecord& r, const Section& s) {
  std::vector<double> row, time;
  for (std::size_t i = s.begin; i < s.end; ++i)
    row.push_back(static_cast<double>(i - s.begin)), time.push_back(r.time[i] - r.time[s.begin]);
  return straight_line(row, time).slope;
}

Fall fall_of(const ProtocolRecord& r, const Section& s, std::size_t number) {
  Fall fall{s.omega, {}, {}, number, s.kind == SectionKind::start_up};
  const auto first = r.torque.begin() + static_cast<std::ptrdiff_t>(s.begin);
  const auto last = r.torque.begin() + static_cast<std::ptrdiff_t>(s.end);
  const auto peak = fall.start_up ? static_cast<std::size_t>(std::max_element(first, last) - r.torque.begin())
                                  : peak_of(r, s);
  const double interval = times_are_rounded(r, s) ? mean_row_interval(r, s) : 0.0;
  for (std::size_t i = peak; i < s.end; ++i) {
    fall.time.push_back(interval > 0.0 ? interval * static_cast<double>(i - peak) : r.time[i] - r.time[peak]);
    fall.torque.push_back(r.torque[i]);
  }
  return fall;
}

double torque_at(const Fall& f, double time) {
  const auto behind =
      static_cast<std::size_t>(std::lower_bound(f.time.begin(), f.time.end(), time) - f.time.begin());
  if (behind == 0) return f.torque.front();
  if (behind == f.time.size()) return f.torque.back();
  const double length = f.time[behind] - f.time[behind - 1];
  const double share = length > 0.0 ? (time - f.time[behind - 1]) / length : 1.0;
  return f.torque[behind - 1] + share * (f.torque[behind] - f.torque[behind - 1]);
}

}  // namespace

std::vector<Fall> falls_of(const ProtocolRecord& record, const std::vector<Section>& sections) {
  std::vector<Fall> falls;
  for (std::size_t i = 0; i < sections.size(); ++i) {
    if (sections[i].kind != SectionKind::start_up && sections[i].kind != SectionKind::constant_rate) continue;
    Fall fall = fall_of(record, sections[i], i + 1);
    if (fall.omega > 0.0 && excess_half_time(fall)) falls.push_back(std::move(fall));
  }
  return falls;
}

std::optional<double> excess_half_time(const Fall& f) {
  if (f.torque.size() < 8) return std::nullopt;
  const double end = end_of(f.torque), half = 0.5 * (f.torque.front() + end);
  if (!(f.torque.front() - end > 0.1 * f.torque.front())) return std::nullopt;
  for (std::size_t i = 1; i < f.torque.size(); ++i) {
    if (f.torque[i] > half) continue;
    const double share = (f.torque[i - 1] - half) / (f.torque[i - 1] - f.torque[i]);
    const double time = f.time[i - 1] + share * (f.time[i] - f.time[i - 1]);
    return time > 0.0 ? std::optional(time) : std::nullopt;
  }
  return std::nullopt;
}

std::size_t onset_of(const Fall& f) {
  const auto half_time = excess_half_time(f);
  if (!f.start_up || !half_time) return 0;
  const double width = *half_time / 3.0;
  std::vector<double> slope;
  for (std::size_t i = 0; i < f.time.size() && f.time[i] <= *half_time; ++i)
    slope.push_back(f.torque[i] - torque_at(f, f.time[i] + width));
  const double steepest = *std::max_element(slope.begin(), slope.end());
  const auto onset = std::find_if(slope.begin(), slope.end(), [&](double s) { return s >= 0.7 * steepest; });
  return static_cast<std::size_t>(onset - slope.begin());
}

double plastic_speed(const Fall& f) {
  if (!(f.compliance > 0.0)) return f.omega;
  const std::size_t onset = onset_of(f);
  const double half = 0.5 * (f.torque[onset] + end_of(f.torque));
  std::size_t i = onset + 1;
  while (i + 1 < f.torque.size() && f.torque[i] > half) ++i;
  return f.omega + f.compliance * (f.torque[onset] - f.torque[i]) / (f.time[i] - f.time[onset]);
}

}  // namespace tremie
