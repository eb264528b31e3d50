// What a run leaves in its folder, from an outcome made by hand.

#include <gtest/gtest.h>
#include <hdf5.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "apparatus/report/page/page.hpp"
#include "apparatus/report/run_files/chart.hpp"
#include "apparatus/report/run_files/html.hpp"
#include "apparatus/report/run_files/moving.hpp"
#include "apparatus/report/run_files/result_files.hpp"
#include "apparatus/report/run_folder.hpp"
#include "apparatus/report/summary.hpp"
#include "apparatus/scene/input_error.hpp"
#include "libmpm/io/vtp.hpp"
#include "libmpm/io/write_error.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

scene::Outcome small_outcome() {
  scene::Outcome outcome;
  outcome.apparatus = "slump_flow";
  outcome.results = {{"spread_mm", 556.0},
                     {"t500_s", scene::number(std::nullopt)},
                     {"class_en12350_8", std::string("SF1")},
                     {"height_mm", scene::number(nan)},
                     {"below", std::vector<scene::Result>{{"value", 1.5}}}};
  outcome.checks.volume_change = -3e-4;
  outcome.checks.reasons = {"a \"reason\""};
  outcome.cost.steps = 300;
  outcome.series = {
      {"time_s", {0.0, 0.1}}, {"spread_mm", {200.0, 0.1 + 0.2}}, {"flocculation_mean", {nan, 5.0}}};
  outcome.charts = {
      {"spread.svg", "Spread", "t / s", "spread / mm", {"spread_mm"}, {{"measured", 590.0, 30.0}}}};
  return outcome;
}

Frame small_frame(double time) {
  Frame frame;
  frame.time = time;
  frame.position = {{0.1, 0.0, 0.2}, {0.3, 0.0, 0.4}};
  frame.velocity = {{1, 0, 0}, {0, 0, -1}};
  frame.volume = {1e-6, 2e-6};
  frame.pressure = {100.0, 200.0};
  frame.shear_rate = {0.5, 0.25};
  return frame;
}

TEST(Summary, HasTheDocumentedKeys) {
  const auto json = nlohmann::json::parse(summary_json(small_outcome()));
  EXPECT_EQ(json["schema"], 1);
  EXPECT_EQ(json["apparatus"], "slump_flow");
  EXPECT_EQ(json["status"], "completed");
  for (const char* key : {"version", "commit", "compiler", "instructions"})
    EXPECT_TRUE(json["tremie"].contains(key)) << key;
  EXPECT_EQ(json["results"]["spread_mm"], 556.0);
  EXPECT_TRUE(json["results"]["t500_s"].is_null());
  EXPECT_TRUE(json["results"]["height_mm"].is_null());
  EXPECT_EQ(json["results"]["below"]["value"], 1.5);
  for (const char* key : {"volume_change", "mass_error", "unconverged_steps", "points_lost",
                          "max_speed_end_m_per_s", "stability_limit_exceeded", "reasons"})
    EXPECT_TRUE(json["checks"].contains(key)) << key;
  EXPECT_EQ(json["checks"]["reasons"][0], "a \"reason\"");
  for (const char* key : {"wall_s", "cpu_s", "steps", "points", "cells_active", "bytes_per_point",
                          "peak_rss_bytes", "threads", "simulated_s"})
    EXPECT_TRUE(json["cost"].contains(key)) << key;
}

TEST(Timeseries, UnitsInTheHeaderAndEmptyFields) {
  EXPECT_EQ(columns_csv(small_outcome().series),
            "time_s,spread_mm,flocculation_mean\n0,200,\n0.1,0.30000000000000004,5\n");
}

std::string results_h5(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  ResultFiles files(folder, "schema = 1\n");
  files.frame(small_frame(0.0));
  files.frame(small_frame(0.5));
  scene::Outcome outcome = small_outcome();
  outcome.charts.clear();
  files.finish(outcome);
  return test::read_file(folder / "results.h5");
}

TEST(ResultsH5, TheSameRunMakesTheSameBytes) {
  const test::TemporaryFolder folder;
  const std::string first = results_h5(folder / "a");
  EXPECT_GT(first.size(), 1000U);
  EXPECT_TRUE(first == results_h5(folder / "b"));
}

std::vector<double> read_array(hid_t file, const char* path) {
  const hid_t data = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(data);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Sclose(space);
  H5Dclose(data);
  return values;
}

