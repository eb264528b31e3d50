#pragma once

// A result that lies in a folder, read back: what `tremie compare` sets side by side.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/outcome.hpp"

namespace tremie::report {

/// A value under its dotted key: "reiner_riwlin.yield_stress_Pa". `number` where it is one; `text` as it is
/// written in the file, "–" for null.
struct Entry {
  std::string key, text;
  std::optional<double> number;
};

/// Columns of a file; empty where the folder has none.
struct FileColumns {
  std::string file;
  std::vector<scene::Column> columns;
};

struct RunResult {
  std::string name;    ///< the folder's name, or its path where two have the same
  std::string folder;  ///< as the user wrote it
  std::string apparatus, status, program;
  std::vector<std::string> reasons;  ///< why it is not to be trusted
  std::vector<Entry> scene;          ///< empty where the command takes no scene (a fit, a study)
  std::vector<Entry> results;
  std::vector<Entry> errors;  ///< half the bar about a result, by its key
  FileColumns series;
  std::vector<FileColumns> tables;  ///< over something else than time
};

/// The values of a scene under their dotted keys; `text` is TOML, `name` stands for it in messages.
std::vector<Entry> scene_entries(const std::string& text, const std::string& name);

/// The entry of a key; nullptr where there is none.
const Entry* find_entry(const std::vector<Entry>& entries, const std::string& key);

/// Throws scene::InputError that says what the folder lacks.
RunResult read_run_result(const std::string& folder);

}  // namespace tremie::report
