#pragma once

// From records to parameters in one call: what `tremie fit` and Python's fit() both make. Ends and blades of the vane,
// the sections of a whole test and the mean over replicates are part of it.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "rheometer/protocol/protocol.hpp"
#include "rheometer/whole_fit/fit_options.hpp"
#include "rheometer/whole_fit/replicates.hpp"

namespace tremie {

/// A record in a file, or one in memory.
struct RecordSource {
  std::string name;                         ///< the file; of one in memory empty
  std::optional<TorqueRecord> record = {};  ///< in memory, the torque's offset not yet taken off
};

/// By how much the ends of the vane move a parameter.
struct MoveByEnds {
  std::string key;            ///< of summary.json
  double without_ends = 0.0;  ///< the parameter of the same fit without them
  double change = 0.0;        ///< relative, by the ends
};

/// A whole test and what was read of it.
struct ProtocolFit {
  ProtocolRecord record;
  ProtocolReading reading;
};

struct RecordFits {
  FitOptions options;
  double end_factor = 1.0;             ///< torque of side and ends over that of the side
  Instrument instrument;               ///< of the fits, the end factor in the vane's height
  std::string geometry;                ///< in words, and whether it is the default one
  bool default_geometry = false;       ///< nothing is said of the geometry, and the record needs it
  std::vector<FitResult> fits;         ///< one a record; none of a protocol
  std::vector<MoveByEnds> moves;       ///< of a single record with ends
  std::vector<ReplicateMean> means;    ///< of several records
  std::vector<ProtocolFit> protocols;  ///< one a record; none without --protocol
  std::vector<std::string> notes;      ///< on several records together
  std::vector<std::string>
      reasons;  ///< why a result is not to be trusted; of several records with the record's name
};

/// Fits the records as the options say, each alone or its sections; several are of one material. The tables of ends
/// and blades are the first CSV file of vane_ends/ and vane_blades/ in one of the folders. Throws RecordError, with file
/// and place, for a fault of a record or of its fit, and std::invalid_argument for options that do not go together.
RecordFits fit_records(const std::vector<RecordSource>& sources, const FitOptions& options,
                       const std::vector<std::filesystem::path>& data_folders);

}  // namespace tremie
