#pragma once

#include <chrono>
#include <filesystem>
#include <fstream>

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

/// The same for `tremie watch`, in a file that goes when the run ends. Where it cannot be written nobody can watch.
class ProgressFile {
 public:
  explicit ProgressFile(const std::filesystem::path& file) : path_(file), stream_(file) {}
  ~ProgressFile();
  ProgressFile(const ProgressFile&) = delete;
  ProgressFile& operator=(const ProgressFile&) = delete;

  void show(const scene::Progress& progress);

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  std::chrono::steady_clock::time_point last_ = {};
};

}  // namespace tremie::cli
