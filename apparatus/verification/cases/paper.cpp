// Case 8: the paper's slump flows, by exact yield in the axisymmetric space, beside what it prints. Reported
// without a bound: the paper's own numbers contradict each other (reference_data/published.toml).

#include <fmt/format.h>

#include <array>

#include "apparatus/parts/cone/cone_test.hpp"
#include "apparatus/verification/suite.hpp"

namespace tremie::verification {
namespace {

struct Mixture {
  const char* name;
  double tau_0, mu, A_thix;
  double physical_0, physical_240, loss_mpm;  ///< Tables 1 and 2 [mm]
};

constexpr std::array<Mixture, 3> mixtures{{{"A", 54, 35.8, 1.3, 590, 575, 105},
                                           {"B", 61, 29.0, 1.8, 550, 530, 94},
                                           {"C", 130, 30.2, 2.9, 500, 485, 98}}};

cone::Outcome flow(const Mixture& mixture, double rest, double duration) {
  cone::Scene scene;
  scene.mix.tau_0 = mixture.tau_0;
  scene.mix.mu = mixture.mu;
  scene.mix.thixotropy = Thixotropy{.A_thix = mixture.A_thix};
  scene.rest = rest;
  scene.duration = duration;
  return cone::run(scene);
}

std::string mm(double metres) { return fmt::format("{:.0f}", 1e3 * metres); }

}  // namespace

Case paper_case(Depth) {
  Table table{
      .name = "Slump flow without and after 240 s of rest",
      .text =
          "Axisymmetric, exact yield, no slip, α = 0.01, 20 s, mm. The paper: physical tests (± 30 mm), and "
          "the loss of its own model.",
      .columns = {"mix", "computed", "physical", "after rest", "physical after rest", "loss", "physical loss",
                  "the paper's model", "mean λ at the end", "peak of the mean γ̇, 1/s"}};
  for (const Mixture& mixture : mixtures) {
    const auto fresh = flow(mixture, 0.0, 20.0), rested = flow(mixture, 240.0, 20.0);
    table.rows.push_back({mixture.name, mm(fresh.results.spread), fmt::format("{:.0f}", mixture.physical_0),
                          mm(rested.results.spread), fmt::format("{:.0f}", mixture.physical_240),
                          mm(fresh.results.spread - rested.results.spread),
                          fmt::format("{:.0f}", mixture.physical_0 - mixture.physical_240),
                          fmt::format("{:.0f}", mixture.loss_mpm),
                          fmt::format("{:.2f}", rested.results.flocculation_mean_end.value_or(0.0)),
                          fmt::format("{:.1f} and {:.1f}", fresh.results.shear_rate_mean_peak,
                                      rested.results.shear_rate_mean_peak)});
  }
  return {8, "The paper", {}, {table}};
}

}  // namespace tremie::verification
