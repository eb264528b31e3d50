#pragma once

// What the outcomes of several apparatus are made of.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "libmpm/constitutive/mix.hpp"

namespace tremie::scene {

inline constexpr double mm = 1e3;  ///< millimetres in a metre

/// Not-a-number for no value: an empty field of a table.
double or_nan(std::optional<double> value);

/// A run that ended before its test did: what it read is so far.
inline bool ended_early(Status status) { return status != Status::completed; }

/// What stands in place of the time at which it came to rest.
const char* still_moving(Status status);

/// "stopped at      4.20 s", or why it is not known.
std::string stopped_line(std::optional<double> stopped_at, Status status);

/// "flocculation    5.78 at the start, 5.4 at the end"; nothing without both.
std::vector<std::string> flocculation_lines(std::optional<double> start, std::optional<double> end);

/// What every apparatus may carry or leave out: flocculation, regularisation, FLIP.
std::string flocculation_use(const Mix& mix);
void add_model_uses(const Model& model, std::vector<std::string>& lines);

/// "Mix A, slump flow without rest", "… after 240 s of rest": what was asked of which mix.
std::string asked_text(const std::string& mix_name, const std::string& test, double rest);

/// A word, or null for an empty one.
ResultValue word_or_null(const std::string& word);

}  // namespace tremie::scene