TEST(ResultsH5, HoldsSeriesFramesAndProvenance) {
  const test::TemporaryFolder folder;
  results_h5(folder / "a");
  const hid_t file = H5Fopen((folder / "a" / "results.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  EXPECT_EQ(read_array(file, "/series/spread_mm"), (std::vector{200.0, 0.1 + 0.2}));
  // Frames are kept in single precision: half of its last digit is 6e-8 of the value.
  const std::vector<double> position = read_array(file, "/frames/00001/position");
  EXPECT_EQ(position, (std::vector<double>{0.1F, 0.0F, 0.2F, 0.3F, 0.0F, 0.4F}));
  EXPECT_EQ(H5Lexists(file, "/frames/00001/flocculation", H5P_DEFAULT), 0);  // not stored, not written
  for (const char* name : {"schema", "tremie_version", "tremie_commit", "compiler", "instructions", "scene",
                           "apparatus", "status"})
    EXPECT_GT(H5Aexists(file, name), 0) << name;
  // netCDF readers find their axes by these: the time of a series, the points of a frame.
  for (const char* axis : {"/series/time_s", "/frames/00001/point", "/frames/00001/component"})
    EXPECT_GT(H5Aexists_by_name(file, axis, "CLASS", H5P_DEFAULT), 0) << axis;
  for (const char* data : {"/series/spread_mm", "/frames/00001/position"})
    for (const char* about : {"DIMENSION_LIST", "unit", "description", "source"})
      EXPECT_GT(H5Aexists_by_name(file, data, about, H5P_DEFAULT), 0) << data << ": " << about;
  H5Fclose(file);
}

TEST(ResultFiles, WritesEverything) {
  const test::TemporaryFolder folder;
  results_h5(folder / "a");
  for (const char* name : {"scene.toml", "summary.json", "timeseries.csv", "results.h5", "frames.pvd",
                           "frames/frame_00000.vtp", "frames/frame_00001.vtp", "report.html"})
    EXPECT_TRUE(std::filesystem::exists(folder / "a" / name)) << name;
  const std::string pvd = test::read_file(folder / "a" / "frames.pvd");
  EXPECT_NE(pvd.find("timestep=\"0.5\" file=\"frames/frame_00001.vtp\""), std::string::npos);
}

// 1000 frames of 5000 points in three dimensions, 50 x 10 x 10: 120 frames at most, the first and the last among them,
// times in order, and of the ten points behind each other the one in the section y = 0.
TEST(ShownFrames, AreBoundedAndKeepTheEnds) {
  ShownFrames shown;
  Frame frame;
  for (int p = 0; p < 5000; ++p)
    frame.position.push_back({1e-3 * (p % 50), 1e-3 * (p / 50 % 10), 1e-3 * (p / 500)});
  frame.shear_rate.assign(5000, 2.0);
  for (int i = 0; i < 1000; ++i) {
    frame.time = i;
    shown.add(frame);
    ASSERT_LE(shown.frames().size(), ShownFrames::most_frames);
    ASSERT_EQ(shown.frames().front().time, 0.0);
    ASSERT_EQ(shown.frames().back().time, i);
  }
  EXPECT_GT(shown.frames().size(), ShownFrames::most_frames / 3);
  for (std::size_t i = 1; i < shown.frames().size(); ++i)
    EXPECT_GT(shown.frames()[i].time, shown.frames()[i - 1].time);
  const Frame& last = shown.frames().back();
  EXPECT_EQ(last.position.size(), 500U);
  EXPECT_EQ(last.shear_rate.size(), 500U);
  for (const auto& p : last.position) EXPECT_EQ(p[1], 0.0);
}

// A section of 112 columns of 544 points, 1.25 mm apart, seeded column by column. Every 21st point, the least stride that leaves
// 3000, lies on lines 12 mm apart and leaves 75 of the squares of 9 mm empty; of those that are shown, each holds one. Half of
// the area of such a square is that of one point of 3000.
TEST(ShownFrames, PointsThatAreLeftOutOpenNoGaps) {
  constexpr int columns = 112, rows = 544, across = 15, up = 75;
  constexpr double apart = 1.25e-3, square = 9e-3;
  Frame frame;
  for (int i = 0; i < columns; ++i)
    for (int j = 0; j < rows; ++j) frame.position.push_back({(i + 0.5) * apart, (j + 0.5) * apart, 0.0});
  ShownFrames shown;
  shown.add(frame);
  const Frame& thin = shown.frames().front();
  EXPECT_LE(thin.position.size(), ShownFrames::most_points);
  EXPECT_GE(thin.position.size(), ShownFrames::most_points / 2);
  std::vector<int> held(static_cast<std::size_t>(across * up), 0);
  for (const auto& x : thin.position) {
    const int i = static_cast<int>(x[0] / square), j = static_cast<int>(x[1] / square);
    if (i < across && j < up) held[static_cast<std::size_t>(i * up + j)] = 1;
  }
  for (const int h : held) EXPECT_EQ(h, 1);
}

// Of six frames every second is written, and the last: 0, 2, 4 and 5 s.
TEST(ResultFiles, SomeFramesAreEverySecondAndTheLast) {
  const test::TemporaryFolder folder;
  ResultFiles files(folder.path(), "schema = 1\n", "", FramesWritten::some);
  for (const double t : {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}) files.frame(small_frame(t));
  scene::Outcome outcome = small_outcome();
  outcome.charts.clear();
  files.finish(outcome);
  const std::string pvd = test::read_file(folder / "frames.pvd");
  for (const char* time : {"\"0\"", "\"2\"", "\"4\"", "\"5\""})
    EXPECT_NE(pvd.find(std::string("timestep=") + time), std::string::npos) << time;
  for (const char* time : {"\"1\"", "\"3\""})
    EXPECT_EQ(pvd.find(std::string("timestep=") + time), std::string::npos) << time;
}

TEST(Vtp, RefusesAFieldThatDoesNotFit) {
  const test::TemporaryFolder folder;
  const std::vector<std::array<double, 3>> points{{0, 0, 0}};
  const std::vector<double> two{1, 2};
  const std::vector<io::PointField> fields{{"x", 1, two}};
  EXPECT_THROW(io::write_vtp(folder / "a.vtp", 0.0, points, fields), std::invalid_argument);
}

// Three coordinates are 12 bytes, with their length of 8 before them 20, in base64 28 characters. By hand:
// 0c 00 .. 00, then 1.0f, 2.0f and 3.0f, 00 00 80 3f 00 00 00 40 00 00 40 40.
TEST(Vtp, IsWellFormedAndHoldsItsArrays) {
  const test::TemporaryFolder folder;
  const std::vector<std::array<double, 3>> points{{1, 2, 3}};
  io::write_vtp(folder / "a.vtp", 0.0, points, {});
  const std::string text = test::read_file(folder / "a.vtp");
  const std::size_t block = text.find("<AppendedData encoding=\"base64\">\n_");
  ASSERT_NE(block, std::string::npos);
  EXPECT_EQ(text.substr(text.find('_', block) + 1, 28), "DAAAAAAAAAAAAIA/AAAAQAAAQEA=");
  EXPECT_NE(text.find("Name=\"connectivity\" NumberOfComponents=\"1\" format=\"appended\" offset=\"28\""),
            std::string::npos);
  for (const char c : text) ASSERT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << "no text: " << int{c};
}

TEST(Chart, ShowsWhatWasMeasuredAndTheErrorBar) {
  auto outcome = small_outcome();
  outcome.error = scene::ErrorEstimate{{{"spread_mm", 8.0}}, "", 0.0};
  const LineChart chart = line_chart(outcome.charts.front(), outcome);
  ASSERT_EQ(chart.levels.size(), 1U);
  EXPECT_EQ(chart.levels.front().tolerance, 30.0);
  ASSERT_EQ(chart.bars.size(), 1U);
  EXPECT_EQ(chart.bars.front().half, 8.0);
  EXPECT_NE(chart_svg(chart).find("measured, 590 ± 30"), std::string::npos);
}

TEST(Chart, DrawsFromATableWithALabelACurve) {
  scene::Outcome outcome = small_outcome();
  outcome.tables = {
      {"profile.csv", {{"radius_mm", {63.5, 143.0}}, {"a_mm", {1.0, 2.0}}, {"b_mm", {3.0, 4.0}}}}};
  outcome.charts = {
      {"profile.svg", "Profile", "r", "y", {"a_mm", "b_mm"}, {}, {"the one", "the other"}, "profile.csv"}};
  const LineChart chart = line_chart(outcome.charts.front(), outcome);
  ASSERT_EQ(chart.curves.size(), 2U);
  EXPECT_EQ(chart.curves[1].label, "the other");
  EXPECT_EQ(chart.curves[1].x, (std::vector{63.5, 143.0}));
  EXPECT_EQ(chart.curves[1].y, (std::vector{3.0, 4.0}));
}

TEST(Chart, OneThatHasNothingToDrawIsLeftOut) {
  const test::TemporaryFolder folder;
  scene::Outcome outcome = small_outcome();
  outcome.charts = {{"empty.svg", "Empty", "t", "y", {"flocculation_mean"}, {}},
                    {"none.svg", "None", "t", "y", {"a_mm"}, {}, {}, "none.csv"}};
  draw_charts(outcome, folder.path());
  EXPECT_FALSE(std::filesystem::exists(folder / "empty.svg"));
}

TEST(Page, EscapesAllText) {
  Page page;
  page.headline = "<script>alert('a & \"b\"')</script>";
  page.numbers = {{"<b>", {{"<i>", "1", "<u>", "<k>"}}}};
  const std::string html = to_html(page);
  for (const char* raw : {"<script>", "<b>", "<i>", "<u>", "<k>"})
    EXPECT_EQ(html.find(raw), std::string::npos) << raw;
  EXPECT_NE(html.find("&lt;script&gt;alert(&#39;a &amp; &quot;b&quot;&#39;)"), std::string::npos);
  EXPECT_NE(html.find("name=\"viewport\""), std::string::npos);
}

TEST(Measured, ADifferenceBeyondTheToleranceIsSaid) {
  scene::Outcome outcome = small_outcome();
  outcome.measured = scene::Measurement{"spread_mm", "spread", "mm", 590.0, 30.0, -34.0};
  EXPECT_EQ(measured_line(outcome),
            "Differs from the measured 590 ± 30 mm: 34 mm below, 1.1 times the tolerance.");
  outcome.measured->difference = -20.0;
  EXPECT_EQ(measured_line(outcome), "Agrees with the measured 590 ± 30 mm: 20 mm below.");
  outcome.moving_at_end = true;  // it may still reach it
  EXPECT_EQ(measured_line(outcome),
            "Still moving at the end, so no verdict; so far 20 mm below the measured 590 ± 30 mm.");
  outcome.measured->on = "Mix A";
  EXPECT_EQ(measured_line(outcome),
            "Not measured on this concrete; 20 mm below the measured 590 ± 30 mm of Mix A.");
}

// A result that is null has its apparatus' words in the page; volumes are in litres; an interrupted run's are so far.
TEST(Page, SaysWhyThereIsNoResult) {
  scene::Outcome outcome = small_outcome();
  outcome.results.push_back({"volume_in_channel_m3", 0.01});
  outcome.none = {{"t500_s", "never reached"}};
  outcome.answers = {{"spread_mm", "", 0}};
  outcome.status = Status::interrupted, outcome.moving_at_end = true, outcome.cost.simulated = 1.2;
  const std::string html = report_html(outcome, "", {}, "");
  EXPECT_NE(html.find("never reached"), std::string::npos);
  EXPECT_NE(html.find("10&nbsp;l"), std::string::npos);
  EXPECT_NE(html.find("556 mm so far, interrupted at 1.20 s"), std::string::npos);
  EXPECT_EQ(html.find("time of the test was over"), std::string::npos);
}

TEST(ResultFiles, WritesTables) {
  const test::TemporaryFolder folder;
  scene::Outcome outcome = small_outcome();
  outcome.charts.clear();
  outcome.tables = {{"profile.csv", {{"radius_mm", {63.5}}, {"flocculation", {nan}}}}};
  ResultFiles files(folder.path(), "schema = 1\n");
  files.finish(outcome);
  EXPECT_EQ(test::read_file(folder / "profile.csv"), "radius_mm,flocculation\n63.5,\n");
}

TEST(WriteText, SaysWhichFileAndWhy) {
  try {
    io::write_text("/dev/full", std::string(1 << 20, 'x'));
    FAIL() << "nothing thrown";
  } catch (const io::WriteError& error) {
    EXPECT_NE(std::string(error.what()).find("/dev/full: cannot be written: the disk is full"),
              std::string::npos)
        << error.what();
  }
}

TEST(RunFolder, AppearsWholeOrNotAtAll) {
  const test::TemporaryFolder folder;
  {
    const RunFolder run(folder / "deep/er/run", false);
    io::write_text(run.staging() / "summary.json", "{}");
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  {
    RunFolder run(folder / "deep/er/run", false);
    io::write_text(run.staging() / "summary.json", "{}");
    io::write_text(run.staging() / "scene.toml", "");
    EXPECT_FALSE(std::filesystem::exists(folder / "deep/er/run"));
    run.publish();
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "deep/er/run/summary.json"));
}

void publish(const std::filesystem::path& folder, const std::string& summary, bool replace) {
  RunFolder run(folder, replace);
  io::write_text(run.staging() / "scene.toml", "");
  io::write_text(run.staging() / "summary.json", summary);
  run.publish();
}

TEST(RunFolder, AnEarlierResultIsReplacedOnlyWhenAsked) {
  const test::TemporaryFolder folder;
  publish(folder / "run", "1", false);
  EXPECT_THROW(RunFolder(folder / "run", false), scene::InputError);
  publish(folder / "run", "2", true);
  EXPECT_EQ(test::read_file(folder / "run/summary.json"), "2");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);  // nothing else stays
}

TEST(RunFolder, AnEmptyFolderIsFilled) {
  const test::TemporaryFolder folder;
  publish(folder.path(), "1", false);
  for (const char* name : {"scene.toml", "summary.json", ".tremie"})
    EXPECT_TRUE(std::filesystem::exists(folder / name)) << name;
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 3);
}

