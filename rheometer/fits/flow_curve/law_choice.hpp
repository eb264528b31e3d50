#pragma once

// Which law describes a flow curve: an F test of the first law, of fewest parameters, within each of the others, which
// contain it. Private to rheometer/.

#include <string>
#include <vector>

#include "rheometer/fits/flow_curve/flow_least_squares.hpp"

namespace tremie::fitting {

/// Of the first law within a richer one, both fitted to the readings that both keep.
struct NestedTest {
  std::size_t readings = 0;
  double f = 0.0, probability = 1.0;             ///< of so large an F, were the first law right
  double first_misfit = 0.0, rich_misfit = 0.0;  ///< root mean squares of the relative residuals
};

/// Correlated residuals of the richer law count as fewer readings.
NestedTest nested_test(const Readings& readings, const FitInput& input, const FittedLaw& first,
                       const FittedLaw& rich);

/// The laws that are asked for and that the readings suffice for, the first law first. Throws std::invalid_argument where
/// the readings suffice for none.
std::vector<FittedLaw> fit_candidates(const Readings& readings, const FitInput& input);

/// The first law, or another that an F test prefers to it at 1 % (5 % for four or five readings, where 1 % would ask for
/// more than instruments repeat) and that describes the readings with all parameters inside of their ranges. Fills in the
/// candidates and the choice.
FittedLaw choose_law(const Readings& readings, const FitInput& input, FitResult& result);

/// A law that describes readings which the first one misses.
struct BetterLaw {
  FittedLaw fitted;
  NestedTest test;
  std::string words;  ///< "Herschel-Bulkley describes these readings far better (...)"
  bool refuses =
      false;  ///< the first law is refused: its fit is, or it misses by more than 5 % and three times as much
};

/// Where a fit by the first law was asked for and another law is far better (F test at 0.1 %; at 1 % for less than eight
/// readings) with another yield stress, or where the first law is `refused`; empty otherwise.
std::optional<BetterLaw> better_law(const Readings& readings, const FitInput& input, const FittedLaw& first,
                                    bool refused);

}  // namespace tremie::fitting
