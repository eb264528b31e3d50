#pragma once

// Validation: what was measured on real concrete and paste, against what Tremie predicts. One page, misses included.

#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tremie::validation {

/// One number that was measured and predicted. Half-widths of 95 % intervals; not-a-number where none is known.
struct Comparison {
  std::string what, unit;
  double measured = 0.0, measured_error = 0.0;
  double predicted = 0.0, predicted_error = 0.0;
  std::string note = {};  ///< in place of a verdict, where the comparison allows none
};

/// "met" where the difference is within both intervals together, "missed"; the comparison's note.
std::string verdict(const Comparison& comparison);

struct Section {
  std::string name;   ///< "mixes", in the CSV
  std::string title;  ///< of the page
  std::string text;   ///< above the table: what is compared, in Markdown
  std::vector<Comparison> comparisons = {};
  std::vector<std::string> findings = {};  ///< below the table
};

struct Settings {
  int jobs = 1;
  std::filesystem::path folder;                      ///< where input files of calibrations are left
  std::function<void(const std::string&)> say = {};  ///< progress
  const std::atomic<bool>* stop = nullptr;
};

/// Thrown where Settings::stop ended the work.
struct Interrupted {};

Section paper_mixes(const Settings& settings);  ///< Mixes A to C fresh and rested, the paper's parameters
/// The exponent of the shear rate in the breakdown from two mixes, forecast of the third; draws breakdown.svg.
Section breakdown_of_pairs(const Settings& settings);
/// One interface law of the floor for all three mixes, from two mixes, forecast of the third.
Section sliding_floor(const Settings& settings);
Section torque_records(
    const Settings& settings);  ///< the site's decay; static yield stress of a paste over rest
Section stiff_mixes(const Settings& settings);  ///< slump against yield stress, two published correlations

Section slump_pairs(const Settings& settings);  ///< slump over flow of 103 concretes; draws slump_pairs.svg

/// All of them, in the page's order.
std::vector<Section> all_sections(const Settings& settings);

/// Writes VALIDATION.md and validation.csv.
void write_page(const std::vector<Section>& sections, double wall_seconds,
                const std::filesystem::path& folder);

}  // namespace tremie::validation