TEST(RunFolder, WhatIsNoResultIsNeverReplaced) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "thesis.txt", "years of work");
  EXPECT_THROW(RunFolder(folder.path(), true), scene::InputError);
  EXPECT_THROW(RunFolder(folder / "thesis.txt", true), scene::InputError);
  EXPECT_THROW(RunFolder(folder / "thesis.txt/run", true), scene::InputError);
  EXPECT_EQ(test::read_file(folder / "thesis.txt"), "years of work");
}

/// Whether the folder is refused, with and without --force, by a message that names this.
void expect_refused(const std::filesystem::path& folder, const std::string& name,
                    const std::vector<std::filesystem::path>& inputs = {}) {
  for (const bool replace : {false, true}) try {
      RunFolder(folder, replace, inputs);
      FAIL() << name << " is not refused";
    } catch (const scene::InputError& error) {
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos) << error.what();
    }
}

TEST(RunFolder, AForeignOrChangedFileBesideAResultIsNamedAndKept) {
  const test::TemporaryFolder folder;
  publish(folder / "run", "1", false);
  for (const char* name : {"notes.txt", "My record.csv", "scene_old.toml", "sub/deep.txt"}) {
    std::filesystem::create_directories((folder / "run" / name).parent_path());
    test::write_file(folder / "run" / name, "mine");
    expect_refused(folder / "run", std::string(name).substr(0, 3));
    EXPECT_EQ(test::read_file(folder / "run" / name), "mine");
    std::filesystem::remove_all(folder / "run" / *std::filesystem::path(name).begin());
  }
  std::filesystem::create_directory_symlink(folder.path(), folder / "run/frames");
  expect_refused(folder / "run", "frames");
  std::filesystem::remove(folder / "run/frames");
  publish(folder / "run", "2", true);
  test::write_file(folder / "run/scene.toml", "changed");
  expect_refused(folder / "run", "scene.toml");
}

