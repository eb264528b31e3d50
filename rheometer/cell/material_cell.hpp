#pragma once

// One material cell in simple shear at a prescribed shear rate: the law alone, without a flow.
//
//   tau = mu gamma_dot + f(gamma_dot, (1 + lambda) tau_0)     equations (2), (27), (32), (33) in one
//   dimension
//
// with lambda by the per-point update that the material points use, and beside it by CVODE. With a shear modulus (mix.G)
// the cell is elastic below its yield stress: elastic_cell.hpp.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "libmpm/constitutive/laws/yield_law.hpp"
#include "libmpm/constitutive/mix.hpp"
#include "rheometer/records/shear_history.hpp"

namespace tremie {

struct MaterialCell {
  Mix mix;
  double rest = 0.0;                  ///< before the history, in closed form [s]
  std::vector<ShearSegment> history;  ///< at least one
  std::optional<double> time_step;    ///< of the update [s]; empty: about 2000 steps over the history
};

/// One line of timeseries.csv. Where the shear rate jumps, there are two with the same time.
struct CellSample {
  double time = 0.0;        ///< [s]
  double shear_rate = 0.0;  ///< [1/s]
  /// [Pa]; empty where the law leaves it open: an exact Bingham material at rest, anything up to the yield
  /// stress. An elastic one has a stress at all times.
  std::optional<double> shear_stress;
  std::optional<double> flocculation, flocculation_reference;  ///< empty without thixotropy
  std::optional<double> strain = {};                           ///< since the shear began; elastic alone
  std::optional<double> shear_stress_reference = {};           ///< by CVODE [Pa]; elastic alone
};

/// The largest stress of an elastic cell, between the samples too.
struct StressPeak {
  double stress = 0.0, strain = 0.0;  ///< [Pa]; since the shear began
};

struct CellResult {
  std::vector<CellSample> samples;
  long steps = 0;
  long reference_steps = 0;  ///< of CVODE
  /// Largest difference between the update and CVODE over the samples; empty without thixotropy, and in a
  /// build without SUNDIALS.
  std::optional<double> flocculation_error_max;
  /// int tau d(gamma_dot) around the history, rising branch minus falling [Pa/s]; empty unless the shear rate
  /// ends where it began, with a change between.
  std::optional<double> hysteresis_area;
  std::optional<StressPeak> peak = {};          ///< elastic alone
  std::optional<double> stress_error_max = {};  ///< largest difference from CVODE [Pa]; elastic alone
  std::string reference_failed = {};            ///< why CVODE gave up; empty where it did not
};

/// Runs the cell. Throws std::invalid_argument for an empty history, values out of range, or an elastic cell whose law flows
/// below its yield stress.
CellResult run_cell(const MaterialCell& cell, const YieldLaw& law);

/// Reads a history from the text of a CSV with the columns time_s,shear_rate_per_s (format:
/// torque_record.hpp): linear between the rows, a jump where two rows have the same time. Throws RecordError.
std::vector<ShearSegment> parse_shear_history(std::string_view text, const std::string& name);

}  // namespace tremie
