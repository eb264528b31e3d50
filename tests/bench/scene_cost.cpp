// What a scene carries: bytes a point, instructions a point and step, start-up, libraries loaded, for scenes
// that differ by one thing. Instructions are counted by valgrind (callgrind), twice over different lengths of
// the same flow; the difference leaves out start and end. valgrind knows no AVX-512: build with
// -DTREMIE_NATIVE=OFF.
//
//   scene_cost TREMIE BARE_SLUMP DIR     prints its tables; its runs lie in DIR meanwhile

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "apparatus/verification/references/study_output.hpp"

namespace {

using nlohmann::json;

constexpr double shorter = 0.05, longer = 0.15;  // of flow [s]

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) throw std::runtime_error("cannot run " + command);
  std::string text;
  for (std::array<char, 4096> part{}; const auto n = fread(part.data(), 1, part.size(), pipe);)
    text.append(part.data(), n);
  if (pclose(pipe) != 0) throw std::runtime_error("failed: " + command + "\n" + text);
  return text;
}

/// Instructions of a command, and what it printed.
struct Counted {
  double instructions = 0.0;
  std::string output;
};

Counted count(const std::string& command) {
  const std::string text = output_of(
      "OMP_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file=/dev/null " + command + " 2>&1");
  const auto at = text.find("Collected :");
  if (at == std::string::npos) throw std::runtime_error("valgrind counted nothing:\n" + text);
  return {std::stod(text.substr(at + 11)), text};
}

struct Variant {
  const char *name, *settings;
};

/// The scene of all rows but for what its row names: Bingham, instant release, no-slip floor, axisymmetric,
/// no files.
const char* const base =
    "--set mix.thixotropy=false --set test.lift_speed=instant --set output.frames=false "
    "--set 'model.cell=[\"20 mm\", \"10 mm\"]'";

constexpr std::array variants{
    Variant{"Bingham, no slip, axisymmetric", ""},
    Variant{"thixotropic", "--set mix.thixotropy.structuration_rate='1.3 Pa/s'"},
    Variant{"friction floor", "--set floor.contact=friction --set floor.coefficient=0.35"},
    Variant{"cone lifted", "--set test.lift_speed='15 cm/s'"},
    Variant{"Papanastasiou, m = 5 s", "--set model.yield=papanastasiou --set model.regularisation='5 s'"},
    Variant{"frames every 0.05 s", "--set output.frames=true --set output.frame_interval='0.05 s'"},
    Variant{"a quarter in 3D, 2 points a direction",
            "--set model.space=quarter --set model.points_per_cell=2"},
};

struct Cost {
  double bytes = 0.0, steps = 0.0, points = 0.0, iterations = 0.0, per_point_step = 0.0;
};

double mean_iterations(const std::string& folder) {
  std::ifstream file(folder + "/timeseries.csv");
  std::string line;
  double sum = 0.0;
  int n = 0;
  for (std::getline(file, line), std::getline(file, line); std::getline(file, line); ++n)
    sum += std::stod(line.substr(line.rfind(',') + 1));
  return n ? sum / n : 0.0;
}

Cost cost_of(const std::string& tremie, const std::string& scene, const std::string& folder,
             const std::string& settings) {
  std::array<double, 2> instructions{}, steps{};
  Cost cost;
  for (std::size_t i = 0; i < 2; ++i) {
    instructions[i] = count(fmt::format("{} run {} {} {} --set test.duration='{} s' --out {} --force --quiet",
                                        tremie, scene, base, settings, i ? longer : shorter, folder))
                          .instructions;
    const json summary = json::parse(std::ifstream(folder + "/summary.json"));
    steps[i] = summary["cost"]["steps"], cost.points = summary["cost"]["points"];
    cost.bytes = summary["cost"]["bytes_per_point"];
  }
  cost.iterations = mean_iterations(folder);
  cost.steps = steps[1] - steps[0];
  cost.per_point_step = (instructions[1] - instructions[0]) / (cost.steps * cost.points);
  return cost;
}