TEST(RunFolder, WhatACommandReadsIsNotReplaced) {
  const test::TemporaryFolder folder;
  publish(folder / "run", "1", false);
  std::filesystem::create_directory_symlink(folder / "run", folder / "link");
  expect_refused(folder / "run", "scene.toml", {folder / "run/scene.toml"});
  expect_refused(folder / "link", "scene.toml", {folder / "run/scene.toml"});
  expect_refused(folder / "run", "link", {folder / "link"});
  publish(folder / "other", "1", false);
  EXPECT_NO_THROW(RunFolder(folder / "other", true, {folder / "run"}));
}

TEST(RunFolder, ALinkIsFollowedAndADanglingOneRefused) {
  const test::TemporaryFolder folder;
  publish(folder / "run", "1", false);
  std::filesystem::create_directory_symlink("run", folder / "link");
  std::filesystem::create_directory_symlink("nowhere", folder / "dangling");
  publish(folder / "link", "2", true);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(test::read_file(folder / "run/summary.json"), "2");
  expect_refused(folder / "dangling", "nowhere");
  expect_refused(folder / "dangling/deeper", "nowhere");
}

TEST(RunFolder, WhatOthersPutThereDuringTheRunStays) {
  const test::TemporaryFolder folder;
  publish(folder / "run", "1", false);
  {
    RunFolder run(folder / "run", true);
    io::write_text(run.staging() / "summary.json", "2");
    test::write_file(folder / "run/notes.txt", "mine");
    run.publish();
  }
  EXPECT_EQ(test::read_file(folder / "run/summary.json"), "2");
  EXPECT_EQ(test::read_file(folder / "run/notes.txt"), "mine");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace tremie::report
