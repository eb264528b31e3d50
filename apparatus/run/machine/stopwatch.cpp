#include "apparatus/run/machine/stopwatch.hpp"

#include <sys/resource.h>

#include <chrono>

namespace tremie {

namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Stopwatch::Stopwatch() : cpu_(cpu_seconds()), wall_(wall_seconds()) {}

void Stopwatch::stop(Cost& cost) const {
  cost.cpu = cpu_seconds() - cpu_;
  cost.wall = wall_seconds() - wall_;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  cost.peak_rss_bytes = std::int64_t{usage.ru_maxrss} * 1024;
}

}  // namespace tremie
