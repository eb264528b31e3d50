#pragma once

// Spread and slump at rest and t500 of exact Bingham concrete out of a mould lifted at 15 cm/s, over yield stress and plastic
// viscosity: one study of direct runs for each mould (reference_data/slump_flow_table), interpolated.

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tremie::estimate {

/// What a table's concrete was poured out of; SI. The default is the Abrams cone.
struct Mould {
  std::string name = "abrams";
  double foot = 0.2, height = 0.3, volume = 5.497787143782138e-3;  ///< foot: diameter
};

/// Nodes ascending; values by row = yield stress, column = plastic viscosity. SI. t500 is not-a-number where
/// it was not reached.
struct SlumpTable {
  Mould mould;
  double density = 2400.0;  ///< of the runs
  std::vector<double> tau_0, mu;
  std::vector<double> spread, slump, t500;
};

/// One standard error of what is interpolated against a direct run on half the cells.
inline constexpr double table_spread_error = 0.005;  ///< of the spread
inline constexpr double table_slump_error = 0.013;   ///< of the mould's height
inline constexpr double table_t500_error = 0.02;     ///< of t500

struct TableReading {
  double spread = 0.0, slump = 0.0;
  std::optional<double> t500;  ///< empty where it is not reached, or may not be
};

/// Reads the table's CSV (yield_stress_Pa,plastic_viscosity_Pa_s,spread_mm,slump_mm,t500_s; a full grid). Throws
/// std::runtime_error.
SlumpTable read_slump_table(const std::filesystem::path& file, const Mould& mould = {});

/// The table of a mould, by its name in reference_data/cones, in the first of these folders (reference_data) that has one.
/// Throws scene::InputError for a mould without a table, std::runtime_error where there is no table at all.
SlumpTable find_slump_table(std::span<const std::filesystem::path> data_folders,
                            const std::string& mould = "abrams");

/// The same flows at another density: tau_0/rho and mu/rho stay.
SlumpTable at_density(SlumpTable table, double density);

/// Bilinear in ln(tau_0), ln(mu); ln(t500). Gravity and yield stress balance in tau_0/rho and mu/rho, so that
/// one density serves all. Inside of the table alone.
TableReading interpolate(const SlumpTable& table, double tau_0, double mu, double density);

}  // namespace tremie::estimate
