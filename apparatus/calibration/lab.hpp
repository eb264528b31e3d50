#pragma once

// What a laboratory knows, measured and asks for (LAB.toml).

#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/registry/registry.hpp"
#include "apparatus/study/definition.hpp"

namespace tremie::calibration {

/// What is measured is read when the concrete rests, however long that takes.
inline constexpr const char* until_it_rests = "test.duration=100000 s";

/// One number read off a test.
struct Measurement {
  std::string key;                  ///< "spread"
  std::string result;               ///< "spread_mm", its name in summary.json
  double value = 0.0, error = 0.0;  ///< in the unit of `result`; one standard error
  bool logarithmic = false;         ///< emulated by its logarithm: times
};

/// A test that was made, or that a forecast is asked for.
struct Test {
  std::string label;  ///< "measured[0]"
  std::string words;  ///< "slump flow, rest = 240 s"
  std::string apparatus;
  std::vector<std::string> overrides;  ///< of its own keys, as --set takes them
  std::vector<Measurement> readings;   ///< a forecast's have no value and no error
};

struct Lab {
  std::string name;
  std::filesystem::path file;
  std::vector<std::filesystem::path> files;  ///< that it was read from
  std::vector<std::string> known;            ///< overrides
  std::vector<study::Factor> unknowns;
  std::vector<Test> tests;  ///< measured ones first
  std::size_t measured = 0;
};

/// Throws scene::InputError.
Lab read_lab(const std::filesystem::path& file);

/// A test's scene at a point of the unknowns (shares of their ranges). Throws scene::InputError.
scene::Scene scene_at(const Lab& lab, const Test& test, const std::vector<double>& shares);

}  // namespace tremie::calibration
