#pragma once

// One frame of a slump flow as a PNG: the concrete on its plate, seen obliquely.

#include <optional>
#include <string>
#include <utility>

#include "apparatus/report/picture/body.hpp"

namespace tremie::picture {

struct View {
  std::string frame = {}, out = {};                     ///< .vtp in, .png out
  bool axisymmetric = false;                            ///< points lie in the plane (r, 0, z)
  double spread_mm = 0.0;                               ///< as a dimension line; 0: none
  std::string caption = {};                             ///< below the body; empty: none
  std::optional<std::pair<double, double>> range = {};  ///< of the colours; empty: the frame's own
  double plate = 0.0;                                   ///< side of the plate [m]; 0: by the frame
};

/// The points of a frame with the flocculation state, or the shear rate where there is none.
struct Loaded {
  Cloud cloud;
  std::string title;  ///< of the colour bar
  double low = 0.0, high = 1.0;
};

/// Throws std::runtime_error for a file without points or field.
Loaded load(const std::string& file);

/// The plate that a frame's body lies on with room about it [m].
double plate_of(const Loaded& loaded);

/// Throws std::runtime_error where it cannot be read or written. Needs a display: VTK is built for GLX here.
void draw(const View& view);

}  // namespace tremie::picture
