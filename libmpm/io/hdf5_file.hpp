#pragma once

// An HDF5 file that is written once, front to back: groups, attributes, arrays of doubles. It holds no time
// stamps, so the same calls make the same bytes.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tremie::io {

/// Every call throws WriteError where the file cannot be written.
class Hdf5File {
 public:
  /// Makes the file, over an earlier one.
  explicit Hdf5File(const std::filesystem::path& file);
  ~Hdf5File();  ///< closes without a word; call close() to know
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  void group(const std::string& path);

  /// Attributes of a group or an array; "/" is the file.
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);
  void attribute(const std::string& object, const std::string& name, const std::string& value);

  /// `values` as rows of `columns` (1: a plain list), with its unit and description as attributes. `packed`: in
  /// single precision and compressed, for what is large and looked at.
  void array(const std::string& path, std::span<const double> values, std::size_t columns,
             const std::string& unit, const std::string& description = "", bool packed = false);

  /// The array `path` holds the places along the given axis (0: rows) of the arrays `along`: a dimension scale, by
  /// which netCDF readers (xarray) name the axis.
  void scale(const std::string& path, const std::vector<std::string>& along, unsigned axis = 0);

  /// An axis of `size` places without values of their own, for the arrays `along`: takes no room.
  void dimension(const std::string& path, std::size_t size, const std::vector<std::string>& along,
                 unsigned axis = 0);

  void close();

 private:
  std::int64_t open(const std::string& object);
  void check(std::int64_t status);

  std::filesystem::path path_;
  std::int64_t file_ = -1;
};

}  // namespace tremie::io
