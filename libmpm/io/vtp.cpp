#include "libmpm/io/vtp.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "libmpm/io/write_error.hpp"

namespace tremie::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says LittleEndian");

/// Appends `bytes` in base64.
void append_base64(std::string_view bytes, std::string& text) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < n ? static_cast<std::uint8_t>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[group >> (18 - 6 * k) & 63u] : '=';
  }
}

/// The appended block: each array is its length in bytes (64 bit) and its bytes, in base64, which leaves the
/// file well-formed XML.
class Appended {
 public:
  /// Adds an array and returns its offset for the header.
  template <class T>
  std::size_t add(const std::vector<T>& values) {
    const std::size_t offset = text_.size();
    const std::uint64_t length = values.size() * sizeof(T);
    std::string bytes(reinterpret_cast<const char*>(&length), sizeof length);
    bytes.append(reinterpret_cast<const char*>(values.data()), length);
    append_base64(bytes, text_);
    return offset;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::vector<float> as_float(std::span<const double> values) {
  std::vector<float> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) result[i] = static_cast<float>(values[i]);
  return result;
}

void data_array(std::ostringstream& xml, const char* type, const std::string& name, int components,
                std::size_t offset) {
  xml << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
      << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
}

/// One vertex cell a point: without cells ParaView shows nothing.
void vertices(std::ostringstream& xml, Appended& appended, std::size_t n) {
  std::vector<std::int64_t> connectivity(n), offsets(n);
  std::iota(connectivity.begin(), connectivity.end(), std::int64_t{0});
  std::iota(offsets.begin(), offsets.end(), std::int64_t{1});
  xml << "<Verts>\n";
  data_array(xml, "Int64", "connectivity", 1, appended.add(connectivity));
  data_array(xml, "Int64", "offsets", 1, appended.add(offsets));
  xml << "</Verts>\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& file, double time, std::span<const std::array<double, 3>> points,
               std::span<const PointField> fields) {
  Appended appended;
  std::ostringstream xml;
  xml.precision(17);
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n"
      << "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" << time
      << "</DataArray>\n</FieldData>\n"
      << "<Piece NumberOfPoints=\"" << points.size() << "\" NumberOfVerts=\"" << points.size()
      << "\">\n<Points>\n";
  const std::span<const double> coordinates(points.empty() ? nullptr : points.front().data(),
                                            3 * points.size());
  data_array(xml, "Float32", "Points", 3, appended.add(as_float(coordinates)));
  xml << "</Points>\n";
  vertices(xml, appended, points.size());
  xml << "<PointData>\n";
  for (const PointField& field : fields) {
    if (field.values.size() != points.size() * static_cast<std::size_t>(field.components))
      throw std::invalid_argument("write_vtp: field " + field.name + " does not fit the points");
    data_array(xml, "Float32", field.name, field.components, appended.add(as_float(field.values)));
  }
  xml << "</PointData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"base64\">\n_";
  write_text(file, xml.str() + appended.text() + "\n</AppendedData>\n</VTKFile>\n");
}

void write_pvd(const std::filesystem::path& file, std::span<const std::pair<double, std::string>> frames) {
  std::ostringstream xml;
  xml.precision(17);
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n<Collection>\n";
  for (const auto& [time, name] : frames)
    xml << "<DataSet timestep=\"" << time << "\" file=\"" << name << "\"/>\n";
  xml << "</Collection>\n</VTKFile>\n";
  write_text(file, xml.str());
}

}  // namespace tremie::io
