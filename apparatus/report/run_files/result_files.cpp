#include "apparatus/report/run_files/result_files.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <span>

#include "apparatus/report/picture.hpp"
#include "apparatus/report/run_files/chart.hpp"
#include "apparatus/report/run_files/glossary.hpp"
#include "apparatus/report/run_files/html.hpp"
#include "apparatus/report/run_files/moving.hpp"
#include "apparatus/report/summary.hpp"
#include "libmpm/io/vtp.hpp"
#include "libmpm/io/write_error.hpp"
#include "tremie_version.hpp"

namespace tremie::report {
namespace {

constexpr const char* computed_source = "computed by Tremie from the scene in the file's attribute \"scene\"";

struct Field {
  const char* name;
  int components;
  const char* unit;
  std::span<const double> values;
};

std::span<const double> flat(const std::vector<std::array<double, 3>>& vectors) {
  return {vectors.empty() ? nullptr : vectors.front().data(), 3 * vectors.size()};
}

/// The fields of a frame but for its positions; what a scene does not have is not written.
std::vector<Field> fields_of(const Frame& frame) {
  std::vector<Field> fields{{"velocity", 3, "m/s", flat(frame.velocity)},
                            {"volume", 1, "m^3", frame.volume},
                            {"pressure", 1, "Pa", frame.pressure},
                            {"shear_rate", 1, "1/s", frame.shear_rate},
                            {"flocculation", 1, "1", frame.flocculation},
                            {"age", 1, "s", frame.age},
                            {"load", 1, "1", frame.load}};
  std::erase_if(fields, [](const Field& field) { return field.values.empty(); });
  return fields;
}

void write_frame_h5(io::Hdf5File& h5, const std::string& group, const Frame& frame) {
  h5.group(group);
  h5.attribute(group, "time_s", frame.time);
  h5.array(group + "/position", flat(frame.position), 3, "m",
           "x, y, z of the points; a section of a body of revolution lies at y = 0, x its radius", true);
  std::vector<std::string> fields{group + "/position"}, vectors{group + "/position"};
  for (const Field& field : fields_of(frame)) {
    h5.array(group + "/" + field.name, field.values, static_cast<std::size_t>(field.components), field.unit,
             words_of(field.name), true);
    fields.push_back(group + "/" + field.name);
    if (field.components == 3) vectors.push_back(fields.back());
  }
  for (const auto& field : fields) h5.attribute(field, "source", std::string(computed_source));
  h5.dimension(group + "/point", frame.position.size(), fields);
  h5.dimension(group + "/component", 3, vectors, 1);
}

/// Columns of one length over the first of them.
void write_columns_h5(io::Hdf5File& h5, const std::string& group, const std::vector<scene::Column>& columns,
                      const std::string& apparatus) {
  h5.group(group);
  std::vector<std::string> along;
  for (const auto& column : columns) {
    const std::string path = group + "/" + column.name;
    h5.array(path, column.values, 1, unit_of(column.name), words_of(column.name, apparatus));
    h5.attribute(path, "source", std::string(computed_source));
    if (&column != &columns.front()) along.push_back(path);
  }
  if (!columns.empty() && !columns.front().values.empty())
    h5.scale(group + "/" + columns.front().name, along);
}

/// The errors of cells and steps, by the results' names, and how they were found.
void write_errors_h5(io::Hdf5File& h5, const scene::ErrorEstimate& error) {
  h5.group("/errors");
  h5.attribute("/errors", "description",
               std::string("half the width of a bar about a result, by cells and steps"));
  h5.attribute("/errors", "basis", error.basis);
  for (const auto& bar : error.bars) h5.attribute("/errors", bar.name, bar.error);
}

void write_frame_vtp(const std::filesystem::path& file, const Frame& frame) {
  std::vector<io::PointField> fields;
  for (const Field& field : fields_of(frame)) fields.push_back({field.name, field.components, field.values});
  io::write_vtp(file, frame.time, frame.position, fields);
}

void write_results(io::Hdf5File& h5, const std::string& group, const std::vector<scene::Result>& results) {
  h5.group(group);
  for (const auto& [name, value] : results) {
    if (std::holds_alternative<std::monostate>(value)) h5.attribute(group, name, std::nan(""));
    if (const auto* truth = std::get_if<bool>(&value)) h5.attribute(group, name, std::int64_t{*truth});
    if (const auto* number = std::get_if<double>(&value)) h5.attribute(group, name, *number);
    if (const auto* text = std::get_if<std::string>(&value)) h5.attribute(group, name, *text);
    if (const auto* below = std::get_if<std::vector<scene::Result>>(&value))
      write_results(h5, group + "/" + name, *below);
  }
}

/// So many points of a frame are written where a run chooses its frames by itself: 2 MB.
constexpr std::size_t most_points_written = 20'000;

/// Every k-th point of a frame, so that no more than most_points_written are left; 1 where all are.
std::size_t stride_of(const Frame& frame) {
  return std::max<std::size_t>(1, (frame.position.size() + most_points_written - 1) / most_points_written);
}

template <class T>
std::vector<T> strided(std::size_t stride, const std::vector<T>& all) {
  std::vector<T> some;
  for (std::size_t i = 0; i < all.size(); i += stride) some.push_back(all[i]);
  return some;
}

Frame thinned(const Frame& frame) {
  const std::size_t k = stride_of(frame);
  return {.time = frame.time,
          .position = strided(k, frame.position),
          .velocity = strided(k, frame.velocity),
          .volume = strided(k, frame.volume),
          .pressure = strided(k, frame.pressure),
          .shear_rate = strided(k, frame.shear_rate),
          .flocculation = strided(k, frame.flocculation),
          .age = strided(k, frame.age),
          .load = strided(k, frame.load)};
}

}  // namespace

FramesWritten frames_written(const scene::Output& output) {
  if (!output.frames) return FramesWritten::none;
  return output.frame_interval > 0.0 ? FramesWritten::all : FramesWritten::some;
}

ResultFiles::ResultFiles(const std::filesystem::path& folder, const std::string& resolved,
                         const std::string& command, FramesWritten written)
    : folder_(folder), resolved_(resolved), command_(command), written_(written), h5_(folder / "results.h5") {
  io::write_text(folder_ / "scene.toml", resolved_);
  h5_.attribute("/", "schema", std::int64_t{1});
  h5_.attribute("/", "tremie_version", std::string(version));
  h5_.attribute("/", "tremie_commit", std::string(commit));
  h5_.attribute("/", "compiler", std::string(compiler));
  h5_.attribute("/", "instructions", std::string(instructions));
  h5_.attribute("/", "scene", resolved_);
  h5_.group("/frames");
}

void ResultFiles::frame(const Frame& frame) {
  shown_.add(frame);
  if (written_ == FramesWritten::none) return;
  const std::size_t every = written_ == FramesWritten::all ? 1 : frame.position.size() > 20000 ? 3 : 2;
  last_.reset();
  const bool thin = written_ == FramesWritten::some && stride_of(frame) > 1;
  if (thin) stride_ = stride_of(frame);
  if (came_++ % every == 0)
    write_frame(thin ? thinned(frame) : frame);
  else
    last_ = thin ? thinned(frame) : frame;
}

void ResultFiles::write_frame(const Frame& frame) {
  if (!frames_.empty() && frames_.back().first == frame.time) return;  // the end may fall on a frame's time
  write_frame_h5(h5_, fmt::format("/frames/{:05}", frames_.size()), frame);
  std::error_code error;
  std::filesystem::create_directory(folder_ / "frames",
                                    error);  // and no folder above it, which others have removed
  if (error) io::fail_to_write(folder_ / "frames");
  frames_.emplace_back(frame.time, fmt::format("frames/frame_{:05}.vtp", frames_.size()));
  write_frame_vtp(folder_ / frames_.back().second, frame);
  io::write_pvd(folder_ / "frames.pvd", frames_);  // for who watches
}

void ResultFiles::write_results_h5(const scene::Outcome& outcome) {
  h5_.attribute("/", "apparatus", outcome.apparatus);
  h5_.attribute("/", "status", std::string(status_name(outcome.status)));
  write_columns_h5(h5_, "/series", outcome.series, outcome.apparatus);
  for (const auto& table : outcome.tables)
    write_columns_h5(h5_, fmt::format("/{}", std::filesystem::path(table.file).stem().string()),
                     table.columns, outcome.apparatus);
  if (outcome.error) write_errors_h5(h5_, *outcome.error);
  write_results(h5_, "/results", outcome.results);
  h5_.close();
}

std::vector<std::string> ResultFiles::finish(const scene::Outcome& outcome) {
  std::vector<std::string> notes;
  if (stride_ > 1)
    notes.push_back(
        fmt::format("the frames have one point of {}; all of them: output.frame_interval", stride_));
  if (last_) write_frame(*last_);
  write_results_h5(outcome);
  io::write_text(folder_ / "timeseries.csv", columns_csv(outcome.series));
  for (const auto& table : outcome.tables) io::write_text(folder_ / table.file, columns_csv(table.columns));
  draw_charts(outcome, folder_);
  if (!frames_.empty() && outcome.pictured)
    notes.push_back(draw_picture(outcome, folder_, frames_.back().second));
  io::write_text(folder_ / "report.html",
                 report_html(outcome, resolved_, moving_picture(outcome, shown_.frames()), command_));
  io::write_text(folder_ / "summary.json", summary_json(outcome));
  std::erase(notes, "");
  return notes;
}

}  // namespace tremie::report
