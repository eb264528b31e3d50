#include "libmpm/io/vtp.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "libmpm/io/write_error.hpp"

namespace tremie::io {
namespace {

static_assert(std::endian::native == std::endian::little, "the header says LittleEndian");

/// Base64 of bytes that come in parts, straight into a stream.
class Base64 {
 public:
  explicit Base64(std::ostream& out) : out_(out) {}
  void add(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    for (std::size_t i = 0; i < size;) {
      if (n_ == 0 && i + 3 <= size) {
        put(bytes + i);
        i += 3;
      } else {
        held_[n_++] = bytes[i++];
        if (n_ == 3) put(held_.data()), n_ = 0;
      }
    }
  }
  /// Ends the text.
  void finish() {
    if (n_ > 0) {
      const std::size_t n = n_;
      while (n_ < 3) held_[n_++] = 0;
      put(held_.data());
      for (std::size_t k = n + 1; k < 4; ++k) text_[size_ - 4 + k] = '=';
    }
    flush();
  }

 private:
  static constexpr std::string_view digits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

  /// Three bytes.
  void put(const std::uint8_t* b) {
    if (size_ == text_.size()) flush();
    const std::uint32_t group = std::uint32_t{b[0]} << 16 | std::uint32_t{b[1]} << 8 | b[2];
    for (std::size_t k = 0; k < 4; ++k) text_[size_++] = digits[group >> (18 - 6 * k) & 63u];
  }
  void flush() {
    out_.write(text_.data(), static_cast<std::streamsize>(size_));
    size_ = 0;
  }

  std::ostream& out_;
  std::array<std::uint8_t, 3> held_{};
  std::array<char, 1 << 16> text_;  // a call of the system a piece
  std::size_t n_ = 0, size_ = 0;
};

/// An array of the appended block: its length in bytes (64 bit) and its bytes, in base64, which leaves the
/// file well-formed XML.
struct Array {
  std::size_t values, bytes_of_one;
  std::function<void(Base64&)> add;  ///< all of them

  std::uint64_t bytes() const { return values * bytes_of_one; }
  std::size_t characters() const { return (sizeof(std::uint64_t) + bytes() + 2) / 3 * 4; }
  void write(std::ostream& out) const {
    Base64 text(out);
    const std::uint64_t length = bytes();
    text.add(&length, sizeof length);
    add(text);
    text.finish();
  }
};

template <class T, class Value>
Array array_of(std::size_t n, Value value) {
  return {n, sizeof(T), [n, value](Base64& text) {
            std::array<T, 768> some;
            for (std::size_t first = 0; first < n; first += some.size()) {
              const std::size_t size = std::min(some.size(), n - first);
              for (std::size_t i = 0; i < size; ++i) some[i] = value(first + i);
              text.add(some.data(), size * sizeof(T));
            }
          }};
}
Array as_float(std::span<const double> values) {
  return array_of<float>(values.size(), [values](std::size_t i) { return static_cast<float>(values[i]); });
}

/// The file's head and, after it, its arrays one by one: none of them is held as text.
class Poly {
 public:
  std::ostringstream xml;

  void array(const char* type, const std::string& name, int components, Array values) {
    xml << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
        << "\" format=\"appended\" offset=\"" << offset_ << "\"/>\n";
    offset_ += values.characters();
    arrays_.push_back(std::move(values));
  }
  void write(const std::filesystem::path& file) const {
    errno = 0;
    std::ofstream stream(file, std::ios::binary);
    stream << xml.view() << '_';
    for (const Array& values : arrays_) values.write(stream);
    stream << "\n</AppendedData>\n</VTKFile>\n";
    stream.close();
    if (!stream) fail_to_write(file);
  }

 private:
  std::vector<Array> arrays_;
  std::size_t offset_ = 0;
};

/// One cell that has all points as its vertices: without cells ParaView shows nothing.
void vertices(Poly& poly, std::size_t n) {
  using Number = std::int32_t;
  poly.xml << "<Verts>\n";
  poly.array("Int32", "connectivity", 1,
             array_of<Number>(n, [](std::size_t i) { return static_cast<Number>(i); }));
  poly.array("Int32", "offsets", 1,
             array_of<Number>(n > 0 ? 1 : 0, [n](std::size_t) { return static_cast<Number>(n); }));
  poly.xml << "</Verts>\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& file, double time, std::span<const std::array<double, 3>> points,
               std::span<const PointField> fields) {
  Poly poly;
  std::ostringstream& xml = poly.xml;
  xml.precision(17);
  xml << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<FieldData>\n"
      << "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">" << time
      << "</DataArray>\n</FieldData>\n"
      << "<Piece NumberOfPoints=\"" << points.size() << "\" NumberOfVerts=\"" << (points.empty() ? 0 : 1)
      << "\">\n<Points>\n";
  const std::span<const double> coordinates(points.empty() ? nullptr : points.front().data(),
                                            3 * points.size());
  poly.array("Float32", "Points", 3, as_float(coordinates));
  xml << "</Points>\n";
  vertices(poly, points.size());
  xml << "<PointData>\n";
  for (const PointField& field : fields) {
    if (field.values.size() != points.size() * static_cast<std::size_t>(field.components))
      throw std::invalid_argument("write_vtp: field " + field.name + " does not fit the points");
    poly.array("Float32", field.name, field.components, as_float(field.values));
  }
  xml << "</PointData>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"base64\">\n";
  poly.write(file);
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
