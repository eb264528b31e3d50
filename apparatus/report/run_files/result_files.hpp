#pragma once

// Everything that a run leaves in its folder (scene.toml, summary.json, timeseries.csv, other tables,
// results.h5, frames, charts, report.html). Frames are written as they come, the rest at the end.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "apparatus/report/run_files/moving.hpp"
#include "libmpm/io/hdf5_file.hpp"

namespace tremie::report {

/// Every call throws io::WriteError where the folder cannot be written.
class ResultFiles {
 public:
  /// `folder` is there. `resolved` is the scene as TOML; `command` repeats the run. Without `with_frames` no points
  /// are written: the report alone shows them.
  ResultFiles(const std::filesystem::path& folder, const std::string& resolved,
              const std::string& command = "", bool with_frames = true);

  /// One more time in results.h5 and in frames/.
  void frame(const Frame& frame);

  /// All the rest. Returns notes for a person: what was left out, and why.
  std::vector<std::string> finish(const scene::Outcome& outcome);

 private:
  void write_results_h5(const scene::Outcome& outcome);

  std::filesystem::path folder_;
  std::string resolved_, command_;
  bool with_frames_;
  ShownFrames shown_;  ///< thinned, for the report
  io::Hdf5File h5_;
  std::vector<std::pair<double, std::string>> frames_;  ///< time, file name
};

}  // namespace tremie::report
