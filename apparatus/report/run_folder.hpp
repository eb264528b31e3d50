#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace tremie::report {

/// In a finished result: the folder of the checkpoint that a longer test goes on from.
inline constexpr const char* for_longer = ".for_longer";

/// Goes on with an unfinished run; or `longer`: with a finished one.
struct Resumed {
  bool longer = false;
};

/// A folder that a result appears in whole or not at all. Everything is written into a hidden folder beside it
/// (inside it, where it is there already and empty), which publish() puts in its place; without publish() nothing
/// stays but a run's checkpoint. One process at a time writes there, held by a lock that ends with it; what a dead
/// process has left without a checkpoint is cleared away by the next that writes beside it.
class RunFolder {
 public:
  /// Throws scene::InputError where the folder holds something or an unfinished run and `replace` is false, where it
  /// holds one of the `inputs` or anything else that is not Tremie's (folder/own_files.hpp), where another process
  /// writes there, or where it cannot be written.
  RunFolder(const std::filesystem::path& folder, bool replace,
            const std::vector<std::filesystem::path>& inputs = {});
  /// What others have put beside the earlier result stays there. Goes on where find_checkpoint(folder, longer) finds a run's
  /// checkpoint, which lies in checkpoint() then. Throws scene::InputError where there is none, and as above.
  RunFolder(const std::filesystem::path& folder, Resumed);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& staging() const { return staging_; }
  /// Where a run keeps its checkpoint.
  std::filesystem::path checkpoint() const { return staging_ / "checkpoint"; }
  /// Where the result will be.
  const std::filesystem::path& target() const { return target_; }

  /// Whether a result that came to its end lies there, whose place no interrupted one takes.
  bool holds_finished_result() const;

  /// Throws io::WriteError.
  void publish();

 private:
  void make_staging();
  void refuse_foreign_staging();
  void remove_made_parents();
  void refuse_what_came_meanwhile();
  void lock();
  void take_over_checkpoint(const std::filesystem::path& from);
  void move_inside();
  void put_in_place();

  std::filesystem::path target_, staging_;
  std::filesystem::path made_parent_;  ///< the topmost folder that was made on the way
  bool inside_ = false;                ///< staging lies inside the empty target
  bool replace_ = false;
  bool published_ = false;
  int lock_ = -1;
};

/// The folder with the checkpoint of the unfinished run that was to fill `folder`: beside it where the run was killed,
/// inside where it was interrupted. `longer`: of the finished run that fills it. Empty where there is none.
std::filesystem::path find_checkpoint(const std::filesystem::path& folder, bool longer = false);

/// The hidden folder that another process writes into at this moment, to fill `folder`; empty where there is none.
std::filesystem::path find_work(const std::filesystem::path& folder);

/// Throws scene::InputError where another process goes on from this checkpoint, or has done so: what is read of it
/// meanwhile is not whole. `longer` as in find_checkpoint().
void refuse_where_another_goes_on(const std::filesystem::path& folder,
                                  const std::filesystem::path& checkpoint, bool longer);

}  // namespace tremie::report
