#pragma once

// Everything that a run leaves in its folder (scene.toml, summary.json, timeseries.csv, other tables,
// results.h5, frames, charts, report.html). Frames are written as they come, the rest at the end.

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "apparatus/common/shared_keys.hpp"
#include "apparatus/report/run_files/moving.hpp"
#include "libmpm/io/hdf5_file.hpp"

namespace tremie::report {

/// Which of the frames that come are written for ParaView and Python: some, so that a default run stays below 30 MB
/// (every second, every third of more than 20000 points, and the last; no more than 20000 points of each), or all. The
/// report shows them all.
enum class FramesWritten { none, some, all };

/// What the scene's [output] asks for.
FramesWritten frames_written(const scene::Output& output);

/// Every call throws io::WriteError where the folder cannot be written.
class ResultFiles {
 public:
  /// `folder` is there. `resolved` is the scene as TOML; `command` repeats the run.
  ResultFiles(const std::filesystem::path& folder, const std::string& resolved,
              const std::string& command = "", FramesWritten written = FramesWritten::all);

  /// One more time for the report, results.h5 and frames/.
  void frame(const Frame& frame);

  /// All the rest. Returns notes for a person: what was left out, and why.
  std::vector<std::string> finish(const scene::Outcome& outcome);

 private:
  void write_frame(const Frame& frame);
  void write_results_h5(const scene::Outcome& outcome);

  std::filesystem::path folder_;
  std::string resolved_, command_;
  FramesWritten written_;
  std::size_t came_ = 0, stride_ = 1;
  std::optional<Frame> last_;  ///< came last and is not written: it is if no other follows
  ShownFrames shown_;          ///< thinned, for the report
  io::Hdf5File h5_;
  std::vector<std::pair<double, std::string>> frames_;  ///< time, file name
};

}  // namespace tremie::report
