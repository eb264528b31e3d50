#include "rheometer/vane/geometries.hpp"

#include <cmath>
#include <stdexcept>
#include <vector>

#include "rheometer/tables/fields.hpp"
#include "rheometer/tables/number_text.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

constexpr double pi = std::numbers::pi;
constexpr const char* shapes =
    "\"cylinders, R_i, R_o, height\", \"cone_plate, radius, angle\", \"parallel_plates, radius, gap\", "
    "\"double_gap, "
    "R_1, R_2, R_3, R_4, height\", \"constants, Pa/(N.m), 1/s by rad/s\"";

[[noreturn]] void refuse(const std::string& text, const std::string& what) {
  throw std::invalid_argument("geometry \"" + text + "\": " + what);
}

/// A size [m], an angle [rad] or a constant, each greater than 0.
double size_of(const std::string& field, const char* kind, const std::string& text) {
  double value = 0.0;
  const std::size_t read = read_number(field, value);
  const std::string unit(detail::trimmed(std::string_view(field).substr(read)));
  const std::string_view wanted = kind;
  double factor = 0.0;
  if (wanted == "length") factor = unit == "mm" ? 1e-3 : unit == "cm" ? 1e-2 : unit == "m" ? 1.0 : 0.0;
  if (wanted == "angle") factor = unit == "deg" ? pi / 180.0 : unit == "rad" ? 1.0 : 0.0;
  if (wanted == "Pa/(N.m)" || wanted == "constant")
    factor = unit.empty() || unit == wanted || unit == "1/rad" ? 1.0 : 0.0;
  if (read == 0 || factor == 0.0 || !(value > 0.0) || !std::isfinite(value))
    refuse(text, "\"" + field + "\" is no " + kind + " greater than 0" +
                     (wanted == "length"  ? "; write it as \"25 mm\""
                      : wanted == "angle" ? "; write it as \"1 deg\""
                                          : ""));
  return value * factor;
}

std::vector<double> sizes_of(const std::vector<std::string>& fields, const std::vector<const char*>& kinds,
                             const std::string& text) {
  if (fields.size() != kinds.size() + 1)
    refuse(text, "takes " + std::to_string(kinds.size()) + " sizes behind its name, " +
                     std::to_string(fields.size() - 1) + " are given; allowed: " + shapes);
  std::vector<double> sizes;
  for (std::size_t i = 0; i < kinds.size(); ++i) sizes.push_back(size_of(fields[i + 1], kinds[i], text));
  return sizes;
}

Geometry cylinders(const std::vector<double>& s) {
  Geometry g;
  g.cylinders = Instrument{s[0], s[2], s[1]};
  check(*g.cylinders);
  g.words =
      text_of("cylinders, R_i %.6g mm, R_o %.6g mm, height %.6g mm", 1e3 * s[0], 1e3 * s[1], 1e3 * s[2]);
  return g;
}

Geometry cone_plate(const std::vector<double>& s) {
  Geometry g;
  g.words = text_of("cone and plate, radius %.6g mm, angle %.6g deg", 1e3 * s[0], s[1] * 180.0 / pi);
  g.stress_constant = 3.0 / (2.0 * pi * s[0] * s[0] * s[0]);
  g.strain_constant = 1.0 / std::tan(s[1]);
  return g;
}

Geometry parallel_plates(const std::vector<double>& s) {
  Geometry g;
  g.words =
      text_of("parallel plates, radius %.6g mm, gap %.6g mm; shear rate of the rim", 1e3 * s[0], 1e3 * s[1]);
  g.stress_constant = 3.0 / (2.0 * pi * s[0] * s[0] * s[0]);
  g.strain_constant = s[0] / s[1];
  g.plates = true;
  return g;
}

/// The mean stress on the two surfaces of the bob, and the rate that a Newtonian fluid has under it.
Geometry double_gap(const std::vector<double>& s, const std::string& text) {
  if (!(s[0] < s[1] && s[1] < s[2] && s[2] < s[3])) refuse(text, "the four radii must ascend");
  Geometry g;
  const auto inverse = [](double r) { return 1.0 / (r * r); };
  const double newtonian =
      4.0 * pi * s[4] * (1.0 / (inverse(s[0]) - inverse(s[1])) + 1.0 / (inverse(s[2]) - inverse(s[3])));
  g.words = text_of("double gap, radii %.6g, %.6g, %.6g and %.6g mm, height %.6g mm", 1e3 * s[0], 1e3 * s[1],
                    1e3 * s[2], 1e3 * s[3], 1e3 * s[4]);
  g.stress_constant = 1.0 / (2.0 * pi * s[4] * (s[1] * s[1] + s[2] * s[2]));
  g.strain_constant = newtonian * g.stress_constant;
  return g;
}

Geometry constants(const std::vector<double>& s) {
  Geometry g;
  g.words = text_of("the instrument's constants, %.6g Pa/(N.m) and %.6g 1/s by rad/s", s[0], s[1]);
  g.stress_constant = s[0];
  g.strain_constant = s[1];
  return g;
}

/// The geometry of a shape; empty words where the text begins with none.
Geometry of_shape(const std::string& text) {
  const auto fields = detail::fields_of(text, ',');
  const std::string& shape = fields.front();
  const auto sizes = [&](const std::vector<const char*>& kinds) { return sizes_of(fields, kinds, text); };
  if (shape == "cylinders") return cylinders(sizes({"length", "length", "length"}));
  if (shape == "cone_plate") return cone_plate(sizes({"length", "angle"}));
  if (shape == "parallel_plates") return parallel_plates(sizes({"length", "length"}));
  if (shape == "double_gap")
    return double_gap(sizes({"length", "length", "length", "length", "length"}), text);
  if (shape == "constants") return constants(sizes({"Pa/(N.m)", "constant"}));
  return {};
}

}  // namespace

Geometry geometry_of(const std::string& text, const std::string& table, const std::string& table_name) {
  if (Geometry g = of_shape(text); !g.words.empty()) return g;
  std::string names;
  for (const detail::TextLine& line : detail::lines_of(table)) {
    if (line.text.empty() || line.text.front() == '#' || line.text.starts_with("name,")) continue;
    const auto fields = detail::fields_of(line.text, ',');
    if (fields.size() != 4)
      throw std::invalid_argument(table_name + ":" + std::to_string(line.number) +
                                  ": expected name,shape,torque_per_degree,source");
    names += (names.empty() ? "" : ", ") + fields[0];
    if (fields[0] != text) continue;
    Geometry g = of_shape(fields[1]);
    g.words = fields[0] + ": " + g.words;
    g.torque_per_degree = parse_number(fields[2]);
    return g;
  }
  refuse(text, "is none of the names of " + table_name + " (" + names + ") and no shape; allowed: " + shapes);
}

}  // namespace tremie
