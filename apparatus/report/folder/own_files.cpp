#include "apparatus/report/folder/own_files.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;

/// By name: "SIZE SUM" of a file.
using List = std::map<std::string, std::string>;

List list_in(const fs::path& folder) {
  List list;
  std::ifstream stream(folder / list_of_own_files, std::ios::binary);
  std::string size, sum, name;
  while (stream >> size >> sum && std::getline(stream.ignore(), name)) list[name] = size + " " + sum;
  return list;
}

/// Size and sum of the first megabyte: frames and checkpoints may be large. Empty for what is no file, or a link.
std::string state_of(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return {};
  std::ifstream stream(file, std::ios::binary);
  std::string begin(1 << 20, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  const auto n = static_cast<std::size_t>(stream.gcount());
  return fmt::format("{} {:08x}", fs::file_size(file, error),
                     crc32_z(0, reinterpret_cast<const Bytef*>(begin.data()), n));
}

/// The topmost names in a folder that hold no listed file, and the files below the others: by their name in the folder,
/// a folder's with a stroke at its end.
void gather(const fs::path& folder, const fs::path& below, const List& list,
            std::vector<std::string>& names) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / below, error)) {
    const fs::path name = below / entry.path().filename();
    if (name == list_of_own_files) continue;
    if (!entry.is_directory(error) || entry.is_symlink(error)) {
      names.push_back(name.string());
      continue;
    }
    const std::string as_folder = name.string() + "/";
    const auto first = list.lower_bound(as_folder);
    if (first != list.end() && first->first.starts_with(as_folder))
      gather(folder, name, list, names);
    else
      names.push_back(as_folder);
  }
}

void write_list(const fs::path& folder, const List& list) {
  std::string text;
  for (const auto& [name, state] : list) text += fmt::format("{} {}\n", state, name);
  const fs::path file = folder / list_of_own_files,
                 part = folder / (std::string(list_of_own_files) + ".part");
  io::write_text(part, text);
  fs::rename(part, file);
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

void list_as_own(const fs::path& folder, const std::vector<fs::path>& names) {
  List list = list_in(folder);
  for (const fs::path& name : names) list[name.string()] = state_of(folder / name);
  write_list(folder, list);
}

void list_all_as_own(const fs::path& folder) {
  List list;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = entry.path().lexically_relative(folder).string();
    if (entry.is_regular_file() && name != list_of_own_files) list[name] = state_of(entry.path());
  }
  write_list(folder, list);
}

bool is_own_file(const fs::path& folder, const fs::path& name) {
  const List list = list_in(folder);
  const auto listed = list.find(name.string());
  return listed != list.end() && listed->second == state_of(folder / name);
}

std::vector<std::string> foreign_files(const fs::path& folder) {
  const List list = list_in(folder);
  std::vector<std::string> names;
  gather(folder, "", list, names);
  std::erase_if(names, [&](const std::string& name) {
    const auto listed = list.find(name);
    return listed != list.end() && listed->second == state_of(folder / name);
  });
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<std::string> changed_files(const fs::path& folder) {
  const List list = list_in(folder);
  auto names = foreign_files(folder);
  std::erase_if(names, [&](const std::string& name) { return !list.contains(name); });
  return names;
}

std::string short_list(const std::vector<std::string>& names) {
  constexpr std::size_t most = 3;
  const auto end = names.begin() + static_cast<std::ptrdiff_t>(std::min(most, names.size()));
  return fmt::format("{}{}", fmt::join(names.begin(), end, ", "),
                     names.size() > most ? fmt::format(" and {} more", names.size() - most) : "");
}

void remove_own_files(const fs::path& folder) {
  const List list = list_in(folder);
  std::error_code ignored;
  for (const auto& [name, state] : list)
    if (state == state_of(folder / name)) fs::remove(folder / name, ignored);
  for (auto [name, ignore] : list)
    for (fs::path part = fs::path(name).parent_path(); !part.empty(); part = part.parent_path())
      fs::remove(folder / part, ignored);  // where it is empty
  fs::remove(folder / list_of_own_files, ignored);
  fs::remove(folder, ignored);
}

}  // namespace tremie::report
