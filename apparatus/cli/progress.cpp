#include "apparatus/cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include "apparatus/cli/process/say.hpp"

namespace tremie::cli {
namespace {

double seconds(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

std::string time_text(double s) {
  if (s < 100.0) return fmt::format("{:.0f} s", s);
  return s < 6000.0 ? fmt::format("{:.0f} min", s / 60.0) : fmt::format("{:.1f} h", s / 3600.0);
}

}  // namespace

ProgressLine::ProgressLine() : terminal_(isatty(STDOUT_FILENO) == 1), start_(Clock::now()), last_(start_) {}

ProgressLine::~ProgressLine() {
  if (open_) say("\r\033[K");
  std::fflush(stdout);
}

/// Ten times a second on a terminal; in a log at every tenth of the run, or after half a minute.
bool ProgressLine::is_due(const scene::Progress& progress) const {
  const double waited = seconds(Clock::now() - last_);
  if (terminal_) return waited >= 0.1;
  return progress.time / progress.duration >= last_share_ + 0.1 || waited >= 30.0;
}

void ProgressLine::show(const scene::Progress& progress) {
  if (!is_due(progress)) return;
  last_ = Clock::now();
  last_share_ = progress.time / progress.duration;
  // A flow may come to rest before its duration: the time left is an upper bound.
  const double left = last_share_ > 0.0 ? seconds(last_ - start_) * (1.0 / last_share_ - 1.0) : 0.0;
  const std::string text =
      fmt::format("{:7.2f} s of {:g} s   step {:.2g} s   {}   at most {} left", progress.time,
                  progress.duration, progress.time_step, progress.reading, time_text(left));
  if (terminal_)
    say("\r\033[K{}", text);
  else
    say("{}\n", text);
  open_ = terminal_;
  std::fflush(stdout);
}

ProgressFile::~ProgressFile() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

void ProgressFile::show(const scene::Progress& progress) {
  const auto now = std::chrono::steady_clock::now();
  if (seconds(now - last_) < 0.5) return;
  last_ = now;
  stream_ << fmt::format("{:7.2f} s of {:g} s   step {:.2g} s   {}\n", progress.time, progress.duration,
                         progress.time_step, progress.reading)
          << std::flush;
}

}  // namespace tremie::cli
