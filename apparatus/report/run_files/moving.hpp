#pragma once

#include <cstddef>
#include <vector>

#include "apparatus/common/outcome.hpp"
#include "apparatus/report/page/moving_picture.hpp"

namespace tremie::report {

/// A run's frames for the page, thinned as they come, so that the memory is bounded whatever the run.
class ShownFrames {
 public:
  static constexpr std::size_t most_frames = 120, most_points = 3000;

  /// One more time. A frame of the time that came last is left out.
  void add(const Frame& frame);

  /// At most most_frames, evenly over those that came; the first and the last are among them. Each has its time,
  /// positions, shear rates and flocculation states, of at most most_points points: those next to y = 0 where they
  /// fill a space.
  const std::vector<Frame>& frames() const { return kept_; }

 private:
  std::vector<Frame> kept_;
  std::size_t came_ = 0, stride_ = 1;
  std::size_t times_too_many_ = 0, every_ = 1;  ///< of the points; kept, so that a point stays in the picture
  bool last_is_extra_ = false;                  ///< the last one stands in until the next comes
};

/// A run's frames as its stage shows them; nothing without a stage.
MovingPicture moving_picture(const scene::Outcome& outcome, const std::vector<Frame>& frames);

}  // namespace tremie::report
