#pragma once

// Everything that a run leaves in its folder (scene.toml, summary.json, timeseries.csv, other tables,
// results.h5, frames, charts, report.html). Frames are written as they come, the rest at the end.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "libmpm/io/hdf5_file.hpp"

namespace tremie::report {

/// Every call throws io::WriteError where the folder cannot be written.
class ResultFiles {
 public:
  /// `folder` is there. `resolved` is the scene as TOML.
  ResultFiles(const std::filesystem::path& folder, const std::string& resolved);

  /// One more time in results.h5 and in frames/.
  void frame(const Frame& frame);

  /// All the rest. Returns notes for a person: what was left out, and why.
  std::vector<std::string> finish(const scene::Outcome& outcome);

 private:
  void write_results_h5(const scene::Outcome& outcome);

  std::filesystem::path folder_;
  std::string resolved_;
  io::Hdf5File h5_;
  std::vector<std::pair<double, std::string>> frames_;  ///< time, file name
};

}  // namespace tremie::report
