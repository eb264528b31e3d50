#include "apparatus/study/rows/indices.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <openturns/ComposedDistribution.hxx>
#include <openturns/CorrectedLeaveOneOut.hxx>
#include <openturns/FixedStrategy.hxx>
#include <openturns/FunctionalChaosAlgorithm.hxx>
#include <openturns/FunctionalChaosSobolIndices.hxx>
#include <openturns/LARS.hxx>
#include <openturns/LeastSquaresMetaModelSelectionFactory.hxx>
#include <openturns/LeastSquaresStrategy.hxx>
#include <openturns/LegendreFactory.hxx>
#include <openturns/OrthogonalProductPolynomialFactory.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/Uniform.hxx>

namespace tremie::study {
namespace {

constexpr std::size_t replicates = 40, effect_points = 21, most_degree = 8;

struct Rows {
  OT::Sample x, y;  ///< shares of the ranges; the result
};

/// Where a level lies in its factor's range, 0 to 1; values lie at equal distances.
double share(const Factor& factor, const Level& level) {
  if (factor.values.empty()) return share_of(factor, level.number);
  std::size_t k = 0;
  while (k + 1 < factor.values.size() && factor.values[k].text != level.text) ++k;
  return (static_cast<double>(k) + 0.5) / static_cast<double>(factor.values.size());
}

Rows rows_of(const Definition& study, const Design& design, const Collected& collected, std::size_t result) {
  Rows rows{OT::Sample(0, study.factors.size()), OT::Sample(0, 1)};
  for (const Row& row : collected.rows) {
    const auto number = trusted_number(row, result);
    if (!number) continue;
    OT::Point x(study.factors.size());
    for (std::size_t i = 0; i < x.getSize(); ++i) x[i] = share(study.factors[i], design[row.row][i]);
    rows.x.add(x);
    rows.y.add(OT::Point(1, *number));
  }
  return rows;
}

/// The largest total degree whose terms are half as many as the rows.
std::size_t terms_for(const OT::EnumerateFunction& enumerate, std::size_t rows) {
  std::size_t terms = enumerate.getStrataCumulatedCardinal(1);
  for (std::size_t degree = 2; degree <= most_degree; ++degree)
    if (2 * enumerate.getStrataCumulatedCardinal(degree) <= rows)
      terms = enumerate.getStrataCumulatedCardinal(degree);
  return terms;
}

OT::FunctionalChaosResult chaos_of(const Rows& rows) {
  const auto n = rows.x.getDimension();
  const OT::OrthogonalProductPolynomialFactory basis(
      OT::OrthogonalProductPolynomialFactory::PolynomialFamilyCollection(n, OT::LegendreFactory()));
  const OT::ComposedDistribution cube(
      OT::ComposedDistribution::DistributionCollection(n, OT::Uniform(0.0, 1.0)));
  const OT::FixedStrategy terms(basis, terms_for(basis.getEnumerateFunction(), rows.x.getSize()));
  const OT::LeastSquaresStrategy strategy{
      OT::LeastSquaresMetaModelSelectionFactory{OT::LARS{}, OT::CorrectedLeaveOneOut{}}};
  OT::FunctionalChaosAlgorithm algorithm(rows.x, rows.y, cube, terms, strategy);
  algorithm.run();
  return algorithm.getResult();
}

Rows resampled(const Rows& rows) {
  const auto n = rows.x.getSize();
  Rows drawn{OT::Sample(0, rows.x.getDimension()), OT::Sample(0, 1)};
  for (std::size_t i = 0; i < n; ++i) {
    const auto k = OT::RandomGenerator::IntegerGenerate(n);
    drawn.x.add(rows.x[k]);
    drawn.y.add(rows.y[k]);
  }
  return drawn;
}

/// Half of the interval that holds 95 %.
double half_width(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[static_cast<std::size_t>(std::lround(q * static_cast<double>(values.size() - 1)))];
  };
  return 0.5 * (at(0.975) - at(0.025));
}

std::vector<SobolIndex> indices_of(const OT::FunctionalChaosResult& chaos, std::size_t factors) {
  const OT::FunctionalChaosSobolIndices sobol(chaos);
  std::vector<SobolIndex> indices(factors);
  for (std::size_t i = 0; i < factors; ++i)
    indices[i] = {sobol.getSobolIndex(i), 0.0, sobol.getSobolTotalIndex(i), 0.0};
  return indices;
}

void add_errors(const Rows& rows, std::vector<SobolIndex>& indices) {
  std::vector<std::vector<SobolIndex>> drawn;
  for (std::size_t k = 0; k < replicates; ++k)
    drawn.push_back(indices_of(chaos_of(resampled(rows)), indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::vector<double> first, total;
    for (const auto& one : drawn) {
      first.push_back(one[i].first);
      total.push_back(one[i].total);
    }
    indices[i].first_error = half_width(first);
    indices[i].total_error = half_width(total);
  }
}

MainEffect main_effect(const Factor& factor, std::size_t i, const OT::Function& model, const OT::Sample& x) {
  MainEffect effect;
  const std::size_t points = factor.values.empty() ? effect_points : factor.values.size();
  for (std::size_t k = 0; k < points; ++k) {
    const double at = factor.values.empty() ? static_cast<double>(k) / static_cast<double>(points - 1)
                                            : (static_cast<double>(k) + 0.5) / static_cast<double>(points);
    OT::Sample moved = x;
    for (std::size_t j = 0; j < moved.getSize(); ++j) moved(j, i) = at;
    effect.at.push_back(level_at(factor, at).number);
    effect.mean.push_back(model(moved).computeMean()[0]);
  }
  return effect;
}

ResultIndices indices_for(const Definition& study, const std::string& result, const Rows& rows) {
  ResultIndices out{result, rows.x.getSize(), 0.0, {}, {}};
  const auto chaos = chaos_of(rows);
  out.explained = 1.0 - chaos.getRelativeErrors()[0];
  out.indices = indices_of(chaos, study.factors.size());
  add_errors(rows, out.indices);
  for (std::size_t i = 0; i < study.factors.size(); ++i)
    out.main_effects.push_back(main_effect(study.factors[i], i, chaos.getMetaModel(), rows.x));
  return out;
}

}  // namespace

std::vector<ResultIndices> sobol_indices(const Definition& study, const Design& design,
                                         const Collected& collected, std::string& note) {
  OT::RandomGenerator::SetSeed(study.seed);
  std::vector<ResultIndices> all;
  const std::size_t least = std::max<std::size_t>(10, 3 * study.factors.size());
  for (std::size_t i = 0; i < study.results.size(); ++i) {
    const Rows rows = rows_of(study, design, collected, i);
    const bool varies = rows.y.getSize() > 1 && rows.y.getMax()[0] > rows.y.getMin()[0];
    if (rows.x.getSize() >= least && varies) {
      all.push_back(indices_for(study, study.results[i], rows));
      if (rows.x.getSize() < collected.rows.size())
        note += fmt::format("{}indices of {} are of the {} rows that have a trusted number",
                            note.empty() ? "" : "; ", study.results[i], rows.x.getSize());
    } else {
      note += fmt::format("{}no Sobol indices of {}: {}", note.empty() ? "" : "; ", study.results[i],
                          varies || rows.x.getSize() < least
                              ? fmt::format("{} rows have a number, it takes {}", rows.x.getSize(), least)
                              : "it is the same in every row");
    }
  }
  return all;
}

}  // namespace tremie::study
