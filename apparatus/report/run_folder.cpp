#include "apparatus/report/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>
#include <vector>

#include "apparatus/report/folder/own_files.hpp"
#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;

constexpr const char* ours = list_of_own_files;  ///< empty, it marks a folder that results are written into
constexpr const char* complete = ".publishing";  ///< all is written, and some of it already in its place

std::string hidden_name(const fs::path& target) {
  return fmt::format(".{}.part", target.filename().string());
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Whether a process writes there, or has left it.
bool is_staging(const fs::path& folder) {
  std::error_code error;
  return fs::is_regular_file(folder / ours, error) && fs::is_empty(folder / ours, error);
}

/// Holds nothing, or nothing but what a run writes into on its way there.
bool is_free(const fs::path& folder) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename() != hidden_name(folder)) return false;
  return !error;
}

/// Holds a result of a run that was interrupted, or none.
bool is_unfinished(const fs::path& folder) {
  std::ifstream stream(folder / "summary.json", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return text.find("\"status\": \"interrupted\"") != std::string::npos;
}

/// What nobody may write over; whether the folder is there at all.
bool refuse_what_is_no_folder(const fs::path& folder) {
  std::error_code error;
  const auto status = fs::status(folder, error);
  if (!fs::exists(status)) return false;
  if (!fs::is_directory(status)) refuse_folder(folder, "is there already and is no folder");
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) refuse_folder(folder, "cannot be written");
  return true;
}

void refuse_what_is_in_the_way(const fs::path& folder, bool replace) {
  if (!refuse_what_is_no_folder(folder) || is_free(folder)) return;
  if (const auto foreign = foreign_files(folder); !foreign.empty())
    refuse_folder(folder,
                  fmt::format("holds files that are not Tremie's, or were changed since ({}): nothing there "
                              "is replaced, with or without --force; --out DIR writes elsewhere",
                              short_list(foreign)));
  if (replace) return;
  if (is_there(folder / "checkpoint"))
    refuse_folder(folder, fmt::format("holds an interrupted run: `tremie resume {}` goes on with it, --force "
                                      "replaces it",
                                      folder.string()));
  refuse_folder(folder, "holds an earlier result; --force replaces it, --out DIR writes elsewhere");
}

/// The topmost part of `folder` that is not there yet; empty where all of it is.
fs::path first_missing(const fs::path& folder) {
  fs::path missing;
  for (fs::path part = folder; !part.empty() && !is_there(part); part = part.parent_path()) missing = part;
  return missing;
}

enum class Lock { held, taken_by_another, none };

/// Locks a folder as long as this process has it open. A file system without locks has none.
Lock lock_folder(const fs::path& folder, int& file) {
  file = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return Lock::none;
  if (flock(file, LOCK_EX | LOCK_NB) == 0) return Lock::held;
  if (errno != EWOULDBLOCK) return Lock::none;
  close(file);
  file = -1;
  return Lock::taken_by_another;
}

/// The same for who can wait a moment: what a run that was killed had just started (a chart's program) holds its lock
/// until it is under way itself.
Lock lock_patiently(const fs::path& folder, int& file) {
  Lock lock = lock_folder(folder, file);
  for (int attempt = 0; attempt < 10 && lock == Lock::taken_by_another; ++attempt) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    lock = lock_folder(folder, file);
  }
  return lock;
}

/// A run that goes on has a checkpoint, too.
void refuse_what_another_writes(const fs::path& target, const fs::path& staging) {
  int file = -1;
  if (lock_patiently(staging, file) == Lock::taken_by_another)
    refuse_folder(target, "another process writes its result there at this moment");
  if (file >= 0) close(file);
}

/// Whether the open folder is still the one of this name.
bool is_named(int file, const fs::path& folder) {
  struct stat open_one = {}, named = {};
  return fstat(file, &open_one) == 0 && stat(folder.c_str(), &named) == 0 &&
         open_one.st_ino == named.st_ino && open_one.st_dev == named.st_dev;
}

/// Moves all that is left in a complete result's folder into its place, the summary last.
void move_rest(const fs::path& staging, const fs::path& target) {
  std::vector<fs::path> names;
  for (const auto& entry : fs::directory_iterator(staging)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end(), [](const fs::path& a, const fs::path& b) {
    return (a == "summary.json") < (b == "summary.json");
  });
  for (const fs::path& name : names)
    if (name != complete) fs::rename(staging / name, target / name);
  fs::remove_all(staging);
}

