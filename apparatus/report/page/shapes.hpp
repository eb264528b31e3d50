#pragma once

// A body's shape as SVG, without a heavy tool: the section and the plan from its points.

#include <array>
#include <string>
#include <vector>

#include "apparatus/report/page/moving_picture.hpp"

namespace tremie::report {

struct Shape {
  std::string title;
  std::vector<std::array<double, 2>> places = {};  ///< of the points in the section [m]
  double point_size = 0.005;                       ///< side of what a point stands for [m]
  std::vector<Polyline> walls;
  bool mirrored = false;       ///< draw it again at -x
  double plan_diameter = 0.0;  ///< of the body seen from above [m]: drawn below the section; 0: no plan
  double ring_diameter = 0.0;  ///< a circle on the plate to compare it with [m]; 0: none
};

/// A quantity over the radius, as a section from above: rings of its colour on a logarithmic scale.
struct Disc {
  std::string title, words;                 ///< "shear rate (1/s)"
  std::vector<double> radius = {}, values;  ///< [m], increasing; above 0 where there is something
  double low = 0.01, high = 10.0;           ///< ends of the colours
  std::vector<Polyline> solids = {};        ///< closed, filled: what turns in the concrete [m]
};

/// One <svg> element: the disc with its inner and outer radius and the scale of colours.
std::string disc_svg(const Disc& disc);

/// One <svg> element: true proportions, with its measures.
std::string shape_svg(const Shape& shape);

}  // namespace tremie::report
