#pragma once

// What matters: Sobol indices of each result over the factors, of a polynomial chaos through the rows.

#include <optional>
#include <string>
#include <vector>

#include "apparatus/study/design.hpp"
#include "apparatus/study/rows/journal.hpp"

namespace tremie::study {

/// Shares of a result's variance: by the factor alone, and with all that it interacts in. `error`: half of
/// the interval that holds 95 % of the values over bootstrapped rows.
struct SobolIndex {
  double first = 0.0, first_error = 0.0, total = 0.0, total_error = 0.0;
};

/// The mean of the result over all other factors, along one.
struct MainEffect {
  std::vector<double> at, mean;  ///< the factor's SI value, the result
};

struct ResultIndices {
  std::string result;
  std::size_t rows = 0;                  ///< trusted rows with a number
  double explained = 0.0;                ///< share of the variance that the chaos predicts of left-out rows
  std::vector<SobolIndex> indices;       ///< a factor each
  std::vector<MainEffect> main_effects;  ///< a factor each
};

/// For each result with enough rows: at least 10, and 3 a factor. `note` says what is left out, and why.
std::vector<ResultIndices> sobol_indices(const Definition& study, const Design& design,
                                         const Collected& collected, std::string& note);

}  // namespace tremie::study
