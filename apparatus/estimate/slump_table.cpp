#include "apparatus/estimate/slump_table.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <set>
#include <stdexcept>

#include "apparatus/scene/document.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/units.hpp"
#include "rheometer/tables/number_rows.hpp"

namespace tremie::estimate {
namespace {

/// Appends what is larger than all before it; false where `value` goes back to the first.
void add_node(std::vector<double>& nodes, double value) {
  if (nodes.empty() || value > nodes.back()) nodes.push_back(value);
}

struct Place {
  std::size_t i;
  double t;
};

Place place_in(const std::vector<double>& nodes, double value) {
  const auto above = std::upper_bound(nodes.begin(), nodes.end(), value);
  const auto last = static_cast<std::ptrdiff_t>(nodes.size()) - 2;
  const auto i = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(above - nodes.begin() - 1, 0, last));
  const double t = std::log(value / nodes[i]) / std::log(nodes[i + 1] / nodes[i]);
  return {i, std::clamp(t, 0.0, 1.0)};
}

constexpr const char* folder_of_tables = "slump_flow_table";

/// The moulds that have a table.
std::set<std::string> moulds_in(std::span<const std::filesystem::path> data_folders) {
  std::set<std::string> names;
  for (const auto& folder : data_folders) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder / folder_of_tables, error))
      if (entry.path().extension() == ".csv") names.insert(entry.path().stem().string());
  }
  return names;
}

/// A file of reference_data/cones.
Mould read_mould(const std::filesystem::path& file, const std::string& name) {
  const scene::Node document = scene::parse_file(file);
  const scene::Node* cone = scene::find(document, "cone");
  const auto length = [&](const char* key) {
    const scene::Node* node = cone ? scene::find(*cone, key) : nullptr;
    const auto* text = node ? std::get_if<std::string>(&node->value) : nullptr;
    if (!text) throw std::runtime_error(file.string() + ": no " + key);
    return scene::parse_quantity(*text, scene::Dimension::length);
  };
  const double top = length("top_radius"), bottom = length("bottom_radius"), height = length("height");
  return {name, 2.0 * bottom, height,
          std::numbers::pi * height / 3.0 * (top * top + top * bottom + bottom * bottom)};
}

}  // namespace

SlumpTable read_slump_table(const std::filesystem::path& file, const Mould& mould) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  SlumpTable table;
  table.mould = mould;
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  for (const auto& row :
       number_rows(text, file.string(), "yield_stress_Pa,plastic_viscosity_Pa_s,spread_mm,slump_mm,t500_s",
                   [](const auto& r) { return r[0] > 0.0 && r[1] > 0.0; })) {
    add_node(table.tau_0, row[0]);
    add_node(table.mu, row[1]);
    table.spread.push_back(1e-3 * row[2]);
    table.slump.push_back(1e-3 * row[3]);
    table.t500.push_back(row[4]);
  }
  if (table.tau_0.size() < 2 || table.mu.size() < 2 ||
      table.spread.size() != table.tau_0.size() * table.mu.size())
    throw std::runtime_error(file.string() + " is no full grid");
  return table;
}

SlumpTable find_slump_table(std::span<const std::filesystem::path> data_folders, const std::string& mould) {
  const auto moulds = moulds_in(data_folders);
  if (moulds.empty())
    throw std::runtime_error(
        "reference_data/slump_flow_table has no table ($TREMIE_DATA names the folder reference_data)");
  if (!moulds.contains(mould))
    throw scene::InputError(fmt::format(
        "cone: \"{}\" has no table; allowed: {}. A scene with any mould is met by tremie calibrate", mould,
        fmt::join(moulds, ", ")));
  for (const auto& folder : data_folders) {
    const auto file = folder / folder_of_tables / (mould + ".csv");
    std::error_code error;
    if (std::filesystem::is_regular_file(file, error))
      return read_slump_table(
          file, mould == Mould{}.name ? Mould{} : read_mould(folder / "cones" / (mould + ".toml"), mould));
  }
  throw std::runtime_error("the table of " + mould + " cannot be read");
}

SlumpTable at_density(SlumpTable table, double density) {
  for (auto* nodes : {&table.tau_0, &table.mu})
    for (double& node : *nodes) node *= density / table.density;
  table.density = density;
  return table;
}

TableReading interpolate(const SlumpTable& table, double tau_0, double mu, double density) {
  const double scale = table.density / density;
  const Place x = place_in(table.tau_0, tau_0 * scale), y = place_in(table.mu, mu * scale);
  const std::size_t n = table.mu.size(), at = x.i * n + y.i;
  const double w[] = {(1.0 - x.t) * (1.0 - y.t), (1.0 - x.t) * y.t, x.t * (1.0 - y.t), x.t * y.t};
  const std::size_t corner[] = {at, at + 1, at + n, at + n + 1};
  TableReading reading;
  double log_t500 = 0.0;
  for (int k = 0; k < 4; ++k) {
    if (w[k] == 0.0) continue;  // a node that counts for nothing may be not-a-number
    reading.spread += w[k] * table.spread[corner[k]];
    reading.slump += w[k] * table.slump[corner[k]];
    log_t500 += w[k] * std::log(table.t500[corner[k]]);
  }
  if (std::isfinite(log_t500)) reading.t500 = std::exp(log_t500);
  return reading;
}

}  // namespace tremie::estimate
