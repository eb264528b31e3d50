// The paper's parametric study of the thixotropic law, in one chart like its figure: shear stress and lambda
// over time for tau_0, mu, alpha, A_thix, m and the rest, one varied at a time around
// apparatus/scenes/cell_parametric.toml.
//
//   cell_parametric SCENE.toml DIR     writes cell_parametric.csv, .gp and .svg into DIR

#include <vector>

#include "apparatus/cell/cell.hpp"
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

const char* const blues[] = {"#9fc5e8", "#3d85c6", "#073763"};  // small, middle, large value
const char* const oranges[] = {"#f9cb9c", "#e69138", "#783f04"};

void run(const std::string& scene, const std::string& directory) {
  std::ofstream csv(directory + "/cell_parametric.csv");
  csv << "study,value,time_s,shear_rate_per_s,shear_stress_Pa,flocculation\n";
  std::ofstream gp(directory + "/cell_parametric.gp");
  gp << "set terminal svg size 1200,760 font 'sans,13' background 'white'\nset output 'cell_parametric.svg'\n"
        "set datafile separator ','\nset grid lc '#dddddd'\nset xlabel 'time in s'\nset ylabel 'shear stress "
        "in Pa' tc "
        "'#0b5394'\nset y2label 'lambda' tc '#e07b00'\nset ytics nomirror\nset y2tics\nset yrange [0:*]\nset "
        "y2range "
        "[0:*]\nset key top right samplen 1.5\nset offsets 0, 0, graph 0.3, 0\nset xtics 10\nset multiplot "
        "layout 2,3\n"
        "f(s,v) = sprintf('< grep \"^%s,%s,\" cell_parametric.csv', s, v)\n";
  for (const Study& s : studies) {
    gp << "set title '" << s.title << "' noenhanced\nplot ";
    for (std::size_t k = 0; k < s.values.size(); ++k) {
      const cell::Scene varied = cell::read(scene, {std::string(s.key) + "=" + s.values[k]});
      const CellResult result = cell::run(varied);
      for (std::size_t i = 0; i < result.samples.size(); i += 10) {
        const CellSample& p = result.samples[i];
        csv << s.title << ',' << s.values[k] << ',' << p.time << ',' << p.shear_rate << ',' << *p.shear_stress
            << ',' << *p.flocculation << '\n';
      }
      const std::string source = "f('" + std::string(s.title) + "','" + s.values[k] + "')";
      gp << (k ? ", " : "") << source << " using 3:5 with lines lw 2 lc '" << blues[k] << "' title '"
         << s.values[k] << "', " << source << " using 3:6 axes x1y2 with lines lw 2 lc '" << oranges[k]
         << "' notitle";
    }
    gp << "\n";
  }
  gp << "unset multiplot\n";
  csv.close();
  gp.close();
  draw(directory, "cell_parametric.gp");
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
