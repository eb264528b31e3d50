#include "apparatus/study/rows/indices.hpp"

namespace tremie::study {

std::vector<ResultIndices> sobol_indices(const Definition&, const Design&, const Collected&,
                                         std::string& note) {
  note = "no Sobol indices: this build lacks OpenTURNS (libopenturns-dev)";
  return {};
}

}  // namespace tremie::study
