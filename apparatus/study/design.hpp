#pragma once

// The rows of a study.

#include <vector>

#include "apparatus/study/definition.hpp"

namespace tremie::study {

/// A row has one level for each factor, in their order.
using Design = std::vector<std::vector<Level>>;

/// The same rows for the same definition, seed included. Throws scene::InputError where the method needs a
/// library that this build lacks, or where a grid has more than a million rows.
Design make_design(const Definition& study);

/// `count` points of the unit cube: Latin hypercube or Sobol sequence (OpenTURNS).
std::vector<std::vector<double>> unit_points(Method method, std::size_t count, std::size_t dimensions,
                                             std::uint64_t seed);

/// design.csv: `row` and a column for each factor.
std::string design_csv(const Definition& study, const Design& design);

/// The --set arguments of a row.
std::vector<std::string> overrides_of(const Definition& study, const std::vector<Level>& row);

/// ",54,35.8": the levels of a row, a comma before each.
std::string csv_fields(const std::vector<Level>& row);

/// A CSV field, quoted where it must be.
std::string csv_field(const std::string& text);

}  // namespace tremie::study
