#pragma once

// What a fit may be asked for, and the one table that says it: the options of `tremie fit`, the command that repeats a
// fit, `input` of its summary.json and the keyword arguments of Python's fit() are made of its rows.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "rheometer/fits/fit.hpp"

namespace tremie {

/// SI units and names. What is not given keeps its default.
struct FitOptions {
  double vane_radius = Instrument{}.vane_radius, vane_height = Instrument{}.vane_height,
         container_radius = Instrument{}.container_radius;
  std::optional<double> speed, rest;  ///< of a decay [rad/s]; before it [s]
  std::optional<double> yield_stress, plastic_viscosity;
  std::string kinetics = "auto";
  std::string law;  ///< empty: law_of()
  double critical_shear_rate = FitInput{}.gamma_c;
  bool protocol = false;
  double instrument_compliance = 0.0;  ///< [rad/(N m)]
  bool elastic = false;                ///< a protocol's breakdown by plastic shear rates
  double torque_offset = 0.0;          ///< [N m] with its sign
  std::string ends = "none", blades = "none";
  std::optional<double> max_aggregate;
  std::string geometry;  ///< geometries.hpp; empty: the three lengths above
  std::string column, decimal = "auto";
  std::string table;                                           ///< of a file with several: its number, from 1
  std::optional<double> torque_per_degree, full_scale_torque;  ///< of a dial, of readings in % [N m]
  bool tribometer = false;  ///< the records are a smooth cylinder's (tribometer.hpp)
  std::string fill_height;  ///< of each record of a tribometer; empty: the vane's height
  std::string smooth_wall =
      "cylinder";  ///< of a tribometer; or "container", about a vane or a rough cylinder
};

/// The law of flow curves: the one that is given, else Bingham's; in a protocol without blades all are compared.
std::string law_of(const FitOptions& options);

/// Whether the three lengths are those of the default instrument.
bool has_default_lengths(const FitOptions& options);

enum class OptionRange { positive, not_negative, any };

struct FitOption {
  using Member = std::variant<double FitOptions::*, std::optional<double> FitOptions::*,
                              std::string FitOptions::*, bool FitOptions::*>;
  /// Of summary.json: the value is the option's times `factor` over `divisor`. Readers of older files know the order.
  struct Input {
    int place = 0;  ///< 0: not there
    const char* key = "";
    double factor = 1.0, divisor = 1.0;
  };

  std::string name;  ///< "vane_radius"; the command has --vane-radius
  Member member;
  std::string unit;  ///< SI; empty for a word or a flag
  std::string help;
  Input input = {};
  std::vector<std::string> words = {};        ///< that are allowed; none: any text
  OptionRange range = OptionRange::positive;  ///< of a number

  bool is_flag() const { return std::holds_alternative<bool FitOptions::*>(member); }
  bool is_word() const { return std::holds_alternative<std::string FitOptions::*>(member); }
};

/// In the order of the command's help.
const std::vector<FitOption>& fit_options();

/// Sets a number [SI], a word or a flag. Throws std::invalid_argument that says what is allowed.
void set_option(FitOptions& options, const FitOption& option, double value);
void set_option(FitOptions& options, const FitOption& option, const std::string& word);
void set_option(FitOptions& options, const FitOption& option, bool flag);

/// Throws std::invalid_argument for options that do not go together.
void check(const FitOptions& options);

/// What the least squares take of the options.
FitInput input_of(const FitOptions& options);

}  // namespace tremie
