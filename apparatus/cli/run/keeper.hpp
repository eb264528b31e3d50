#pragma once

// Keeps the checkpoints of a run, and its frames for them.

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "apparatus/common/checkpoints.hpp"
#include "apparatus/report/run_files/checkpoint_files.hpp"

namespace tremie::cli {

/// A checkpoint that cannot be written (a full disk) does not end the run: the last one stays.
class Keeper {
 public:
  /// `interval` of wall time between two [s]. `from`: the checkpoint that the run goes on from, in the same folder.
  Keeper(const std::filesystem::path& folder, double interval, const report::RunRequest& request,
         const std::optional<report::Checkpoint>& from);

  void frame(const Frame& frame);
  const Checkpoints* checkpoints() const { return &checkpoints_; }
  /// Why there are no further ones; empty where there are.
  const std::string& trouble() const { return trouble_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool is_due() const;
  void keep(const VisitState& state);
  void keep_for_longer(const VisitState& state);
  report::RunRequest request_now() const;
  template <class Write>
  void attempt(Write write);

  double interval_;
  report::RunRequest request_;  ///< as the run began
  Clock::time_point start_, last_;
  double cost_ = 0.0;  ///< of the last one [s]
  std::unique_ptr<report::CheckpointWriter> writer_;
  Checkpoints checkpoints_;
  std::string trouble_;
};

}  // namespace tremie::cli