Cost bare_cost(const std::string& bare, const std::string& readings) {
  std::array<double, 2> instructions{}, steps{};
  Cost cost;
  for (std::size_t i = 0; i < 2; ++i) {
    const std::string command = fmt::format("{} 0.02 {} {}", bare, i ? longer : shorter, readings);
    instructions[i] = count(command).instructions;
    std::istringstream(output_of(command)) >> steps[i] >> cost.points;
  }
  cost.steps = steps[1] - steps[0];
  cost.per_point_step = (instructions[1] - instructions[0]) / (cost.steps * cost.points);
  return cost;
}

/// CPU milliseconds of a command, the smallest of 20 runs.
double cpu_ms(const std::string& command) {
  const auto children = [] {
    rusage u{};
    getrusage(RUSAGE_CHILDREN, &u);
    return 1e3 * static_cast<double>(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
           1e-3 * static_cast<double>(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
  };
  double best = 1e300;
  for (int i = 0; i < 20; ++i) {
    const double start = children();
    output_of(command);
    best = std::min(best, children() - start);
  }
  return best;
}

void write_programs(std::ostream& out, const std::string& tremie) {
  out << "\n## Programs\n\n| program | libraries loaded | VTK among them | CPU ms to start and print its "
         "version |\n"
         "|---|---|---|---|\n";
  for (const std::string& program : {tremie, tremie + "-study", tremie + "-picture"}) {
    if (!std::ifstream(program)) continue;
    const std::string libraries = output_of("ldd " + program);
    const bool has_version = program != tremie + "-picture";
    out << fmt::format("| {} | {} | {} | {} |\n", program.substr(program.rfind('/') + 1),
                       std::count(libraries.begin(), libraries.end(), '\n'),
                       libraries.find("libvtk") == std::string::npos ? "no" : "yes",
                       has_version ? fmt::format("{:.1f}", cpu_ms(program + " --version")) : "");
  }
}

void write(std::ostream& out, const std::string& tremie, const std::string& bare,
           const std::string& directory) {
  out << "# What a scene carries\n\n"
      << tremie::study::made_by("study_scene_cost") << "\nMix A, cells of 20 x 10 mm, from " << shorter
      << " to " << longer
      << " s of the flow; every row names its difference from the first.\nInstructions by callgrind, one "
         "thread, baseline x86-64.\n\n"
         "| scene | bytes a point | points | steps | iterations a step | instructions a point and step |\n"
         "|---|---|---|---|---|---|\n";
  const std::string folder = directory + "/.scene_cost",
                    scene = directory + "/../../apparatus/scenes/slump_flow_mix_a.toml";
  double first = 0.0;
  for (const Variant& v : variants) {
    const Cost c = cost_of(tremie, scene, folder, v.settings);
    if (first == 0.0) first = c.per_point_step;
    out << fmt::format("| {} | {} | {} | {} | {:.1f} | {:.0f} |\n", v.name, c.bytes, c.points, c.steps,
                       c.iterations, c.per_point_step)
        << std::flush;
  }
  const Cost step = bare_cost(bare, ""), read = bare_cost(bare, "readings");
  for (const auto& [name, c] : {std::pair{"the step alone, one law and one space compiled", step},
                                {"the step and its line of the series", read}})
    out << fmt::format("| {} | | {} | {} | | {:.0f} |\n", name, c.points, c.steps, c.per_point_step);
  out << fmt::format(
      "\nThe last two rows are the first scene without a program (`tests/bench/bare_slump.cpp`). Readings "
      "take {:.2f} % "
      "of a step, the rest of the program {:.2f} %. Compiling the step in another file changes its cost by "
      "up to "
      "3 % of either sign.\n",
      100.0 * (read.per_point_step / step.per_point_step - 1.0), 100.0 * (first / read.per_point_step - 1.0));
  output_of("rm -r " + folder);
  write_programs(out, tremie);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::cerr << "usage: scene_cost TREMIE BARE_SLUMP DIR\n";
    return 2;
  }
  try {
    std::ostringstream text;
    write(text, argv[1], argv[2], argv[3]);
    std::cout << text.str();
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
