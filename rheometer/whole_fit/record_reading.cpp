#include "rheometer/whole_fit/record_reading.hpp"

#include <cmath>
#include <stdexcept>

#include "rheometer/tables/number_text.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

DataTable data_table(const std::vector<std::filesystem::path>& data_folders, const char* folder,
                     const std::string& option) {
  for (const auto& data : data_folders) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(data / folder, error))
      if (entry.path().extension() == ".csv")
        return {read_text_file(entry.path().string()), entry.path().filename().string()};
  }
  throw RecordError(option + ": its table, reference_data/" + folder +
                    "/*.csv, is not there; allowed without it: " + option.substr(0, option.find(' ')) +
                    " none");
}

RecordReading reading_of(const FitOptions& o, const std::vector<std::filesystem::path>& data_folders) {
  RecordReading r;
  r.default_geometry = o.geometry.empty() && has_default_lengths(o);
  if (!o.geometry.empty()) {
    const DataTable table = data_table(data_folders, "geometries", "--geometry");
    r.geometry = geometry_of(o.geometry, table.text, table.name);
    if (!r.geometry.cylinders)
      r.options.stress_constant = r.geometry.stress_constant,
      r.options.strain_constant = r.geometry.strain_constant;
  }
  r.options.columns = o.column;
  r.options.decimal = o.decimal;
  if (!o.table.empty()) {
    const std::optional<double> number = parse_number(o.table);
    if (!number || !(*number >= 1.0 && *number <= 1e6) || std::floor(*number) != *number)
      throw std::invalid_argument("--table \"" + o.table + "\" is no number of a table, 1 or more");
    r.options.table = static_cast<std::size_t>(*number);
  }
  r.options.shear_first = r.default_geometry;
  r.options.torque_per_degree = o.torque_per_degree ? o.torque_per_degree : r.geometry.torque_per_degree;
  r.options.full_scale_torque = o.full_scale_torque;
  return r;
}

std::string geometry_words(const RecordReading& r, const FitOptions& o, bool sheared_evenly) {
  if (!r.geometry.words.empty() && (!sheared_evenly || r.options.stress_constant)) return r.geometry.words;
  if (sheared_evenly)
    return std::string(
               "none: shear rate and shear stress as the instrument converted them, which is trusted") +
           (r.default_geometry ? "" : "; the geometry that is given does not enter");
  return text_of("vane, radius %.6g mm, height %.6g mm, in a container of radius %.6g mm",
                 1e3 * o.vane_radius, 1e3 * o.vane_height, 1e3 * o.container_radius) +
         (r.default_geometry ? ": the default (ICAR), none is given" : "");
}

ReadRecord read_record(const std::string& file, const FitOptions& options,
                       const std::vector<std::filesystem::path>& data_folders) {
  const RecordReading reading = reading_of(options, data_folders);
  ReadRecord r;
  r.table =
      torque_table(read_text_file(file), file, options.torque_offset, reading.options, r.sheared_evenly);
  require_kinds(r.table, file);
  r.geometry = geometry_words(reading, options, r.sheared_evenly);
  if (r.table.position[q_time] != 0 && r.table.position[q_speed] != 0)
    r.sections = find_sections(protocol_of(r.table));
  return r;
}

}  // namespace tremie
