#pragma once

// A result in the one form that the writers, the charts and the screen understand, whatever the apparatus.
// Each apparatus states once which of its numbers go under which name.

#include <array>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "apparatus/common/checkpoints.hpp"
#include "apparatus/common/model.hpp"

namespace tremie::scene {

struct Result;

/// null (does not apply), a number in the unit that the name says, a word, a truth, or named results below
/// it.
using ResultValue = std::variant<std::monostate, double, std::string, bool, std::vector<Result>>;

/// One entry of summary.json's "results".
struct Result {
  std::string name;
  ResultValue value;
};

/// A number, or null where there is none or where it is not finite.
ResultValue number(std::optional<double> value, double factor = 1.0);

/// One column of timeseries.csv and of results.h5. Not-a-number stands for no value and is written as an
/// empty field.
struct Column {
  std::string name;  ///< with its unit: "spread_mm"
  std::vector<double> values;
};
/// None where no column has the name.
const Column* find_column(const std::vector<Column>& columns, const std::string& name);

/// A horizontal line in the chart: what was measured on the real concrete, in the chart's unit.
struct Reference {
  std::string label;
  double value = 0.0, tolerance = 0.0;
};

/// A chart of columns over the first column.
struct Chart {
  std::string file;  ///< "spread.svg"
  std::string title, x_label, y_label;
  std::vector<std::string> columns;  ///< their names
  std::vector<Reference> references = {};
  std::vector<std::string> labels = {};  ///< of the columns, where there are several
  std::string table = {};                ///< file of the table that the columns are in; empty: the series
  std::string over = {};                 ///< column on the horizontal axis; empty: the first
};

/// Columns over something else than the series' time, in a file of its own and in results.h5.
struct ResultTable {
  std::string file;  ///< "profile.csv"
  std::vector<Column> columns;
};

/// Discretisation error of a result: half the width of a bar about it, in the unit of its name.
struct ErrorBar {
  std::string name;
  double error = 0.0;
};
struct ErrorEstimate {
  std::vector<ErrorBar> bars;
  std::string basis;  ///< how they were found, or why there are none
  double cpu = 0.0;   ///< that they cost [s]
};

/// A result that stands in the first line of a report: "spread 348 ± 8 mm". `name`: of the result; `word`
/// before the number, empty for none; `digits` behind the point.
struct Answer {
  std::string name, word;
  int digits = 0;
};

/// What was measured on the real concrete for what the run computed, in the unit of the result `name`.
struct Measurement {
  std::string name, word, unit;
  double value = 0.0, tolerance = 0.0;
  double difference = 0.0;  ///< computed minus measured
  std::string on = {};      ///< the concrete that was measured, where it is another; empty: the same
};

using Outline = std::vector<std::array<double, 2>>;  ///< a line of walls [m]

/// How the frames' points are looked at: which of x, y, z goes across and which up, and the walls about them.
struct Stage {
  int across = 0, up = 2;
  int depth = 1;       ///< the third direction
  double slice = 0.0;  ///< points within this of depth = 0 are shown [m]; 0: all
  bool mirrored = false;
  std::vector<Outline> walls;                      ///< that stay
  std::vector<Outline> lifted;                     ///< that rise from time 0 on
  double lift_speed = 0.0;                         ///< [m/s]
  bool full = false;                               ///< concrete fills the first of the walls
  std::vector<Outline> turning = {};               ///< closed, solid; turn about the origin
  std::vector<std::array<double, 2>> turned = {};  ///< times [s], increasing, and their angles then [rad]
  double point_size = 0.005;                       ///< about the distance of points [m]
  std::string plan = {};       ///< result that is the body's diameter from above [mm]; empty: no plan
  double ring_diameter = 0.0;  ///< of the circle on the plate [m]; 0: none
};

struct Outcome {
  std::string apparatus;
  Status status = Status::completed;
  std::vector<Result> results;
  Checks checks;
  Cost cost;
  std::vector<Column> series;
  std::vector<Chart> charts;
  std::vector<std::string> lines;  ///< the result for a person, a line each
  bool axisymmetric = false;       ///< points lie in the plane (r, 0, z) of a body of revolution
  bool pictured = true;            ///< tremie-picture has a way to draw it
  bool has_points = true;          ///< false: nothing that checks of points and cells could tell
  std::vector<ResultTable> tables = {};
  std::optional<ErrorEstimate> error = {};  ///< where it was asked for
  std::string asked = {};                   ///< "Mix A, slump flow after 240 s of rest"
  std::vector<Answer> answers = {};
  bool moving_at_end = false;  ///< still flowed when its time was over: no class, no verdict
  std::optional<Measurement> measured = {};
  std::string judged = {};                ///< class and accepted range, in a sentence; empty: none
  std::vector<std::string> remarks = {};  ///< what a reader must know to read the result rightly
  std::optional<Stage> stage = {};        ///< empty: no shape to be seen
  std::vector<std::pair<std::string, std::string>> none =
      {};  ///< what to say in place of a result that is null
};

/// The value of a result by its name; nullptr where there is none.
const ResultValue* find_result(const Outcome& outcome, const std::string& name);
/// The number of a result by its name; empty where there is none.
std::optional<double> find_number(const Outcome& outcome, const std::string& name);

/// The columns that a chart draws from; empty where the outcome has no such table.
const std::vector<Column>& columns_of(const Chart& chart, const Outcome& outcome);

/// What a caller may want to see while a run goes on. Every member may be empty.
struct Progress {
  double time = 0.0, duration = 0.0;  ///< [s] simulated, and at most
  double time_step = 0.0;             ///< [s]
  std::string reading;                ///< "spread 412 mm"
};
struct Observer {
  std::function<void(const Progress&)> on_progress = {};
  std::function<void(const Frame&)> on_frame = {};  ///< at the start, every frame interval and at the end
  const std::atomic<bool>* interrupted = nullptr;
  const Checkpoints* checkpoints = nullptr;
  bool all_frames = true;  ///< false: on_frame sees the last one alone
};

}  // namespace tremie::scene
