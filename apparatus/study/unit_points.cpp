#include <openturns/ComposedDistribution.hxx>
#include <openturns/LHSExperiment.hxx>
#include <openturns/LowDiscrepancyExperiment.hxx>
#include <openturns/OTBase.hxx>
#include <openturns/RandomGenerator.hxx>
#include <openturns/SobolSequence.hxx>
#include <openturns/Uniform.hxx>

#include "apparatus/study/design.hpp"

namespace tremie::study {

std::vector<std::vector<double>> unit_points(Method method, std::size_t count, std::size_t dimensions,
                                             std::uint64_t seed) {
  OT::RandomGenerator::SetSeed(seed);
  OT::ComposedDistribution::DistributionCollection sides(dimensions, OT::Uniform(0.0, 1.0));
  const OT::ComposedDistribution cube(sides);
  OT::Sample sample;
  if (method == Method::sobol) {
    // Scrambled by a random shift modulo 1, so that the seed matters.
    OT::LowDiscrepancyExperiment sobol(OT::SobolSequence(dimensions), cube, count, true);
    sobol.setRandomize(true);
    sample = sobol.generate();
  } else {
    sample = OT::LHSExperiment(cube, count).generate();
  }
  std::vector<std::vector<double>> points(count, std::vector<double>(dimensions));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < dimensions; ++j) points[i][j] = sample(i, j);
  return points;
}

}  // namespace tremie::study
