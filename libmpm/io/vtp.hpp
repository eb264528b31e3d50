#pragma once

// Points for ParaView: VTK XML poly data with appended single-precision arrays in base64, and the .pvd that
// strings the times together. No VTK library.

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace tremie::io {

/// A field over the points, `components` values a point.
struct PointField {
  std::string name;
  int components = 1;
  std::span<const double> values;
};

/// Throws WriteError; std::invalid_argument where a field's length is not points times components.
void write_vtp(const std::filesystem::path& file, double time, std::span<const std::array<double, 3>> points,
               std::span<const PointField> fields);

/// `frames`: time [s] and file name relative to the .pvd. Throws WriteError.
void write_pvd(const std::filesystem::path& file, std::span<const std::pair<double, std::string>> frames);

}  // namespace tremie::io
