#include "rheometer/records/ramps.hpp"

#include <algorithm>

#include "rheometer/records/rests.hpp"

namespace tremie {

namespace {

double fastest_of(const std::vector<double>& omega, std::size_t begin, std::size_t end) {
  return *std::max_element(omega.begin() + static_cast<std::ptrdiff_t>(begin),
                           omega.begin() + static_cast<std::ptrdiff_t>(end));
}

/// Whether the speed rises, or falls, through enough rows from `begin` to `end`, by 1.3 and with few steps back.
bool runs_in_order(const std::vector<double>& omega, std::size_t begin, std::size_t end, bool up) {
  std::size_t with = 0, against = 0;
  for (std::size_t i = begin + 1; i < end; ++i)
    (up == (omega[i] > omega[i - 1]) ? with : against) += omega[i] != omega[i - 1];
  const double low = std::min(omega[begin], omega[end - 1]), high = std::max(omega[begin], omega[end - 1]);
  return end - begin >= fewest_rows && high > 1.3 * low && 5 * against <= with + against;
}

/// The row where a ramp down turns into one up; `end` where none does.
std::size_t valley_of(const std::vector<double>& omega, std::size_t begin, std::size_t end) {
  const auto from = omega.begin();
  const auto at = [&](std::size_t i) { return from + static_cast<std::ptrdiff_t>(i); };
  const auto valley = static_cast<std::size_t>(std::min_element(at(begin), at(end)) - from);
  if (valley == begin || valley + 1 >= end) return end;
  const auto before = static_cast<std::size_t>(std::max_element(at(begin), at(valley)) - from),
             behind = static_cast<std::size_t>(std::max_element(at(valley), at(end)) - from);
  return runs_in_order(omega, before, valley + 1, false) && runs_in_order(omega, valley, behind + 1, true)
             ? valley
             : end;
}

}  // namespace

Section flow_curve_section(const std::vector<double>& omega, std::size_t begin, std::size_t end, bool up,
                           bool stepped) {
  return {.kind = up ? SectionKind::flow_curve_up : SectionKind::flow_curve_down,
          .begin = begin,
          .end = end,
          .omega = fastest_of(omega, begin, end),
          .stepped = stepped};
}

void add_ramps(const std::vector<double>& omega, std::size_t begin, std::size_t end,
               std::vector<Section>& sections) {
  if (const std::size_t valley = valley_of(omega, begin, end); valley < end) {
    add_ramps(omega, begin, valley + 1, sections);
    add_ramps(omega, valley + 1, end, sections);
    return;
  }
  const auto from = omega.begin() + static_cast<std::ptrdiff_t>(begin);
  const auto top = static_cast<std::size_t>(
      std::max_element(from, omega.begin() + static_cast<std::ptrdiff_t>(end)) - omega.begin());
  const auto rows = [&](std::size_t a, std::size_t b) { return b - a >= fewest_rows; };
  bool rises = false;
  if (rows(begin, top + 1) && omega[top] > 1.3 * omega[begin]) {
    sections.push_back(flow_curve_section(omega, begin, top + 1, true, false));
    rises = true;
  }
  const std::size_t behind = rises ? top + 1 : begin;
  if (rows(behind, end) && omega[end - 1] < 0.77 * fastest_of(omega, behind, end)) {
    sections.push_back(flow_curve_section(omega, behind, end, false, false));
  } else if (behind < end) {
    sections.push_back({.begin = behind, .end = end, .omega = fastest_of(omega, behind, end)});
  }
}

}  // namespace tremie
