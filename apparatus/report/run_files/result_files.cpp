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
                            {"flocculation", 1, "1", frame.flocculation}};
  std::erase_if(fields, [](const Field& field) { return field.values.empty(); });
  return fields;
}

void write_frame_h5(io::Hdf5File& h5, const std::string& group, const Frame& frame) {
  h5.group(group);
  h5.attribute(group, "time_s", frame.time);
  h5.array(group + "/position", flat(frame.position), 3, "m",
           "x, y, z of the points; a section of a body of revolution lies at y = 0, x its radius", true);
  for (const Field& field : fields_of(frame))
    h5.array(group + "/" + field.name, field.values, static_cast<std::size_t>(field.components), field.unit,
             words_of(field.name), true);
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
          .flocculation = strided(k, frame.flocculation)};
}

}  // namespace

ResultFiles::ResultFiles(const std::filesystem::path& folder, const std::string& resolved,
                         const std::string& command, FramesWritten written)
    : folder_(folder), resolved_(resolved), command_(command), written_(written), h5_(folder / "results.h5") {
  io::write_text(folder_ / "scene.toml", resolved_);
  h5_.attribute("/", "schema", std::int64_t{1});
  h5_.attribute("/", "tremie_version", std::string(version));
  h5_.attribute("/", "tremie_commit", std::string(commit));
  h5_.attribute("/", "compiler", std::string(compiler));
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
  std::filesystem::create_directories(folder_ / "frames");
  frames_.emplace_back(frame.time, fmt::format("frames/frame_{:05}.vtp", frames_.size()));
  write_frame_vtp(folder_ / frames_.back().second, frame);
}

void ResultFiles::write_results_h5(const scene::Outcome& outcome) {
  h5_.attribute("/", "apparatus", outcome.apparatus);
  h5_.attribute("/", "status", std::string(status_name(outcome.status)));
  h5_.group("/series");
  for (const auto& column : outcome.series)
    h5_.array("/series/" + column.name, column.values, 1, unit_of(column.name), words_of(column.name));
  for (const auto& table : outcome.tables) {
    const std::string group = fmt::format("/{}", std::filesystem::path(table.file).stem().string());
    h5_.group(group);
    for (const auto& column : table.columns)
      h5_.array(group + "/" + column.name, column.values, 1, unit_of(column.name), words_of(column.name));
  }
  write_results(h5_, "/results", outcome.results);
  h5_.close();
}

std::vector<std::string> ResultFiles::finish(const scene::Outcome& outcome) {
  std::vector<std::string> notes;
  if (stride_ > 1)
    notes.push_back(
        fmt::format("the frames have every {}th point; all of them: output.frame_interval", stride_));
  if (last_) write_frame(*last_);
  write_results_h5(outcome);
  io::write_text(folder_ / "timeseries.csv", columns_csv(outcome.series));
  for (const auto& table : outcome.tables) io::write_text(folder_ / table.file, columns_csv(table.columns));
  if (!frames_.empty()) io::write_pvd(folder_ / "frames.pvd", frames_);
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
