#pragma once

// Charts as SVG, in the report's style: text that a phone shows in 11 px, colours that colour-blind
// readers tell apart. Standing alone they are light; in a page they follow its colours.

#include <string>
#include <vector>

namespace tremie::report {

enum class Mark { line, dashed, points, line_and_points };

struct Curve {
  std::string label;  ///< at the curve's side of the legend; empty: none
  std::vector<double> x = {}, y = {};
  Mark mark = Mark::line;
  std::vector<double> low = {}, high = {};  ///< ends of the error bars of y; empty: none
  int colour = -1;                          ///< of the palette of four; -1: by its place among the curves
};

/// Between two curves over the same x: a 95 % band.
struct Band {
  std::string label;
  std::vector<double> x, low = {}, high = {};
};

/// A level that was measured, with its tolerance (0: a line alone).
struct Level {
  std::string label;
  double value = 0.0, tolerance = 0.0;
};

/// A shaded range of x over the whole height: a regime.
struct Range {
  std::string label;
  double low = 0.0, high = 0.0;
};

/// Words in the chart, their middle at a point, in a colour of the palette.
struct Note {
  std::string text;
  double x = 0.0, y = 0.0;
  int colour = 0;
};

/// The error of the last value of a curve: half the bar.
struct EndBar {
  double x = 0.0, y = 0.0, half = 0.0;
};

/// A filled rectangle of a map: `share` of the full colour, 0 to 1.
struct Patch {
  double x0 = 0.0, x1 = 0.0, y0 = 0.0, y1 = 0.0, share = 1.0;
};

struct LineChart {
  std::string title, x_label, y_label;  ///< with units as people write them: "time (s)"
  std::vector<Curve> curves = {};
  std::vector<Level> levels = {};
  std::vector<Band> bands = {};
  std::vector<EndBar> bars = {};
  std::vector<Patch> patches = {};
  std::vector<Range> ranges = {};
  std::vector<Note> notes = {};
  bool log_x = false, log_y = false;
  bool y_from_zero = false;
  double width = 480.0, height = 330.0;  ///< letters are 15 high; a long legend adds to the height
};

/// Whether some curve has two finite points.
bool can_be_drawn(const LineChart& chart);

/// One <svg> element. Values that are not finite are left out.
std::string chart_svg(const LineChart& chart);

/// Charts on white as one file, row by row in so many columns of one width.
std::string svg_file(const std::vector<LineChart>& charts, std::size_t columns = 1);

/// Bars of several series over names, 0 to 1, each with half of its error: shares of a variance.
struct BarChart {
  std::string title, x_label;
  std::vector<std::string> names = {};                        ///< a group each
  std::vector<std::string> series;                            ///< a colour each
  std::vector<std::vector<double>> values = {}, errors = {};  ///< by name, then series
};
std::string bars_svg(const BarChart& chart);

/// Round numbers that divide [low, high] into about `n` parts.
std::vector<double> round_ticks(double low, double high, int n);

}  // namespace tremie::report
