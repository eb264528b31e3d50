// Takes the place of elastic_ode.cpp in a build without SUNDIALS.

#include <stdexcept>

#include "rheometer/cell/elastic_ode.hpp"

namespace tremie {

ElasticOdeResult elastic_ode(std::span<const ShearPiece>, const ElasticMaterial&, double,
                             std::span<const double>) {
  throw std::runtime_error("this build has no integrated references: it was built without SUNDIALS");
}

}  // namespace tremie
