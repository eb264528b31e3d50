#include "rheometer/records/rests.hpp"

#include <algorithm>
#include <cmath>

namespace tremie {

namespace {

/// Neighbours of a sweep: speed and torque pass from one row to the next. A vane that is stopped jumps.
bool pass_gradually(const ProtocolRecord& r, std::size_t before, std::size_t row) {
  const auto within = [](double a, double b, double factor) {
    return a > 0.0 && b > 0.0 && a < factor * b && b < factor * a;
  };
  return within(r.omega[before], r.omega[row], 4.0) && within(r.torque[before], r.torque[row], 2.0);
}

bool starts_a_step(const ProtocolRecord& r, std::size_t row) {
  return std::binary_search(r.restarts.begin(), r.restarts.end(), row);
}

/// Whether speeds are imposed one after the other, each faster or slower by the same factor: from three rows, with the next one
/// of the same step. A vane that runs down does not keep a factor.
bool are_steps_of_one_factor(const ProtocolRecord& r, std::size_t begin, std::size_t end) {
  if (begin > 0 && !starts_a_step(r, begin)) --begin;
  if (end < r.omega.size() && !starts_a_step(r, end)) ++end;
  if (end - begin < 4 || !(r.omega[begin] > 0.0)) return false;
  const double first = r.omega[begin + 1] / r.omega[begin];
  if (std::abs(first - 1.0) < 0.05) return false;
  for (std::size_t i = begin + 1; i < end; ++i)
    if (!(std::abs(r.omega[i] / r.omega[i - 1] / first - 1.0) < 0.1)) return false;
  return true;
}

/// Whether the rows are the slow end of a sweep: gradual throughout, and into the faster rows of the same step. Its torque
/// may be small beside the largest one, as that of a fluid with little yield stress is, and noise.
bool ends_a_sweep(const ProtocolRecord& r, std::size_t begin, std::size_t end) {
  if (are_steps_of_one_factor(r, begin, end)) return true;
  for (std::size_t i = begin + 1; i < end; ++i)
    if (!pass_gradually(r, i - 1, i)) return false;
  return (begin > 0 && !starts_a_step(r, begin) && pass_gradually(r, begin - 1, begin)) ||
         (end < r.omega.size() && !starts_a_step(r, end) && pass_gradually(r, end - 1, end));
}

/// Slow rows are a rest where the instrument stands still and nothing holds a torque. A sweep over decades passes there
/// too, its speed in order, and a slow step or a creep test holds its speed or torque.
bool is_rest(const ProtocolRecord& r, std::size_t begin, std::size_t end, double fastest, double largest) {
  constexpr double standing = 1e-6, no_torque = 0.05, held = 0.05, high = 0.2;
  const auto rows = static_cast<double>(end - begin);
  double speed = 0.0, torque = 0.0, low = HUGE_VAL, top = -HUGE_VAL, slowest = HUGE_VAL, quickest = 0.0;
  for (std::size_t i = begin; i < end; ++i) {
    speed += r.omega[i] / rows, torque += r.torque[i] / rows;
    low = std::min(low, r.torque[i]), top = std::max(top, r.torque[i]);
    slowest = std::min(slowest, r.omega[i]), quickest = std::max(quickest, r.omega[i]);
  }
  std::size_t up = 0, down = 0;
  for (std::size_t i = begin + (begin == 0); i < end; ++i)
    (r.omega[i] > r.omega[i - 1] ? up : down) += r.omega[i] != r.omega[i - 1];
  const bool in_order = std::max(up, down) >= 3 && 5 * std::min(up, down) <= up + down;
  if (in_order && ends_a_sweep(r, begin, end)) return false;
  if (torque <= no_torque * largest) return true;
  if (speed <= standing * fastest)
    return !(end - begin >= fewest_rows && torque > high * largest && top - low < held * torque);
  const bool constant = end - begin >= fewest_rows && quickest - slowest <= 2.0 * same_speed * speed;
  return !in_order && !constant;
}

}  // namespace

std::vector<char> rests_of(const ProtocolRecord& r) {
  const std::size_t rows = r.omega.size();
  std::vector<char> rests(rows, 0);
  if (rows == 0) return rests;
  const double fastest = *std::max_element(r.omega.begin(), r.omega.end()),
               largest = *std::max_element(r.torque.begin(), r.torque.end());
  const auto slow = [&](std::size_t i) { return !(r.omega[i] > 5e-4 * fastest); };
  for (std::size_t begin = 0, end = 0; begin < rows; begin = end) {
    for (end = begin + 1; end < rows && slow(end) == slow(begin) && !starts_a_step(r, end); ++end) {
    }
    if (slow(begin) && is_rest(r, begin, end, fastest, largest))
      std::fill(rests.begin() + static_cast<std::ptrdiff_t>(begin),
                rests.begin() + static_cast<std::ptrdiff_t>(end), 1);
  }
  return rests;
}

}  // namespace tremie
