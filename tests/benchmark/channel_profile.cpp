// Tremie's velocity in the channel of channel.toml, as CSV: the suite's plane Poiseuille flow on 64 cells.

#include <algorithm>
#include <cstdio>

#include "apparatus/verification/references/film.hpp"

int main() {
  using namespace tremie;
  using namespace verification::film;
  bool converged = false;
  auto samples = steady_state(Flow{.film = false}, ExactBingham{}, YieldMethod::newton, 64, converged);
  std::sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.y < b.y; });
  samples.erase(std::unique(samples.begin(), samples.end(),  // the cells beside each other along the channel
                            [](const Sample& a, const Sample& b) { return b.y - a.y < 1e-9; }),
                samples.end());
  std::printf("y_m,velocity_mm_per_s\n");
  for (const Sample& s : samples) std::printf("%.9g,%.9g\n", s.y, 1e3 * s.v);
  return converged ? 0 : 1;
}
