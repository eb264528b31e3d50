// A run's frames and picture, read back with VTK's own readers.

#include <gtest/gtest.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>
#include <vtkPointData.h>
#include <vtkPolyData.h>
#include <vtkXMLPolyDataReader.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/apparatus/shell.hpp"
#include "tests/apparatus/temporary_folder.hpp"

namespace tremie {
namespace {

/// Half a second of a coarse Mix C, run once for all tests.
class Frames : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = new test::TemporaryFolder;
    const std::string scene =
        "apparatus = \"slump_flow\"\nmix = \"mix_c\"\n[test]\nduration = \"0.5 s\"\nlift_speed = "
        "\"instant\"\n"
        "[model]\ncell = \"20 mm\"\npoints_per_cell = 2\n[output]\nframe_interval = \"0.1 s\"\n";
    test::write_file(*folder_ / "quick.toml", scene);
    run_ =
        test::shell("env -u DISPLAY '" + std::string(TREMIE_PROGRAM) + "' run quick.toml --out run --quiet",
                    folder_->path());
    summary_ = nlohmann::json::parse(test::read_file(*folder_ / "run/summary.json"));
  }
  static void TearDownTestSuite() { delete folder_; }

  struct Frame {
    double time;
    std::string file;
  };
  /// What frames.pvd lists.
  static std::vector<Frame> listed() {
    const std::string pvd = test::read_file(*folder_ / "run/frames.pvd");
    const std::regex line("timestep=\"([^\"]+)\" file=\"([^\"]+)\"");
    std::vector<Frame> frames;
    for (std::sregex_iterator m(pvd.begin(), pvd.end(), line), end; m != end; ++m)
      frames.push_back({std::stod((*m)[1]), (*folder_ / ("run/" + (*m)[2].str())).string()});
    return frames;
  }
  static vtkSmartPointer<vtkPolyData> read(const std::string& file) {
    vtkNew<vtkXMLPolyDataReader> reader;
    reader->SetFileName(file.c_str());
    reader->Update();
    return reader->GetOutput();
  }

  static inline test::TemporaryFolder* folder_ = nullptr;
  static inline test::Result run_;
  static inline nlohmann::json summary_;
};

TEST_F(Frames, AreReadWithTheirTimes) {
  ASSERT_EQ(run_.code, 0) << run_.text;
  const std::vector<Frame> frames = listed();
  ASSERT_GE(frames.size(), 5u);
  for (const Frame& frame : frames) {
    const auto body = read(frame.file);
    ASSERT_EQ(body->GetNumberOfPoints(), summary_["cost"]["points"].get<int>()) << frame.file;
    vtkDataArray* time = body->GetFieldData()->GetArray("TimeValue");
    ASSERT_NE(time, nullptr);
    EXPECT_DOUBLE_EQ(time->GetTuple1(0), frame.time);
  }
}

/// The farthest point of the last frame is the one that summary.json reports, to single precision; the volumes
/// add up to Abrams' cone, pi/3 h (R^2 + R r + r^2) = 5.498e-3 m^3, within what seeding and compression leave.
TEST_F(Frames, HoldTheBodyThatWasReported) {
  const auto body = read(listed().back().file);
  double farthest = 0.0, volume = 0.0;
  vtkDataArray* volumes = body->GetPointData()->GetArray("volume");
  ASSERT_NE(volumes, nullptr);
  for (vtkIdType i = 0; i < body->GetNumberOfPoints(); ++i) {
    const double* x = body->GetPoint(i);
    farthest = std::max(farthest, std::hypot(x[0], x[1]));
    volume += volumes->GetTuple1(i);
  }
  EXPECT_NEAR(2e3 * farthest, summary_["results"]["spread_max_point_mm"].get<double>(), 40.0);
  EXPECT_GT(farthest, 0.15);
  EXPECT_NEAR(volume, std::numbers::pi / 3 * 0.3 * (0.01 + 0.005 + 0.0025), 0.01 * 5.498e-3);
}

TEST_F(Frames, ArePaintedOnAVirtualDisplay) {
  if (test::shell("command -v xvfb-run", folder_->path()).code != 0)
    GTEST_SKIP() << "needs xvfb-run (xvfb, xauth)";
  vtkNew<vtkPNGReader> reader;
  const std::string file = (*folder_ / "run/shape.png").string();
  ASSERT_TRUE(reader->CanReadFile(file.c_str())) << run_.text;
  reader->SetFileName(file.c_str());
  reader->Update();
  const int* size = reader->GetOutput()->GetDimensions();
  EXPECT_GE(size[0], 600);
  EXPECT_GE(size[1], 400);
  // Background, plate and a colour scale: a picture that shows nothing has one colour.
  std::vector<double> red;
  for (int x = 0; x < size[0]; x += 7)
    for (int y = 0; y < size[1]; y += 7)
      red.push_back(reader->GetOutput()->GetScalarComponentAsDouble(x, y, 0, 0));
  std::sort(red.begin(), red.end());
  EXPECT_GT(std::unique(red.begin(), red.end()) - red.begin(), 20);
}

/// A movie is of all frames: a folder with one of them, or none, is told what to do, and nothing is left.
TEST_F(Frames, OfAMovieMustBeThere) {
  const std::string picture = TREMIE_PICTURE;
  const test::Result none = test::shell("'" + picture + "' . --movie out.gif", folder_->path());
  EXPECT_EQ(none.code, 1);
  EXPECT_NE(none.text.find("frames.pvd"), std::string::npos) << none.text;
  const test::Result wrong = test::shell("'" + picture + "' run --movie out.png", folder_->path());
  EXPECT_EQ(wrong.code, 1);
  EXPECT_NE(wrong.text.find(".mp4 or .gif"), std::string::npos) << wrong.text;
  EXPECT_NE(test::shell("test -e out.gif", folder_->path()).code, 0);
}

TEST_F(Frames, BecomeAMovie) {
  for (const char* program : {"ffmpeg", "xvfb-run"})
    if (test::shell(std::string("command -v ") + program, folder_->path()).code != 0)
      GTEST_SKIP() << "needs " << program;
  const std::string picture = TREMIE_PICTURE;
  const test::Result made = test::shell("xvfb-run -a '" + picture + "' run --movie out.gif", folder_->path());
  ASSERT_EQ(made.code, 0) << made.text;
  EXPECT_EQ(test::read_file(*folder_ / "out.gif").substr(0, 6), "GIF89a");
}

}  // namespace
}  // namespace tremie
