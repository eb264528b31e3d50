// A cage in the section: bars and hoops closer together than the flow changes, smeared around the circle and over the height.

#include "apparatus/bored_pile/pour.hpp"

namespace tremie::bored_pile {

std::vector<BarPoint<2>> screen_of(const Cage& cage, double height, double cell) {
  const int rows = static_cast<int>(std::ceil(2.0 * height / cell));
  const double row = height / rows, around = 2.0 * std::numbers::pi * cage.radius;
  BarPoint<2> bars, hoops;
  bars.axis = {0.0, 1.0}, bars.length = cage.bars * row, bars.diameter = cage.bar_diameter;
  bars.mobility = row_mobility(cage.bar_diameter, cage.bar_spacing());
  if (cage.hoop_spacing > 0.0) {
    hoops.length = around * row / cage.hoop_spacing, hoops.diameter = cage.hoop_diameter;
    hoops.mobility = row_mobility(cage.hoop_diameter, cage.hoop_spacing);
  }
  std::vector<BarPoint<2>> points;
  for (int k = 0; k < rows; ++k) {
    bars.x = hoops.x = {cage.radius, (k + 0.5) * row};
    points.push_back(bars);
    if (cage.hoop_spacing > 0.0) points.push_back(hoops);
  }
  return points;
}

}  // namespace tremie::bored_pile
