#include "apparatus/cli/study/study_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>
#include <vector>

#include "apparatus/report/folder/own_files.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {
namespace {

namespace fs = std::filesystem;

/// Files that are listed as Tremie's when they are written.
constexpr const char* listed[] = {"design.csv",   "study.csv",    "study.h5",  "report.html",
                                  "summary.json", "study.sbatch", "Snakefile", "study.sh"};

bool begins_with(const fs::path& file, std::string_view text) {
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return false;
  std::ifstream stream(file, std::ios::binary);
  std::string begin(text.size(), '\0');
  return stream.read(begin.data(), static_cast<std::streamsize>(begin.size())) && begin == text;
}

bool is_own(const fs::path& folder, const fs::path& name) {
  const fs::path file = folder / name;
  if (name == "journal.jsonl" || name.parent_path() == "rows")
    return begins_with(file, R"({"tremie_study":)");
  if (name == "parallel.log") return begins_with(file, "Seq\tHost\tStarttime");
  return report::is_own_file(folder, name);
}

/// The names that a study writes and that are there.
std::vector<fs::path> names_there(const fs::path& folder) {
  std::vector<fs::path> names{"journal.jsonl", "parallel.log"};
  names.insert(names.end(), std::begin(listed), std::end(listed));
  std::error_code error;
  std::erase_if(names,
                [&](const fs::path& name) { return !fs::exists(fs::symlink_status(folder / name, error)); });
  for (const auto& entry : fs::directory_iterator(folder / "rows", error))
    if (entry.path().extension() == ".json") names.push_back("rows" / entry.path().filename());
  return names;
}

fs::path earlier_in(const fs::path& folder) { return folder / ".earlier"; }

void remove_earlier(const fs::path& folder) {
  const fs::path earlier = earlier_in(folder);
  std::error_code ignored;
  for (const fs::path& name : names_there(earlier))
    if (is_own(earlier, name)) fs::remove(earlier / name, ignored);
  fs::remove(earlier / "rows", ignored);
  report::remove_own_files(earlier);
}

/// An unfinished study goes; a finished one is put aside.
void give_way(const fs::path& folder) {
  const auto names = names_there(folder);
  std::vector<std::string> foreign;
  for (const fs::path& name : names)
    if (!is_own(folder, name)) foreign.push_back(name.string());
  if (!foreign.empty())
    report::refuse_folder(folder,
                          fmt::format("holds files that are not Tremie's, or were changed since ({}): not "
                                      "replaced, with or without --force; --out DIR writes elsewhere",
                                      report::short_list(foreign)));
  const bool finished = fs::exists(folder / "summary.json");
  if (finished) {
    remove_earlier(folder);
    fs::create_directories(earlier_in(folder) / "rows");
    fs::copy_file(folder / report::list_of_own_files, earlier_in(folder) / report::list_of_own_files);
  }
  for (const fs::path& name : names)
    finished ? fs::rename(folder / name, earlier_in(folder) / name) : void(fs::remove(folder / name));
  std::error_code ignored;
  fs::remove(folder / "rows", ignored);
  fs::remove(folder / report::list_of_own_files, ignored);
}

}  // namespace

bool is_study_folder(const fs::path& folder) {
  return fs::exists(folder / "design.csv") || fs::exists(folder / "rows");
}

void make_study_folder(const fs::path& folder, bool goes_on, bool replace) {
  const bool filled = fs::is_directory(folder) && !fs::is_empty(folder);
  if (fs::exists(folder) && !fs::is_directory(folder)) report::refuse_folder(folder, "is no folder");
  if (filled && !is_study_folder(folder)) report::refuse_folder(folder, "holds files that are no study");
  if (filled && !goes_on && !replace)
    report::refuse_folder(folder, "holds a study; --resume goes on with it, --force starts over");
  if (filled && !goes_on) give_way(folder);
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) report::refuse_folder(folder, "cannot be written: " + error.message());
}

void write_design(const fs::path& folder, const std::string& design) {
  const fs::path file = folder / "design.csv";
  if (!fs::exists(file)) {
    const fs::path part = folder / fmt::format(".design.{}.part", getpid());
    io::write_text(part, design);
    fs::rename(part, file);
    report::list_as_own(folder, {"design.csv"});
    return;
  }
  std::ifstream stream(file, std::ios::binary);
  if (std::string(std::istreambuf_iterator<char>(stream), {}) != design)
    report::refuse_folder(folder, "its design.csv is another study's; --force starts over");
}

void finish_study_folder(const fs::path& folder) {
  report::list_as_own(folder, {"study.csv", "study.h5", "report.html", "summary.json"});
  remove_earlier(folder);
}

std::string where_the_earlier_is(const fs::path& folder) {
  const fs::path earlier = earlier_in(folder);
  return fs::exists(earlier) ? fmt::format("; the earlier study lies in {}", earlier.string()) : "";
}

}  // namespace tremie::cli
