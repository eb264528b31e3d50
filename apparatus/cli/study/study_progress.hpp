#pragma once

#include <chrono>
#include <cstddef>

namespace tremie::cli {

/// "120 of 200 rows, 2 not to be trusted, about 95 s left": a line that is rewritten on a terminal, a plain
/// one now and then in a log.
class StudyProgress {
 public:
  StudyProgress(std::size_t rows, std::size_t there, bool quiet);
  ~StudyProgress();
  StudyProgress(const StudyProgress&) = delete;
  StudyProgress& operator=(const StudyProgress&) = delete;

  void row_done(bool trusted);

 private:
  using Clock = std::chrono::steady_clock;

  std::size_t rows_, there_, done_ = 0, doubtful_ = 0;
  bool quiet_, terminal_, open_ = false;
  Clock::time_point start_, last_;
};

}  // namespace tremie::cli
