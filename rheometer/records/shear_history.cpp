#include "rheometer/records/shear_history.hpp"

#include <cmath>
#include <stdexcept>

namespace tremie {

ShearPiece linear_piece(const ShearSegment& s) {
  if (!(std::isfinite(s.duration) && s.duration > 0.0))
    throw std::invalid_argument("the duration of a piece of the history must be greater than 0");
  if (!(std::isfinite(s.from) && std::isfinite(s.to) && s.from >= 0.0 && s.to >= 0.0))
    throw std::invalid_argument("a shear rate of the history must not be negative");
  return {s.duration, [s](double t) { return s.from + (s.to - s.from) * (t / s.duration); }};
}

std::vector<ShearPiece> linear_pieces(std::span<const ShearSegment> segments) {
  std::vector<ShearPiece> pieces;
  pieces.reserve(segments.size());
  for (const ShearSegment& segment : segments) pieces.push_back(linear_piece(segment));
  return pieces;
}

double duration(std::span<const ShearPiece> pieces) {
  double sum = 0.0;
  for (const ShearPiece& piece : pieces) sum += piece.duration;
  return sum;
}

}  // namespace tremie
