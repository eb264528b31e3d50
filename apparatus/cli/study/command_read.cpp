#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/program.hpp"
#include "apparatus/cli/study/command_fit.hpp"
#include "apparatus/report/fit_input.hpp"
#include "apparatus/scene/input_error.hpp"
#include "apparatus/scene/load.hpp"
#include "apparatus/scene/units.hpp"
#include "libmpm/io/write_error.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/whole_fit/record_reading.hpp"

namespace tremie::cli {
namespace {

struct Reading {
  std::string file, csv;
  std::vector<const FitOption*> options;
  std::vector<std::string> texts;  ///< of the options
};

/// The options of a fit that say how its record is read.
std::vector<const FitOption*> reading_options() {
  static const std::string_view names[] = {
      "vane_radius", "vane_height", "container_radius",  "torque_offset",    "geometry", "column",
      "decimal",     "table",       "torque_per_degree", "full_scale_torque"};
  std::vector<const FitOption*> options;
  for (const FitOption& option : fit_options())
    if (std::find(std::begin(names), std::end(names), option.name) != std::end(names))
      options.push_back(&option);
  return options;
}

ReadRecord read(const Reading& o) {
  FitOptions options;
  for (std::size_t i = 0; i < o.options.size(); ++i)
    if (!o.texts[i].empty())
      report::read_option(options, *o.options[i], report::command_name(*o.options[i]), o.texts[i]);
  try {
    check(options);
    return read_record(o.file, options, scene::data_folders());
  } catch (const RecordError& error) {
    throw scene::InputError(error.what());
  } catch (const std::invalid_argument& error) {
    throw scene::InputError(error.what());
  }
}

/// A column of the table in its place, what a unit of it is, and its key.
struct Shown {
  std::size_t column;
  double unit;
  std::string key;
};

std::vector<Shown> shown_columns(const ReadRecord& r) {
  const double rate = r.sheared_evenly ? evenly_sheared_speed : 1.0;
  const std::vector<Shown> all{{q_time, 1.0, "time_s"},
                               {q_speed, rate, r.sheared_evenly ? "shear_rate_per_s" : "speed_rad_per_s"},
                               {q_torque, 1.0, r.sheared_evenly ? "shear_stress_Pa" : "torque_N_m"}};
  std::vector<Shown> shown;
  for (const Shown& s : all)
    if (r.table.position[s.column] != 0) shown.push_back(s);
  return shown;
}

std::string row_text(const ReadRecord& r, std::size_t row) {
  std::string text;
  for (const Shown& s : shown_columns(r))
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", s.key,
                        scene::rounded(r.table.column[s.column][row] / s.unit, 6));
  return fmt::format("line {}: {}", r.table.line[row], text);
}

void print_rows(const ReadRecord& r, const std::string& name, std::size_t begin, std::size_t end) {
  fmt::print("{:<22} {} rows\n", name, end - begin);
  fmt::print("{:<22} {}\n{:<22} {}\n", "  first", row_text(r, begin), "  last", row_text(r, end - 1));
}

void print_record(const ReadRecord& r) {
  const std::vector<Shown> shown = shown_columns(r);
  fmt::print("{:<22} line {}\n", "header", r.table.header_line);
  for (const Shown& s : shown) {
    const std::size_t at = r.table.position[s.column];
    fmt::print("{:<22} column {} '{}'\n", s.key, at,
               at <= r.table.header.size() ? r.table.header[at - 1] : "");
  }
  for (const auto& note : r.table.understood) fmt::print("{:<22} {}\n", "read", note);
  fmt::print("{:<22} {}\n", "geometry", r.geometry);
  const auto& starts = r.table.starts;
  for (std::size_t i = 0; i < starts.size(); ++i)
    print_rows(r, fmt::format("table {}", i + 1), starts[i],
               i + 1 < starts.size() ? starts[i + 1] : r.table.line.size());
  for (std::size_t i = 0; i < r.sections.size(); ++i)
    print_rows(r, fmt::format("section {} {}", i + 1, name_of(r.sections[i].kind)), r.sections[i].begin,
               r.sections[i].end);
}

std::string csv_of(const ReadRecord& r) {
  const std::vector<Shown> shown = shown_columns(r);
  std::string text;
  for (const Shown& s : shown) text += (text.empty() ? "" : ",") + s.key;
  text += '\n';
  for (std::size_t i = 0; i < r.table.line.size(); ++i) {
    for (std::size_t k = 0; k < shown.size(); ++k)
      text += (k > 0 ? "," : "") + scene::write_number(r.table.column[shown[k].column][i] / shown[k].unit);
    text += '\n';
  }
  return text;
}

/// Replaces nothing: a file with the same columns may be the record of somebody else.
void write_rows(const std::filesystem::path& file, const std::string& rows) {
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (std::filesystem::is_directory(file))
    throw scene::InputError(fmt::format("--csv: {} is a folder; allowed: a file", file.string()));
  if (!std::filesystem::is_directory(folder))
    throw scene::InputError(fmt::format("--csv: there is no folder {}", folder.string()));
  std::ifstream there(file, std::ios::binary);
  if (there && std::string(std::istreambuf_iterator<char>(there), {}) != rows)
    throw scene::InputError(
        fmt::format("--csv: {} is there already, and holds something else: not replaced", file.string()));
  io::write_text(file, rows);
}

}  // namespace

void add_command_read(CLI::App& app, int& exit_code) {
  auto o = std::make_shared<Reading>();
  o->options = reading_options();
  o->texts.resize(o->options.size());
  Command command(app, read_command.name, read_command.description);
  command.required("file", o->file, "CSV or an instrument's export, as tremie fit takes it");
  for (std::size_t i = 0; i < o->options.size(); ++i) {
    const FitOption& option = *o->options[i];
    const std::string name = report::command_name(option);
    if (option.words.empty())
      command.option(name.c_str(), o->texts[i], option.help);
    else
      command.choice(name.c_str(), o->texts[i], option.words, option.help);
  }
  command.option("--csv", o->csv, "Write the rows in SI units to this file");
  command.example("tremie read torque.csv --csv torque_si.csv");
  command.run([o, &exit_code] {
    const ReadRecord record = read(*o);
    print_record(record);
    if (!o->csv.empty()) {
      write_rows(o->csv, csv_of(record));
      fmt::print("{:<22} {}\n", "written to", o->csv);
    }
    exit_code = 0;
  });
}

}  // namespace tremie::cli
