#pragma once

#include <chrono>

#include "apparatus/common/outcome.hpp"

namespace tremie::cli {

/// Shows a run going on: one line that is rewritten on a terminal, plain lines now and then in a log.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const scene::Progress& progress);

 private:
  using Clock = std::chrono::steady_clock;
  bool is_due(const scene::Progress& progress) const;

  bool terminal_;
  bool open_ = false;  ///< a line without an end stands on the terminal
  Clock::time_point start_, last_;
  double last_share_ = 0.0;
};

}  // namespace tremie::cli
