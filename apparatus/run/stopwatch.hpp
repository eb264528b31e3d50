#pragma once

#include "apparatus/common/model.hpp"

namespace tremie {

/// CPU seconds of this process.
double cpu_seconds();

/// CPU time of this process [s], wall clock [s], largest memory [bytes]: for Cost.
class Stopwatch {
 public:
  Stopwatch();
  void stop(Cost& cost) const;

 private:
  double cpu_, wall_;
};

}  // namespace tremie
