#include "apparatus/report/run_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;

bool is_earlier_result(const fs::path& folder) {
  std::error_code error;
  // a run leaves its scene, a fit its readings, a calibration its mix, a comparison its table, a verification its document
  if (fs::exists(folder / "VERIFICATION.md", error)) return true;
  return fs::exists(folder / "summary.json", error) &&
         (fs::exists(folder / "scene.toml", error) || fs::exists(folder / "fit.csv", error) ||
          fs::exists(folder / "mix.toml", error) || fs::exists(folder / "compare.csv", error));
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& why) {
  throw scene::InputError(fmt::format("--out {}: {}", folder.string(), why));
}

void refuse_what_is_in_the_way(const fs::path& folder, bool replace) {
  std::error_code error;
  const auto status = fs::status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) refuse(folder, "is there already and is no folder");
  if (access(folder.c_str(), R_OK | W_OK | X_OK) != 0) refuse(folder, "cannot be written");
  if (fs::is_empty(folder, error)) return;
  if (!replace) refuse(folder, "holds an earlier result; --force replaces it, --out DIR writes elsewhere");
  if (!is_earlier_result(folder))
    refuse(folder, "holds files that are no earlier result: --force does not replace them");
}

/// The topmost part of `folder` that is not there yet; empty where all of it is.
fs::path first_missing(const fs::path& folder) {
  fs::path missing;
  std::error_code error;
  for (fs::path part = folder; !part.empty() && !fs::exists(part, error); part = part.parent_path())
    missing = part;
  return missing;
}

}  // namespace

RunFolder::RunFolder(const fs::path& folder, bool replace) {
  target_ = fs::absolute(folder).lexically_normal();
  if (!target_.has_filename()) target_ = target_.parent_path();
  refuse_what_is_in_the_way(target_, replace);
  make_staging();
}

void RunFolder::make_staging() {
  std::error_code error;
  inside_ = fs::is_directory(target_, error) && fs::is_empty(target_, error);
  const fs::path parent = inside_ ? target_ : target_.parent_path();
  made_parent_ = first_missing(parent);
  fs::create_directories(parent, error);
  const std::string hidden = fmt::format(".{}.{}.part", target_.filename().string(), getpid());
  if (!error) fs::create_directory(parent / hidden, error);
  if (error) {
    if (!made_parent_.empty()) fs::remove_all(made_parent_);
    refuse(target_, "cannot be written: " + error.message());
  }
  staging_ = parent / hidden;
}

RunFolder::~RunFolder() {
  if (published_) return;
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  for (fs::path part = staging_.parent_path(); !made_parent_.empty(); part = part.parent_path()) {
    if (!fs::remove(part, ignored) || part == made_parent_) break;  // keeps what others have filled meanwhile
  }
}

void RunFolder::publish() try {
  if (inside_) {
    // The target may be a mount point, which cannot be renamed over: move what is inside.
    for (const auto& entry : fs::directory_iterator(staging_))
      fs::rename(entry.path(), target_ / entry.path().filename());
    fs::remove(staging_);
  } else {
    const fs::path old = staging_.string() + ".old";
    const bool replaces = fs::exists(target_);
    if (replaces) fs::rename(target_, old);
    fs::rename(staging_, target_);
    if (replaces) fs::remove_all(old);
  }
  published_ = true;
} catch (const fs::filesystem_error& error) {
  throw io::WriteError(error.what());
}

}  // namespace tremie::report
