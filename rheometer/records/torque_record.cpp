#include "rheometer/records/torque_record.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/records/instrument_export.hpp"
#include "rheometer/records/sections.hpp"
#include "rheometer/records/table.hpp"

namespace tremie {

const std::vector<ColumnQuantity>& torque_quantities() {
  static const std::vector<ColumnQuantity> all{
      {"time",
       {{"s", 1.0}, {"sec", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}},
       "time_s, time_ms, time_min or time_h"},
      {"speed",
       {{"rev/s", two_pi},
        {"rps", two_pi},
        {"1/s", two_pi},
        {"hz", two_pi},
        {"rpm", two_pi / 60.0},
        {"rev/min", two_pi / 60.0},
        {"1/min", two_pi / 60.0},
        {"u/min", two_pi / 60.0},
        {"rad/s", 1.0},
        {"deg/s", two_pi / 360.0}},
       "speed_rev_per_s, speed_rpm, speed_rad_per_s or speed_deg_per_s"},
      {"torque",
       {{"nm", 1.0}, {"mnm", 1e-3}, {"knm", 1e3}, {"nmm", 1e-3}, {"ncm", 1e-2}, {"unm", 1e-6}},
       "torque_N_m, torque_mN_m, torque_N_cm or torque_N_mm"}};
  return all;
}

namespace {

void require_not_negative(const std::vector<double>& column, const NumberTable& table, std::size_t position,
                          const char* quantity, const std::string& name) {
  for (std::size_t i = 0; i < column.size(); ++i)
    if (column[i] < 0.0)
      throw RecordError(at_position(name, table.line[i], position,
                                    std::string(quantity) + " is negative; give its magnitude, 0 or more" +
                                        (quantity == std::string_view("the torque")
                                             ? ", or the offset of the unloaded instrument, --torque-offset"
                                             : "")));
}

/// A wrong unit in the header shows as a size that no rheometer has.
void require_below(const std::vector<double>& column, const NumberTable& table, std::size_t position,
                   double most, const std::string& what, const std::string& name) {
  for (std::size_t i = 0; i < column.size(); ++i)
    if (column[i] > most)
      throw RecordError(at_position(name, table.line[i], position, what + "; is the header's unit right?"));
}

/// The row at which the material begins to break down: the largest torque of the rows in which the vane gathers speed.
std::size_t first_row(const ProtocolRecord& r, const Section& s) {
  std::size_t first = s.begin;
  for (std::size_t i = s.begin + 1; i < s.end; ++i) {
    if (r.torque[i] > r.torque[first]) first = i;
    if (r.omega[i] > 0.97 * s.omega) break;
  }
  return first;
}

/// Keeps the shear at a constant rate as a torque decay, the rows in which the vane gathers speed with it.
double keep_decay(NumberTable& table, const std::string& name, std::vector<std::string>& understood) {
  ProtocolRecord record = protocol_of(table);
  const std::vector<Section> sections = find_sections(record);
  const Section* found = nullptr;
  for (const Section& s : sections) {
    const bool shear = s.kind == SectionKind::constant_rate || s.kind == SectionKind::start_up;
    if (shear && s.end - s.begin >= 8 &&
        (!found || (found->kind == SectionKind::start_up && s.kind != found->kind)))
      found = &s;
  }
  if (!found)
    throw RecordError(
        at_position(name, table.header_line, 1,
                    "time, speed and torque, but no 8 rows of one speed (within 3 %): no torque decay; for "
                    "a flow curve leave the time column out, or give --protocol"));
  const std::size_t begin = first_row(record, *found);
  understood.push_back("first section of constant speed: lines " + std::to_string(table.line[begin]) +
                       " to " + std::to_string(table.line[found->end - 1]) + ", " +
                       std::to_string(found->omega / two_pi) + " rev/s; the other " +
                       std::to_string(table.line.size() - (found->end - begin)) +
                       " rows are not used (--protocol reads them all)");
  const auto cut = [&](auto& v) {
    v = {v.begin() + static_cast<std::ptrdiff_t>(begin), v.begin() + static_cast<std::ptrdiff_t>(found->end)};
  };
  table.column[0] = record.time;
  if (begin > found->begin) {  // the breakdown starts here; else the shear starts with the section
    understood.push_back("time: counted from the largest torque while the vane gathers speed, line " +
                         std::to_string(table.line[begin]));
    for (double& t : table.column[0]) t -= record.time[begin];
  }
  for (auto& column : table.column) cut(column);
  cut(table.line);
  table.column[1].clear();
  table.position[1] = 0;
  return found->omega;
}

}  // namespace

TorqueRecord parse_torque_record(std::string_view bytes, const std::string& name, double torque_offset) {
  const std::string text = decoded_text(bytes, name);
  const auto plain = plain_export(text, name);
  NumberTable table = parse_number_table(plain ? plain->text : text, name, torque_quantities());
  for (double& torque : table.column[2]) torque -= torque_offset;
  TorqueRecord record;
  if (plain) record.understood = plain->understood;
  if (plain && table.position[0] != 0 && table.position[1] != 0 && !table.line.empty())
    record.speed = keep_decay(table, name, record.understood);
  const bool has_time = table.position[0] != 0, has_speed = table.position[1] != 0;
  const std::string kinds = "a flow curve has speed_rev_per_s,torque_N_m, a torque decay time_s,torque_N_m";
  if (table.position[2] == 0)
    throw RecordError(at_position(name, table.header_line, 1, "no torque column in the header; " + kinds));
  if (has_time == has_speed)
    throw RecordError(at_position(
        name, 1, 1,
        std::string(has_time ? "both a time and a speed column" : "neither a time nor a speed column") +
            "; " + kinds));
  if (table.line.empty()) throw RecordError(at_position(name, table.header_line, 1, "a header without rows"));

  record.kind = has_time ? RecordKind::torque_decay : RecordKind::flow_curve;
  require_not_negative(table.column[2], table, table.position[2], "the torque", name);
  if (has_speed) require_not_negative(table.column[1], table, table.position[1], "the speed", name);
  require_below(table.column[2], table, table.position[2], 1e4, "the torque is above 10000 N.m", name);
  require_below(table.column[1], table, table.position[1], 1e3, "the speed is above 1000 rad/s", name);
  for (std::size_t i = 1; has_time && i < table.line.size(); ++i)
    if (table.column[0][i] < table.column[0][i - 1])
      throw RecordError(at_position(name, table.line[i], table.position[0],
                                    "time runs backwards; the rows must ascend in time"));
  record.time = std::move(table.column[0]);
  record.omega = std::move(table.column[1]);
  record.torque = std::move(table.column[2]);
  record.line = std::move(table.line);
  return record;
}

std::string read_text_file(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw RecordError(path + ": is a directory, not a file");
  std::ifstream file(path, std::ios::binary);
  if (!file) throw RecordError(path + ": cannot be opened");
  std::string text(std::istreambuf_iterator<char>(file), {});
  if (file.bad()) throw RecordError(path + ": cannot be read");
  return text;
}

TorqueRecord read_torque_record(const std::string& path, double torque_offset) {
  return parse_torque_record(read_text_file(path), path, torque_offset);
}

}  // namespace tremie
