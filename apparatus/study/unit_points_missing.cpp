#include "apparatus/scene/input_error.hpp"
#include "apparatus/study/design.hpp"

namespace tremie::study {

std::vector<std::vector<double>> unit_points(Method, std::size_t, std::size_t, std::uint64_t) {
  throw scene::InputError(
      "design.method: this build lacks OpenTURNS, which makes Latin hypercubes and Sobol sequences; apt-get "
      "install libopenturns-dev and build again, or take method = \"grid\"");
}

}  // namespace tremie::study
