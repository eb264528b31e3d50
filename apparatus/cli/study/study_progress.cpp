#include "apparatus/cli/study/study_progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "apparatus/cli/process/say.hpp"

namespace tremie::cli {

StudyProgress::StudyProgress(std::size_t rows, std::size_t there, bool quiet)
    : rows_(rows),
      there_(there),
      quiet_(quiet),
      terminal_(isatty(STDOUT_FILENO) != 0),
      start_(Clock::now()),
      last_(start_) {
  if (!quiet_ && there_ > 0) say("{} of {} rows are there\n", there_, rows_);
}

StudyProgress::~StudyProgress() {
  if (open_) say("\n");
}

void StudyProgress::row_done(bool trusted) {
  ++done_;
  if (!trusted) ++doubtful_;
  const auto now = Clock::now();
  const double since = std::chrono::duration<double>(now - last_).count();
  const bool all = there_ + done_ == rows_;
  if (quiet_ || (!all && since < (terminal_ ? 0.2 : 10.0))) return;
  last_ = now;
  const double spent = std::chrono::duration<double>(now - start_).count();
  const double left = spent / static_cast<double>(done_) * static_cast<double>(rows_ - there_ - done_);
  say("{}{} of {} rows, {} not to be trusted, about {:.0f} s left{}", terminal_ ? "\r" : "", there_ + done_,
      rows_, doubtful_, left, terminal_ ? "   " : "\n");
  std::fflush(stdout);
  open_ = terminal_;
}

}  // namespace tremie::cli
