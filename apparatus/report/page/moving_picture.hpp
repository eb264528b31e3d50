#pragma once

// Points over time, for a canvas in the report: thinned and in few bytes, so that a page can be sent on.

#include <array>
#include <string>
#include <vector>

namespace tremie::report {

/// A line of walls [m].
using Polyline = std::vector<std::array<double, 2>>;

/// What the points may be coloured by. `log`: on a logarithmic scale.
struct ColourField {
  std::string words, unit;
  double low = 0.0, high = 1.0;
  bool log = false;
};

/// The points at one time: places [m], and a value a point for each field.
struct MovingFrame {
  double time = 0.0;    ///< [s]
  double turned = 0.0;  ///< what turns has turned by then [rad]
  std::vector<std::array<float, 2>> places;
  std::vector<std::vector<float>> values;
};

struct MovingPicture {
  std::string caption;
  std::vector<ColourField> fields;
  std::vector<MovingFrame> frames;
  std::vector<Polyline> fixed;    ///< walls that stay
  std::vector<Polyline> lifted;   ///< walls that rise from time 0 on
  double lift_speed = 0.0;        ///< of those [m/s]
  bool full = false;              ///< the first of the walls is full of points
  std::vector<Polyline> turning;  ///< solid bodies that turn about the origin by the frame's angle
  bool mirrored = false;          ///< drawn again at -x: half of a body of revolution
};

/// At most so many frames and points a frame, evenly thinned; the first and the last frame stay.
MovingPicture thinned(MovingPicture picture, std::size_t most_frames, std::size_t most_points);

/// The canvas, its controls and its data (base64), to stand in a page that has moving_script.
std::string moving_html(const MovingPicture& picture);

/// The script that draws them; empty data draws nothing.
extern const char* const moving_script;

}  // namespace tremie::report
