#pragma once

#include <filesystem>
#include <string>

namespace tremie::report {

/// A folder that a result appears in whole or not at all. Everything is written into a hidden folder beside
/// it (inside it, where it is there already and empty), which publish() puts in its place; without publish()
/// nothing stays.
class RunFolder {
 public:
  /// Throws scene::InputError where the folder holds something and `replace` is false, where it holds
  /// something that is no earlier result, or where it cannot be written.
  RunFolder(const std::filesystem::path& folder, bool replace);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& staging() const { return staging_; }
  /// Where it will be.
  const std::filesystem::path& target() const { return target_; }

  /// Throws io::WriteError.
  void publish();

 private:
  void make_staging();

  std::filesystem::path target_, staging_;
  std::filesystem::path made_parent_;  ///< the topmost folder that was made on the way
  bool inside_ = false;                ///< staging lies inside the empty target
  bool published_ = false;
};

}  // namespace tremie::report
