#include "apparatus/study/rows/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::study {
namespace {

namespace fs = std::filesystem;

std::string read_all(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

/// 64 bits of FNV-1a.
std::string hash_of(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ull;
  return fmt::format("{:016x}", hash);
}

std::string header(const std::string& fingerprint) {
  return nlohmann::ordered_json{{"tremie_study", 1}, {"fingerprint", fingerprint}}.dump() + "\n";
}

}  // namespace

std::string fingerprint(const Definition& study, const Design& design) {
  return hash_of(study.resolved_base + design_csv(study, design) +
                 fmt::format("{}", fmt::join(study.results, "\n")));
}

Journal::Journal(const fs::path& folder, const std::string& fingerprint, std::size_t results)
    : path_(folder / "journal.jsonl") {
  file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0) io::fail_to_write(path_);
  try {
    if (flock(file_, LOCK_EX | LOCK_NB) != 0)
      throw scene::InputError(
          fmt::format("--out {}: another tremie study is at work on this folder", folder.string()));
    read(fingerprint, results);
  } catch (...) {
    close(file_);
    throw;
  }
}

Journal::~Journal() { close(file_); }

void Journal::read(const std::string& fingerprint, std::size_t results) {
  const std::string text = read_all(path_);
  std::size_t good = text.find('\n') == std::string::npos ? 0 : text.find('\n') + 1;
  if (good == 0) {
    if (ftruncate(file_, 0) != 0) io::fail_to_write(path_);
    return write(header(fingerprint));
  }
  if (text.substr(0, good) != header(fingerprint))
    throw scene::InputError(fmt::format(
        "{}: belongs to another study: the base scene, the factors, the design or the results have changed; "
        "--force starts over, --out DIR writes elsewhere",
        path_.string()));
  while (good < text.size()) {
    const auto end = text.find('\n', good);
    const auto row =
        end == std::string::npos ? std::nullopt : row_from_json(text.substr(good, end + 1 - good), results);
    if (!row) break;
    rows_.push_back(*row);
    good = end + 1;
  }
  if (good < text.size() && ftruncate(file_, static_cast<off_t>(good)) != 0) io::fail_to_write(path_);
}

void Journal::write(const std::string& line) {
  if (::write(file_, line.data(), line.size()) != static_cast<ssize_t>(line.size())) io::fail_to_write(path_);
}

void Journal::append(const Row& row) {
  write(row_json(row));
  rows_.push_back(row);
}

void write_row_file(const fs::path& folder, const std::string& fingerprint, const Row& row) {
  std::error_code error;
  fs::create_directories(folder / "rows", error);
  const fs::path file = folder / "rows" / fmt::format("{}.json", row.row);
  const fs::path part = folder / "rows" / fmt::format(".{}.{}.part", row.row, getpid());
  io::write_text(part, header(fingerprint) + row_json(row));
  fs::rename(part, file, error);
  if (error) io::fail_to_write(file);
}

RowFiles read_row_files(const fs::path& folder, const std::string& fingerprint, std::size_t results) {
  RowFiles found;
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder / "rows", error))
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    const std::string text = read_all(file);
    const std::string head = header(fingerprint);
    const auto row = text.starts_with(head) ? row_from_json(text.substr(head.size()), results) : std::nullopt;
    if (row)
      found.rows.push_back(*row);
    else
      found.problems.push_back(fmt::format("rows/{} is no row of this study", file.filename().string()));
  }
  return found;
}

Collected collect(std::size_t design_rows, std::vector<Row> rows) {
  Collected all;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.row < b.row; });
  for (Row& row : rows) {
    if (row.row >= design_rows) {
      all.problems.push_back(fmt::format("row {} is not in the design", row.row));
    } else if (all.rows.empty() || all.rows.back().row != row.row) {
      all.rows.push_back(std::move(row));
    } else if (!same_result(all.rows.back(), row)) {
      all.problems.push_back(fmt::format("row {} came twice, with different results", row.row));
    }
  }
  std::size_t next = 0;
  for (std::size_t i = 0; i < design_rows; ++i) {
    if (next < all.rows.size() && all.rows[next].row == i)
      ++next;
    else
      all.missing.push_back(i);
  }
  return all;
}

std::size_t moving_rows(const Collected& collected) {
  return static_cast<std::size_t>(
      std::count_if(collected.rows.begin(), collected.rows.end(), [](const Row& row) { return row.moving; }));
}

}  // namespace tremie::study
