#pragma once

// How a record is to be read by the options: its columns, its geometry; and what it holds before anything is fitted.

#include <filesystem>
#include <string>
#include <vector>

#include "rheometer/records/sections.hpp"
#include "rheometer/vane/geometries.hpp"
#include "rheometer/whole_fit/fit_options.hpp"

namespace tremie {

struct DataTable {
  std::string text, name;
};

/// The first CSV file of `folder` in one of the data folders. Throws RecordError that names the option where there is none.
DataTable data_table(const std::vector<std::filesystem::path>& data_folders, const char* folder,
                     const std::string& option);

struct RecordReading {
  Geometry geometry;              ///< without words where none is named
  bool default_geometry = false;  ///< nothing is said of the geometry
  ReadOptions options;
};

RecordReading reading_of(const FitOptions& options, const std::vector<std::filesystem::path>& data_folders);

/// The geometry in words, and whether it is the default one. `sheared_evenly`: the record's.
std::string geometry_words(const RecordReading& reading, const FitOptions& options, bool sheared_evenly);

/// What a record holds: its table in SI units, and its sections where it has time and speed.
struct ReadRecord {
  NumberTable table;
  bool sheared_evenly = false;  ///< shear rates and stresses stand in the columns of speed and torque
  std::string geometry;
  std::vector<Section> sections;
};

/// Throws RecordError as the fit of the record does for what cannot be read.
ReadRecord read_record(const std::string& file, const FitOptions& options,
                       const std::vector<std::filesystem::path>& data_folders);

}  // namespace tremie
