#pragma once

// The checkpoint of a run in a folder of its own: `frames`, every frame that came so far, and `state`, all else. From
// both the files of a run are written anew as if it had never stopped.
//
// `state` appears whole or not at all: it is written beside, brought to the disk and renamed. It names the bytes of
// `frames` that belong to it and their sum, so that what came later is cut off. Both are for the program that wrote
// them and no other. `end` is a state too, the last that the end of the test's time has no part in: a finished run keeps it,
// with its frames, in a folder of its result.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>

#include "apparatus/common/model.hpp"
#include "libmpm/body/archive.hpp"

namespace tremie::report {

/// What a run was asked, and what it took before it was stopped.
struct RunRequest {
  std::string name, resolved, command;  ///< of the scene; the scene in SI; what repeats the run
  std::string accuracy = {};            ///< --accuracy; empty: none
  bool with_error = false;
  bool crate = false;  ///< --crate
  int threads = 1;
  double wall = 0.0, cpu = 0.0;  ///< so far [s]
};

/// Writes a run's checkpoints. Throws io::WriteError.
class CheckpointWriter {
 public:
  /// Goes on after the first `length` bytes of frames, whose sum is `sum`; the folder is made where it is missing.
  CheckpointWriter(const std::filesystem::path& folder, std::uint64_t length = 0, std::uint32_t sum = 0);
  ~CheckpointWriter();
  CheckpointWriter(const CheckpointWriter&) = delete;
  CheckpointWriter& operator=(const CheckpointWriter&) = delete;

  void frame(const Frame& frame);
  void state(const RunRequest& request, const VisitState& state);
  /// For a longer test to go on from.
  void end(const RunRequest& request, const VisitState& state);

 private:
  void write(const char* name, bool at_once, const RunRequest& request, const VisitState& state);

  std::filesystem::path folder_;
  std::uint64_t length_;
  std::uint32_t sum_;
  std::FILE* frames_;
};

/// A checkpoint that was read and found to be whole.
struct Checkpoint {
  std::filesystem::path folder;
  RunRequest request;
  std::uint64_t frames_length = 0;
  std::uint32_t frames_sum = 0;
  std::uint64_t state_at = 0;  ///< where the state begins in its file
};

/// Throws scene::InputError where it is damaged, cut, or of another version of tremie.
Checkpoint read_checkpoint(const std::filesystem::path& folder);
/// Makes a folder with the checkpoint that a longer test goes on from, of the `end` in a run's checkpoint; none where there
/// is no `end`, or no room.
void keep_for_longer(const std::filesystem::path& checkpoint, const std::filesystem::path& folder);
/// Writes another request over that of the checkpoint in a folder. Throws io::WriteError.
void ask_for_longer(const Checkpoint& checkpoint, const RunRequest& request);

/// Removes a checkpoint that nobody needs any more; one that is half removed is none.
void remove_checkpoint(const std::filesystem::path& folder);
/// Fills the state that it was written from.
void restore(const Checkpoint& checkpoint, const VisitState& state);
/// The frames that came before it, one after the other.
void for_each_frame(const Checkpoint& checkpoint, const std::function<void(const Frame&)>& use);

}  // namespace tremie::report
