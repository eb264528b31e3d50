#include "apparatus/run/machine/team.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>

namespace tremie::experiment {
namespace {

constexpr double stretch = 0.5;         ///< a pace is taken over so long at least [s]
constexpr double between = 10.0;        ///< trials [s]: one that loses costs a twentieth of the run
constexpr double put_off_often = 20.0;  ///< [1/s]; on an idle machine it is one or two
constexpr double gain = 0.95;           ///< other threads must bring the clock down to this share

}  // namespace

/// Fewer threads where these are put off, more where there were more; by turns where both may be.
int Team::candidate(double put_off_a_second) {
  const bool fewer = now_ > 1 && put_off_a_second > put_off_often, more = now_ < all_;
  if (!fewer && !more) return now_;
  more_ = more && !(fewer && more_);
  return more_ ? std::min(all_, 2 * now_) : now_ / 2;
}

int Team::after(double work, double clock, double put_off) {
  work_ += work, clock_ += clock, put_off_ += put_off;
  if (clock_ < stretch || work_ <= 0.0) return now_;
  const double pace = clock_ / work_, often = put_off_ / clock_;
  wait_ -= clock_;
  work_ = clock_ = put_off_ = 0.0;
  if (before_ > 0) {
    if (pace > gain * pace_before_) now_ = before_;
    before_ = 0, wait_ = between;
    return now_;
  }
  const int next = wait_ <= 0.0 ? candidate(often) : now_;
  if (next != now_) before_ = now_, pace_before_ = pace, now_ = next;
  return now_;
}

double times_put_off() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_nivcsw);
}

double clock_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace tremie::experiment
