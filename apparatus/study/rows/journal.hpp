#pragma once

// Where a study keeps its rows while it goes on: journal.jsonl, a line a row, each written whole and in one
// piece; rows/I.json of a row that ran elsewhere. A study that was killed goes on from what stands there.

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/study/design.hpp"
#include "apparatus/study/rows/row.hpp"

namespace tremie::study {

/// What rows depend on, as one word: base scene, design and results.
std::string fingerprint(const Definition& study, const Design& design);

class Journal {
 public:
  /// Opens the folder's journal, or makes it. A line that was cut off is taken away. Throws
  /// scene::InputError where the journal belongs to another study or where another process writes it.
  Journal(const std::filesystem::path& folder, const std::string& fingerprint, std::size_t results);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  const std::vector<Row>& rows() const { return rows_; }
  /// Throws io::WriteError.
  void append(const Row& row);

 private:
  void read(const std::string& fingerprint, std::size_t results);
  void write(const std::string& line);

  std::filesystem::path path_;
  int file_ = -1;
  std::vector<Row> rows_;
};

/// Writes DIR/rows/I.json, whole or not at all. Throws io::WriteError.
void write_row_file(const std::filesystem::path& folder, const std::string& fingerprint, const Row& row);

struct RowFiles {
  std::vector<Row> rows;
  std::vector<std::string> problems;  ///< files that are no row of this study, and why
};
RowFiles read_row_files(const std::filesystem::path& folder, const std::string& fingerprint,
                        std::size_t results);

struct Collected {
  std::vector<Row> rows;              ///< by their number; a row that is missing is not in it
  std::vector<std::size_t> missing;   ///< rows of the design that nobody ran
  std::vector<std::string> problems;  ///< rows that came twice with different results
};
/// Sorts the rows; of equal ones the first stays.
Collected collect(std::size_t design_rows, std::vector<Row> rows);

/// How many rows have results of concrete that still moved.
std::size_t moving_rows(const Collected& collected);

}  // namespace tremie::study
