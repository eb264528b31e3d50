// The paper's parametric study of the thixotropic law, in one chart like its figure: shear stress and lambda
// over time for tau_0, mu, alpha, A_thix, m and the rest, one varied at a time around
// apparatus/scenes/cell_parametric.toml.
//
//   cell_parametric SCENE.toml DIR     writes cell_parametric.csv and .svg into DIR

#include <vector>

#include "apparatus/cell/cell.hpp"
#include "apparatus/registry/registry.hpp"
#include "apparatus/verification/references/study_output.hpp"

namespace tremie::study {
namespace {

struct Study {
  const char* title;
  const char* key;
  std::vector<const char*> values;
};

const std::vector<Study> studies{
    {"yield stress tau_0", "mix.yield_stress", {"27 Pa", "54 Pa", "108 Pa"}},
    {"plastic viscosity mu", "mix.plastic_viscosity", {"18 Pa.s", "36 Pa.s", "72 Pa.s"}},
    {"alpha", "mix.thixotropy.destructuration", {"0.005", "0.01", "0.03"}},
    {"A_thix", "mix.thixotropy.structuration_rate", {"0.6 Pa/s", "1.3 Pa/s", "2.6 Pa/s"}},
    {"regularisation m", "model.regularisation", {"1 s", "5 s", "50 s"}},
    {"rest", "test.rest", {"0 s", "100 s", "240 s"}}};

void run(const std::string& scene, const std::string& directory) {
  std::ofstream csv(directory + "/cell_parametric.csv");
  csv << "study,value,time_s,shear_rate_per_s,shear_stress_Pa,flocculation\n";
  std::vector<report::LineChart> charts;
  for (const Study& s : studies) {
    report::LineChart stress{
        .title = s.title, .x_label = "time (s)", .y_label = "shear stress (Pa)", .curves = {}};
    stress.y_from_zero = true;
    report::LineChart lambda = stress;
    lambda.y_label = "λ";
    for (const char* value : s.values) {
      const auto varied = scene::read(scene, {std::string(s.key) + "=" + value}, "cell");
      const CellResult result = cell::run(*std::any_cast<cell::Scene>(&varied.test));
      report::Curve stresses = curve(value), lambdas = curve(value);
      for (std::size_t i = 0; i < result.samples.size(); i += 10) {
        const CellSample& p = result.samples[i];
        csv << s.title << ',' << value << ',' << p.time << ',' << p.shear_rate << ',' << *p.shear_stress
            << ',' << *p.flocculation << '\n';
        add_point(stresses, p.time, *p.shear_stress);
        add_point(lambdas, p.time, *p.flocculation);
      }
      stress.curves.push_back(std::move(stresses));
      lambda.curves.push_back(std::move(lambdas));
    }
    charts.insert(charts.end(), {stress, lambda});
  }
  std::ofstream(directory + "/cell_parametric.svg") << report::svg_file(charts, 2);
}

}  // namespace
}  // namespace tremie::study

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: cell_parametric SCENE.toml DIR\n";
    return 2;
  }
  tremie::study::run(argv[1], argv[2]);
}
