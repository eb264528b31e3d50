#pragma once

#include <ctime>

#include "apparatus/common/model.hpp"

namespace tremie {

/// CPU seconds of this process.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// CPU time of this process [s], wall clock [s], largest memory [bytes]: for Cost.
class Stopwatch {
 public:
  Stopwatch();
  void stop(Cost& cost) const;

 private:
  double cpu_, wall_;
};

}  // namespace tremie
