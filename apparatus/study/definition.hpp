#pragma once

// What a study is: a base scene, the keys that change, and the results that are read (STUDY.toml).

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "apparatus/scene/document.hpp"
#include "apparatus/scene/keys.hpp"

namespace tremie::study {

enum class Scale { linear, log };
enum class Method { grid, latin_hypercube, sobol };

/// One value of a factor. `number` is in SI units, not-a-number for a word.
struct Level {
  double number = 0.0;
  std::string text;  ///< as --set takes it: "54 Pa", "0.35", "no_slip"
};

/// A key of the scene that changes from run to run.
struct Factor {
  std::string key;  ///< "mix.yield_stress"
  scene::Key about;
  double low = 0.0, high = 0.0;  ///< SI; range alone
  Scale scale = Scale::linear;
  std::vector<Level> values;  ///< in place of a range
};

struct Definition {
  std::string name;            ///< the file's name without .toml
  std::filesystem::path file;  ///< as the user wrote it
  std::filesystem::path base;  ///< the base scene
  std::string resolved_base;   ///< its values, every one in SI
  std::vector<Factor> factors;
  Method method = Method::latin_hypercube;
  std::size_t levels = 5;  ///< of a factor with a range; grid alone
  std::size_t runs = 100;  ///< Latin hypercube and Sobol sequence alone
  std::uint64_t seed = 1;
  std::vector<std::string> results;  ///< names in summary.json, dotted where one lies in another
};

/// Reads and checks STUDY.toml and its base scene. Throws scene::InputError.
Definition read_definition(const std::filesystem::path& file);

/// A factor from its key and [low, high] or values as they stand in a file. `kinds` is the schema of the
/// scene. Throws scene::InputError that starts with the place of `range`.
Factor read_factor(const std::string& key, const scene::Node& range, bool is_range, Scale scale,
                   const scene::Schema& schema);

/// "mix.yield_stress_Pa": the factor's column.
std::string column_of(const Factor& factor);

/// The SI unit: "Pa"; empty for a plain number or a word.
std::string unit_of(const Factor& factor);

/// The level at a share of 0 to 1 of the factor's range, or the value that the share falls on.
Level level_at(const Factor& factor, double share);

/// The share of the range at which a number lies; the inverse of level_at.
double share_of(const Factor& factor, double number);

}  // namespace tremie::study
