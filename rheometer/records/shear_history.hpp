#pragma once

// The shear rate of one material cell over time: pieces in which it is smooth, with jumps allowed between
// them.

#include <functional>
#include <span>
#include <vector>

namespace tremie {

/// One piece of a history. `rate` maps the time since the start of the piece [s] to gamma_dot [1/s] and is
/// smooth and not negative over [0, duration].
struct ShearPiece {
  double duration = 0.0;  ///< [s]
  std::function<double(double)> rate;
};

/// A shear rate that goes linearly from `from` to `to` [1/s] in `duration` [s].
struct ShearSegment {
  double duration = 0.0, from = 0.0, to = 0.0;
};

/// The segment as a piece. Throws std::invalid_argument for a duration that is not positive or a negative
/// rate.
ShearPiece linear_piece(const ShearSegment& segment);

std::vector<ShearPiece> linear_pieces(std::span<const ShearSegment> segments);

/// Total duration [s].
double duration(std::span<const ShearPiece> pieces);

}  // namespace tremie
