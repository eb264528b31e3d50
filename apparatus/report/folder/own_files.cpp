#include "apparatus/report/folder/own_files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <time.h>

#include <algorithm>
#include <functional>

#include "apparatus/scene/input_error.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;

/// The nanoseconds that mark a time of change: whole microseconds, which a disk shared with Windows keeps, too.
constexpr long mark = 271'828'000;

constexpr const char* top_files[] = {"summary.json", "VERIFICATION.md", "VALIDATION.md", "scene.toml",
                                     "mix.toml",     "results.h5",      "frames.pvd",    "shape.png"};

bool is_word(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
}

/// Names that results have: tables and charts have those of their apparatus.
bool is_name_of_ours(const fs::path& name) {
  const fs::path parent = name.parent_path(), file = name.filename();
  const std::string stem = file.stem().string(), ending = file.extension().string();
  if (parent == "frames") return stem.starts_with("frame_") && ending == ".vtp";
  if (parent == "checkpoint") return file == "frames" || file == "state" || file == "state.part";
  if (!parent.empty()) return false;
  const auto is = [&](const char* known) { return file == known; };
  if (std::any_of(std::begin(top_files), std::end(top_files), is)) return true;
  if (ending == ".html") return stem.starts_with("report");
  if (ending == ".toml") return stem.starts_with("lab_");
  return (ending == ".csv" || ending == ".svg") && is_word(stem);
}

bool is_folder_of_ours(const fs::path& name) { return name == "frames" || name == "checkpoint"; }

/// Calls `use` with each file, link and empty or foreign folder, by its name in the folder.
void for_each_entry(const fs::path& folder,
                    const std::function<void(const fs::path& name, bool is_folder)>& use) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const fs::path name = entry.path().filename();
    const bool is_folder = entry.is_directory(error) && !entry.is_symlink(error);
    if (!is_folder || !is_folder_of_ours(name)) {
      use(name, is_folder);
      continue;
    }
    for (const auto& below : fs::directory_iterator(entry.path(), error))
      use(name / below.path().filename(), below.is_directory(error) && !below.is_symlink(error));
  }
}

bool lies_in(const fs::path& path, const fs::path& folder) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), path.begin(), path.end());
  return end == folder.end();
}

}  // namespace

fs::path resolved_folder(const fs::path& folder) {
  std::error_code error;
  fs::path part;
  for (const fs::path& name : fs::absolute(folder)) {
    part /= name;
    if (fs::is_symlink(part, error) && !fs::exists(part, error))
      refuse_folder(folder, fmt::format("{} is a link to {}, which is not there", part.string(),
                                        fs::read_symlink(part, error).string()));
  }
  const fs::path path = fs::weakly_canonical(fs::absolute(folder), error);
  if (error) refuse_folder(folder, "cannot be reached: " + error.message());
  return path.has_filename() ? path : path.parent_path();
}

void refuse_folder(const fs::path& folder, const std::string& why) {
  throw scene::InputError(fmt::format("--out {}: {}", folder.string(), why));
}

void refuse_inputs(const fs::path& folder, const std::vector<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    std::error_code error;
    const fs::path path = fs::canonical(input, error);
    if (error || !lies_in(path, folder)) continue;
    refuse_folder(folder, fmt::format("{} {}, which this command reads: not replaced, not by --force "
                                      "either; --out DIR writes elsewhere",
                                      path == folder ? "is" : "holds", input.string()));
  }
}

void mark_own_file(const fs::path& file) {
  timespec now = {};
  clock_gettime(CLOCK_REALTIME, &now);
  // Not before now: a make program takes a table that is older than its rows for out of date.
  const timespec time{now.tv_sec + (now.tv_nsec > mark ? 1 : 0), mark}, both[] = {time, time};
  utimensat(AT_FDCWD, file.c_str(), both, AT_SYMLINK_NOFOLLOW);
}

void mark_own_files(const fs::path& folder) {
  for_each_entry(folder, [&](const fs::path& name, bool is_folder) {
    if (!is_folder) mark_own_file(folder / name);
  });
}

bool is_marked(const fs::path& file) {
  struct stat status = {};
  return lstat(file.c_str(), &status) == 0 && S_ISREG(status.st_mode) && status.st_mtim.tv_nsec == mark;
}

std::vector<std::string> foreign_files(const fs::path& folder) {
  std::vector<std::string> names;
  for_each_entry(folder, [&](const fs::path& name, bool is_folder) {
    if (is_folder || !is_name_of_ours(name) || !is_marked(folder / name))
      names.push_back(name.string() + (is_folder ? "/" : ""));
  });
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> changed_files(const fs::path& folder) {
  auto names = foreign_files(folder);
  std::erase_if(names, [](const std::string& name) { return !is_name_of_ours(name); });
  return names;
}

std::string short_list(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size()));
  return fmt::format("{}{}", fmt::join(names.begin(), end, ", "),
                     names.size() > most ? fmt::format(" and {} more", names.size() - most) : "");
}

void remove_own_files(const fs::path& folder) {
  const auto foreign = foreign_files(folder);
  std::error_code ignored;
  std::vector<fs::path> own;
  for_each_entry(folder, [&](const fs::path& name, bool is_folder) {
    if (!std::binary_search(foreign.begin(), foreign.end(), name.string() + (is_folder ? "/" : "")))
      own.push_back(name);
  });
  for (const fs::path& name : own) fs::remove(folder / name, ignored);
  for (const char* below : {"frames", "checkpoint"}) fs::remove(folder / below, ignored);  // where empty
  fs::remove(folder, ignored);
}

}  // namespace tremie::report