/// A process that was killed while it put a result in its place had all of it written.
void finish_publishing(const fs::path& target) {
  const fs::path staging = target / hidden_name(target);
  int file = -1;
  std::error_code ignored;
  if (is_there(staging / complete) && lock_folder(staging, file) != Lock::taken_by_another) try {
      move_rest(staging, target);
    } catch (const fs::filesystem_error&) {  // then it is in the way, and refused
    }
  if (file >= 0) close(file);
}

/// Removes all of a folder but what is called `kept`.
void clear(const fs::path& folder, const std::string& kept = "") {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().filename() != kept) fs::remove_all(entry.path(), ignored);
}

/// What dead processes have left beside a folder without a checkpoint.
void clear_remains(const fs::path& parent, const fs::path& own) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(parent, ignored)) {
    const fs::path& part = entry.path();
    const std::string name = part.filename().string();
    if (part == own || !name.starts_with('.') || !name.ends_with(".part") || !is_staging(part)) continue;
    int file = -1;
    if (lock_folder(part, file) == Lock::held && is_named(file, part) && !is_there(part / "checkpoint/state"))
      fs::remove_all(part, ignored);
    if (file >= 0) close(file);
  }
}

/// Removes an earlier result; what others have put beside it goes into the new one.
void remove_earlier(const fs::path& old, const fs::path& target) {
  std::error_code ignored;
  fs::remove(old / "checkpoint/state", ignored);  // nobody goes on from it any more
  remove_own_files(old);
  for (const auto& entry : fs::directory_iterator(old, ignored))
    if (const fs::path to = target / entry.path().filename(); !is_there(to))
      fs::rename(entry.path(), to, ignored);
  fs::remove(old, ignored);
}

}  // namespace

fs::path find_checkpoint(const fs::path& folder, bool longer) {
  const fs::path target = resolved_folder(folder), hidden = hidden_name(target);
  if (longer) return is_there(target / for_longer / "state") ? target / for_longer : fs::path{};
  for (const fs::path& part : {target.parent_path() / hidden, target / hidden, target})
    if (is_there(part / "checkpoint/state")) return part / "checkpoint";
  return {};
}

fs::path find_work(const fs::path& folder) {
  const fs::path target = resolved_folder(folder), hidden = hidden_name(target);
  for (const fs::path& part : {target.parent_path() / hidden, target / hidden}) {
    int file = -1;
    const bool busy = is_there(part) && lock_folder(part, file) == Lock::taken_by_another;
    if (file >= 0) close(file);
    if (busy) return part;
  }
  return {};
}

void refuse_where_another_goes_on(const fs::path& folder, const fs::path& checkpoint, bool longer) {
  const fs::path target = resolved_folder(folder), hidden = hidden_name(target);
  for (const fs::path& part : {target.parent_path() / hidden, target / hidden})
    if (is_staging(part)) refuse_what_another_writes(target, part);
  if (find_checkpoint(folder, longer) != checkpoint)
    refuse_folder(target, "another process has gone on with its run meanwhile");
}

RunFolder::RunFolder(const fs::path& folder, bool replace, const std::vector<fs::path>& inputs)
    : target_(resolved_folder(folder)), replace_(replace) {
  finish_publishing(target_);
  refuse_inputs(target_, inputs);
  const fs::path unfinished = find_checkpoint(target_);
  if (!unfinished.empty()) refuse_what_another_writes(target_, unfinished.parent_path());
  if (!replace && !unfinished.empty() && unfinished.parent_path() != target_)
    refuse_folder(
        target_,
        fmt::format("there is an unfinished run: `tremie resume {}` goes on with it, --force begins anew",
                    target_.string()));
  refuse_what_is_in_the_way(target_, replace);
  make_staging();
  clear(staging_, ours);
}

RunFolder::RunFolder(const fs::path& folder, Resumed resumed)
    : target_(resolved_folder(folder)), replace_(true) {
  if (find_checkpoint(target_, resumed.longer).empty())
    throw scene::InputError(fmt::format("{}: holds no run to go on with any more", target_.string()));
  if (refuse_what_is_no_folder(target_) && !is_free(target_))
    if (const auto changed = changed_files(target_); !changed.empty())
      refuse_folder(target_,
                    fmt::format("{} was changed since Tremie wrote it, and would be replaced: it has to be "
                                "moved elsewhere first",
                                short_list(changed)));
  make_staging();
  take_over_checkpoint(find_checkpoint(target_, resumed.longer));
}

