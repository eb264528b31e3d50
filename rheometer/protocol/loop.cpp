#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

/// The integral of the torque over the speed between the two branches, over the speeds that both have.
std::optional<double> area_between(const ProtocolRecord& r, const Section& up, const Section& down) {
  const auto branch = [&](const Section& s) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = s.begin; i < s.end; ++i) points.emplace_back(r.omega[i], r.torque[i]);
    std::sort(points.begin(), points.end());
    return points;
  };
  const auto rising = branch(up), falling = branch(down);
  const double low = std::max(rising.front().first, falling.front().first),
               high = std::min(rising.back().first, falling.back().first);
  if (!(high > low)) return std::nullopt;
  const auto torque_at = [](const std::vector<std::pair<double, double>>& points, double omega) {
    const auto behind = std::lower_bound(points.begin(), points.end(), std::pair(omega, -HUGE_VAL));
    if (behind == points.begin()) return behind->second;
    if (behind == points.end()) return points.back().second;
    const auto& [x, y] = *std::prev(behind);
    return behind->first > x ? y + (behind->second - y) * (omega - x) / (behind->first - x) : y;
  };
  constexpr int pieces = 1000;
  double sum = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const double omega = low + (high - low) * i / pieces, weight = i == 0 || i == pieces ? 0.5 : 1.0;
    sum += weight * (torque_at(rising, omega) - torque_at(falling, omega));
  }
  const double area = sum * (high - low) / pieces;
  return r.sheared_evenly ? area / evenly_sheared_speed : area;
}

}  // namespace

void read_loop(const ProtocolRecord& record, const SectionReading& before, SectionReading& reading) {
  if (before.section.kind != SectionKind::flow_curve_up ||
      reading.section.kind != SectionKind::flow_curve_down)
    return;
  reading.loop_area = area_between(record, before.section, reading.section);
  if (reading.loop_area)
    reading.notes.push_back(text_of("loop: %.4g %s between the branch up and this one", *reading.loop_area,
                                    record.sheared_evenly ? "Pa/s" : "W"));
}

}  // namespace tremie
