#pragma once

#include <vector>

#include "apparatus/common/model.hpp"

namespace tremie::experiment {

/// What an apparatus' own run hands back, in SI units. SampleOfRun: a line of the series, with its `time` and `time_step` [s].
template <class ResultsOfRun, class SampleOfRun>
struct Record {
  using Results = ResultsOfRun;
  using Sample = SampleOfRun;
  Status status = Status::completed;
  ResultsOfRun results = {};
  Checks checks = {};
  Cost cost = {};
  std::vector<Sample> series =
      {};  ///< every step; the start included where the test has something to read then
  Frame final_frame = {};
};

}  // namespace tremie::experiment
