#include "rheometer/records/torque_record.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "libmpm/constitutive/constants.hpp"
#include "rheometer/records/sections.hpp"
#include "rheometer/tables/table.hpp"
#include "rheometer/tables/text.hpp"

namespace tremie {

namespace {

[[noreturn]] void fail_negative(const std::string& quantity, long line, std::size_t position,
                                const std::string& name) {
  throw RecordError(at_position(
      name, line, position,
      quantity + " is negative; give its magnitude, 0 or more" +
          (quantity == "the torque" ? ", or the offset of the unloaded instrument, --torque-offset" : "")));
}

void require_not_negative(const std::vector<double>& column, const NumberTable& table, std::size_t position,
                          const char* quantity, const std::string& name) {
  for (std::size_t i = 0; i < column.size(); ++i)
    if (column[i] < 0.0) fail_negative(quantity, table.line[i], position, name);
}

/// A wrong unit in the header shows as a size that no rheometer has.
void require_below(const std::vector<double>& column, const NumberTable& table, std::size_t position,
                   double most, const std::string& what, const std::string& name) {
  for (std::size_t i = 0; i < column.size(); ++i)
    if (column[i] > most)
      throw RecordError(at_position(name, table.line[i], position, what + "; is the header's unit right?"));
}

/// Readings that are all below what any rheometer resolves: their squares would be 0.
void require_above(const std::vector<double>& column, const NumberTable& table, std::size_t position,
                   double least, const std::string& what, const std::string& name) {
  double largest = 0.0;
  for (double x : column) largest = std::max(largest, std::abs(x));
  if (largest > 0.0 && largest < least)
    throw RecordError(
        at_position(name, table.line.front(), position, what + "; is the header's unit right?"));
}

bool is_flow_curve(const Section& s) {
  return s.kind == SectionKind::flow_curve_up || s.kind == SectionKind::flow_curve_down;
}

/// The first section that is a decay, at a constant rate rather than a start-up; else the first flow curve.
const Section* section_to_fit(const std::vector<Section>& sections) {
  const Section *decay = nullptr, *curve = nullptr;
  for (const Section& s : sections) {
    const bool shear = s.kind == SectionKind::constant_rate || s.kind == SectionKind::start_up;
    if (shear && s.end - s.begin >= 8 &&
        (!decay || (decay->kind == SectionKind::start_up && s.kind != decay->kind)))
      decay = &s;
    if (is_flow_curve(s) && !curve) curve = &s;
  }
  return decay ? decay : curve;
}

/// One section of a record with time and speed, as --protocol reads it.
TorqueRecord one_section(const NumberTable& table, const std::string& name, bool sheared_evenly) {
  ProtocolRecord record = protocol_of(table);
  record.sheared_evenly = sheared_evenly;
  const std::vector<Section> sections = find_sections(record);
  const Section* found = section_to_fit(sections);
  if (!found)
    throw RecordError(at_position(
        name, table.header_line, 1,
        "time, speed and torque, but no 8 rows of one speed (within 3 %) and no ramp or steps: neither a "
        "torque decay nor a flow curve; --protocol reads every section"));
  const bool curve = is_flow_curve(*found);
  TorqueRecord one = curve ? flow_curve_of(record, *found) : decay_of(record, *found);
  const double speed = sheared_evenly ? found->omega / evenly_sheared_speed : found->omega / two_pi;
  const char* unit = sheared_evenly ? " 1/s" : " rev/s";
  one.is_section = true;
  for (const Section& s : sections)
    if (!curve && is_flow_curve(s)) one.flow_curves.push_back(flow_curve_of(record, s));
  const std::size_t others = table.line.size() - (found->end - found->begin);
  one.understood = table.understood;
  one.understood.push_back(
      std::string(curve ? "first flow curve" : "first section of constant speed") + ": lines " +
      std::to_string(table.line[curve ? found->begin : peak_of(record, *found)]) + " to " +
      std::to_string(table.line[found->end - 1]) + ", " + (curve ? "up to " : "") + text_of("%.6g", speed) +
      unit +
      (others > 0 ? "; the other " + std::to_string(others) + " rows are not used (--protocol reads them all)"
                  : ""));
  if (!curve && peak_of(record, *found) > found->begin)
    one.understood.push_back("time: counted from the largest torque while the vane gathers speed, line " +
                             std::to_string(one.line.front()));
  return one;
}

/// "line 1 has 'a', 'b'".
std::string seen(const NumberTable& table) {
  std::string text = "line " + std::to_string(table.header_line) + " has ";
  for (std::size_t i = 0; i < table.header.size() && i < 12; ++i)
    text += (i > 0 ? ", '" : "'") + table.header[i].substr(0, 40) + "'";
  return text + (table.header.size() > 12 ? ", ..." : "");
}

/// Shear rates and stresses in the columns of speed and torque.
void take_shear(NumberTable& table) {
  for (double& rate : table.column[q_shear_rate]) rate *= evenly_sheared_speed;
  for (const auto& [to, from] : {std::pair(q_speed, q_shear_rate), std::pair(q_torque, q_shear_stress)}) {
    table.column[to].swap(table.column[from]);
    table.position[to] = table.position[from];
  }
}

/// Shear stress as viscosity times shear rate, where the table has no stress.
void stress_from_viscosity(NumberTable& table) {
  if (table.position[q_viscosity] == 0) return;
  table.column[q_shear_stress] = std::move(table.column[q_viscosity]);
  for (std::size_t i = 0; i < table.column[q_shear_stress].size(); ++i)
    table.column[q_shear_stress][i] *= table.column[q_shear_rate][i];
  std::swap(table.position[q_shear_stress], table.position[q_viscosity]);
  table.column[q_viscosity].clear();
  table.understood.push_back("no shear stress in the header: it is taken as viscosity times shear rate");
}

/// A time that falls at two of five rows, or three times by less than half, tells how long each reading took. It is no clock of
/// the test, which starts again from the beginning or not at all.
void drop_a_time_of_readings(NumberTable& table) {
  const bool has_rate = table.position[q_speed] != 0 || table.position[q_shear_rate] != 0;
  if (table.position[q_time] == 0 || !has_rate) return;
  const std::vector<double>& time = table.column[q_time];
  std::size_t falls = 0, pairs = 0, small = 0;
  for (std::size_t i = 1; i < time.size(); ++i) {
    if (std::binary_search(table.starts.begin(), table.starts.end(), i)) continue;
    ++pairs;
    falls += time[i] < time[i - 1];
    small += time[i] < time[i - 1] && time[i] > 0.5 * time[i - 1];
  }
  if (falls < 3 || (5 * falls < 2 * pairs && small < 3)) return;
  table.understood.push_back("column " + std::to_string(table.position[q_time]) +
                             " is no clock of the test: it falls at " + std::to_string(falls) + " of " +
                             std::to_string(pairs) + " rows; the rows are read without a time");
  table.column[q_time].clear();
  table.position[q_time] = 0;
}

/// The table behind the last one of a curve that goes on over several, as pages of one print do: the speeds of each lie beyond
/// those before.
std::size_t end_of_curve(const NumberTable& table, std::size_t first) {
  const std::vector<double>& x =
      table.position[q_speed] != 0 ? table.column[q_speed] : table.column[q_shear_rate];
  if (x.empty()) return first + 1;
  const auto range = [&](std::size_t from, std::size_t to) {
    const auto begin = x.begin() + static_cast<std::ptrdiff_t>(table.starts[from]),
               end = to < table.starts.size() ? x.begin() + static_cast<std::ptrdiff_t>(table.starts[to])
                                              : x.end();
    const auto [low, high] = std::minmax_element(begin, end);
    return std::pair(*low, *high);
  };
  std::size_t behind = first + 1;
  for (; behind < table.starts.size(); ++behind) {
    const auto before = range(first, behind), next = range(behind, behind + 1);
    const bool beyond = next.first >= before.second || next.second <= before.first;
    if (!beyond || !(next.second > next.first)) break;
  }
  return behind;
}

/// Keeps one of several tables, with those that go on with its curve.
void keep_table(NumberTable& table, std::size_t number, const std::string& name) {
  const std::size_t tables = table.starts.size();
  if (table.chosen) return;
  if (number == 0 && (tables < 2 || (table.position[q_time] != 0 && !table.grouped))) return;
  const std::size_t kept = std::max<std::size_t>(number, 1);
  if (kept > tables)
    throw RecordError(
        at_position(name, table.header_line, 1,
                    "--table " + std::to_string(kept) + ": the file has " + std::to_string(tables)));
  const std::size_t behind = number == 0 && !table.grouped ? end_of_curve(table, 0) : kept;
  const auto begin = static_cast<std::ptrdiff_t>(table.starts[kept - 1]),
             end = static_cast<std::ptrdiff_t>(behind < tables ? table.starts[behind] : table.line.size());
  const std::size_t rows = table.line.size();
  for (auto& column : table.column)
    if (!column.empty()) column = std::vector<double>(column.begin() + begin, column.begin() + end);
  table.line = std::vector<long>(table.line.begin() + begin, table.line.begin() + end);
  table.starts = {0};
  if (tables == 1) return;
  const bool several = behind > kept;
  std::string text = (several ? "tables 1 to " + std::to_string(behind) : "table " + std::to_string(kept)) +
                     " of " + std::to_string(tables) + ", lines " + std::to_string(table.line.front()) +
                     " to " + std::to_string(table.line.back());
  if (several) text += ": their speeds go on, so they are one curve";
  if (rows > table.line.size())
    text += "; the other " + std::to_string(rows - table.line.size()) +
            " rows are not used (--table reads another)";
  table.understood.push_back(text);
}

}  // namespace

void require_kinds(const NumberTable& table, const std::string& name) {
  const bool has_time = table.position[q_time] != 0, has_speed = table.position[q_speed] != 0;
  const std::string kinds =
      "; " + seen(table) +
      (table.of_oscillation ? "; a modulus is of an oscillation, and only a rotation is read" : "") +
      "; a flow curve has speed_rev_per_s,torque_N_m or shear_rate_per_s with shear_stress_Pa or "
      "viscosity_Pa_s, a torque decay time_s,torque_N_m; other columns are named by --column \"speed=1 "
      "[rpm]; "
      "torque=2 [mN m]\" or \"shear_rate=1 [1/s]; shear_stress=2 [Pa]\"";
  if (table.position[q_torque] == 0)
    throw RecordError(at_position(name, table.header_line, 1, "no torque column in the header" + kinds));
  if (!has_time && !has_speed)
    throw RecordError(at_position(name, table.header_line, 1, "neither a time nor a speed column" + kinds));
  if (table.line.empty()) throw RecordError(at_position(name, table.header_line, 1, "a header without rows"));
}

NumberTable torque_table(std::string_view text, const std::string& name, double torque_offset,
                         const ReadOptions& options, bool& sheared_evenly) {
  NumberTable table = parse_torque_table(text, name, options);
  stress_from_viscosity(table);
  drop_a_time_of_readings(table);
  keep_table(table, options.table, name);
  const bool shear = table.position[q_shear_stress] != 0 && table.position[q_torque] == 0;
  if (shear && torque_offset != 0.0)
    throw RecordError(at_position(name, table.header_line, table.position[q_shear_stress],
                                  "a torque offset needs the torque; the record has shear stresses"));
  if (!shear)
    for (double& torque : table.column[q_torque]) torque -= torque_offset;
  sheared_evenly = shear || options.stress_constant;
  if (shear) {
    take_shear(table);
  } else if (options.stress_constant) {
    for (double& torque : table.column[q_torque]) torque *= *options.stress_constant;
    for (double& speed : table.column[q_speed])
      speed *= options.strain_constant.value_or(1.0) * evenly_sheared_speed;
  }
  return table;
}

TorqueRecord parse_torque_record(std::string_view bytes, const std::string& name, double torque_offset,
                                 const ReadOptions& options) {
  bool sheared_evenly = false;
  NumberTable table = torque_table(bytes, name, torque_offset, options, sheared_evenly);
  require_kinds(table, name);
  const bool has_speed = table.position[q_speed] != 0, both = has_speed && table.position[q_time] != 0;
  const char* stress = sheared_evenly ? "the shear stress" : "the torque";
  if (has_speed && !both)
    require_not_negative(table.column[q_speed], table, table.position[q_speed],
                         sheared_evenly ? "the shear rate" : "the speed", name);
  const std::vector<double>& readings = table.column[q_torque];
  if (sheared_evenly) {
    require_below(readings, table, table.position[q_torque], 1e9, "the shear stress is above 1e9 Pa", name);
    require_above(readings, table, table.position[q_torque], 1e-9, "every shear stress is below 1e-9 Pa",
                  name);
  } else {
    require_above(readings, table, table.position[q_torque], 1e-12, "every torque is below 1e-12 N.m", name);
    require_below(readings, table, table.position[q_torque], 1e4, "the torque is above 10000 N.m", name);
    require_below(table.column[q_speed], table, table.position[q_speed], 1e3, "the speed is above 1000 rad/s",
                  name);
  }
  TorqueRecord record;
  if (both) {
    record = one_section(table, name, sheared_evenly);
    for (std::size_t i = 0; i < record.torque.size(); ++i)
      if (record.torque[i] < 0.0) fail_negative(stress, record.line[i], table.position[q_torque], name);
    return record;
  }
  require_not_negative(table.column[q_torque], table, table.position[q_torque], stress, name);
  for (std::size_t i = 1; !has_speed && i < table.line.size(); ++i)
    if (table.column[q_time][i] < table.column[q_time][i - 1])
      throw RecordError(at_position(name, table.line[i], table.position[q_time],
                                    "time runs backwards; the rows must ascend in time"));
  record.kind = has_speed ? RecordKind::flow_curve : RecordKind::torque_decay;
  record.sheared_evenly = sheared_evenly;
  record.understood = std::move(table.understood);
  record.time = std::move(table.column[q_time]);
  record.omega = std::move(table.column[q_speed]);
  record.torque = std::move(table.column[q_torque]);
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

TorqueRecord read_torque_record(const std::string& path, double torque_offset, const ReadOptions& options) {
  return parse_torque_record(read_text_file(path), path, torque_offset, options);
}

}  // namespace tremie