void RunFolder::make_staging() {
  std::error_code error;
  inside_ = fs::is_directory(target_, error) && is_free(target_);
  const fs::path parent = inside_ ? target_ : target_.parent_path();
  made_parent_ = first_missing(parent);
  fs::create_directories(parent, error);
  staging_ = parent / hidden_name(target_);
  if (!error) refuse_foreign_staging();
  if (!error) lock();
  if (lock_ >= 0) std::ofstream(staging_ / ours);
  if (!error && !is_there(staging_ / ours)) error = std::make_error_code(std::errc::permission_denied);
  if (error) {
    std::error_code ignored;
    if (lock_ >= 0 && !is_there(checkpoint())) fs::remove_all(staging_, ignored);
    remove_made_parents();
    refuse_folder(target_, "cannot be written: " + error.message());
  }
  clear_remains(parent, staging_);
}

/// A folder of the staging's name that bears no mark of Tremie's is none, or the earlier result of a process that was
/// killed when its own was in place.
void RunFolder::refuse_foreign_staging() {
  if (!is_there(staging_) || is_staging(staging_)) return;
  remove_own_files(staging_);
  std::error_code error;
  if (is_there(staging_) && !fs::is_empty(staging_, error))
    refuse_folder(target_, fmt::format("{} holds files that are not Tremie's", staging_.string()));
}

/// Keeps what others have filled meanwhile.
void RunFolder::remove_made_parents() {
  std::error_code ignored;
  for (fs::path part = staging_.parent_path(); !made_parent_.empty(); part = part.parent_path())
    if (!fs::remove(part, ignored) || part == made_parent_) break;
}

void RunFolder::lock() {
  for (int attempt = 0; attempt < 3; ++attempt) {  // another process may put its folder in place just now
    std::error_code error;
    fs::create_directory(staging_, error);
    if (lock_patiently(staging_, lock_) == Lock::taken_by_another)
      refuse_folder(target_, "another process writes its result there at this moment");
    if (lock_ < 0 || is_named(lock_, staging_)) return;
    close(lock_);
    lock_ = -1;
  }
}

/// The checkpoint of an earlier run lies in its result, which stays as it is until this run is done.
void RunFolder::take_over_checkpoint(const fs::path& from) {
  clear(staging_, "checkpoint");
  std::ofstream(staging_ / ours);
  std::error_code error;
  if (from.parent_path() != staging_) {
    const fs::path copy = staging_ / "checkpoint.copy";  // which is none until all of it is there
    fs::copy(from, copy, error);
    if (lock_ >= 0) syncfs(lock_);
    fs::remove_all(checkpoint());
    if (!error) fs::rename(copy, checkpoint(), error);
  }
  if (error) refuse_folder(target_, "its checkpoint cannot be copied: " + error.message());
}

RunFolder::~RunFolder() {
  std::error_code ignored;
  if (!published_ && is_there(checkpoint() / "state")) {  // `tremie resume` goes on from here
    clear(staging_, "checkpoint");
    std::ofstream(staging_ / ours);
  } else if (!published_) {
    fs::remove_all(staging_, ignored);
    remove_made_parents();
  }
  if (lock_ >= 0) close(lock_);
}

/// The target may be a mount point, which cannot be renamed over: moves what is inside.
void RunFolder::move_inside() {
  std::ofstream(staging_ / complete);
  move_rest(staging_, target_);
}

/// By one rename, or one exchange with an earlier result: at no moment is there none.
void RunFolder::put_in_place() {
  if (!is_there(target_)) return fs::rename(staging_, target_);
  if (renameat2(AT_FDCWD, staging_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE) == 0)
    return remove_earlier(staging_, target_);
  const fs::path old = staging_.string() + ".old";
  fs::rename(target_, old);  // a file system that cannot exchange
  fs::rename(staging_, target_);
  remove_earlier(old, target_);
}

bool RunFolder::holds_finished_result() const {
  return is_there(target_) && !is_free(target_) && !is_unfinished(target_);
}

/// Others may have been at work in the target since it was looked at.
void RunFolder::refuse_what_came_meanwhile() {
  const bool filled = is_there(target_) && !is_free(target_);
  if (!filled || (replace_ && !inside_ && changed_files(target_).empty())) return;
  published_ = true;
  throw io::WriteError(fmt::format("{}: was filled by others meanwhile; the result lies in {}",
                                   target_.string(), staging_.string()));
}

void RunFolder::publish() try {
  if (lock_ >= 0 && !is_named(lock_, staging_))
    throw io::WriteError(
        fmt::format("{}: was removed while the result was written into it", staging_.string()));
  list_all_as_own(staging_);
  refuse_what_came_meanwhile();
  inside_ ? move_inside() : put_in_place();
  published_ = true;
} catch (const fs::filesystem_error& error) {
  throw io::WriteError(error.what());
}

}  // namespace tremie::report
