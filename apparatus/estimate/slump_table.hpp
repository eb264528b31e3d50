#pragma once

// Slump flow and t500 of exact Bingham concrete lifted at 15 cm/s, over yield stress and plastic viscosity: one
// study of direct runs (reference_data/slump_flow_table), interpolated.

#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace tremie::estimate {

/// Nodes ascending; values by row = yield stress, column = plastic viscosity. SI. t500 is not-a-number where
/// it was not reached.
struct SlumpTable {
  double density = 2400.0;  ///< of the runs
  std::vector<double> tau_0, mu;
  std::vector<double> spread, t500;
};

/// One standard error of what is interpolated against a direct run, the scatter of runs included.
inline constexpr double table_spread_error = 0.003;  ///< [m]
inline constexpr double table_t500_error = 0.02;     ///< of t500

struct TableReading {
  double spread = 0.0;
  std::optional<double> t500;  ///< empty where it is not reached, or may not be
};

/// Reads the table's CSV (yield_stress_Pa,plastic_viscosity_Pa_s,spread_mm,t500_s; a full grid). Throws
/// std::runtime_error.
SlumpTable read_slump_table(const std::filesystem::path& file);

/// The table in the first of these folders (reference_data) that has one. Throws std::runtime_error.
SlumpTable find_slump_table(std::span<const std::filesystem::path> data_folders);

/// The same flows at another density: tau_0/rho and mu/rho stay.
SlumpTable at_density(SlumpTable table, double density);

/// Bilinear in ln(tau_0), ln(mu); ln(t500). Gravity and yield stress balance in tau_0/rho and mu/rho, so that
/// one density serves all. Inside of the table alone.
TableReading interpolate(const SlumpTable& table, double tau_0, double mu, double density);

}  // namespace tremie::estimate
