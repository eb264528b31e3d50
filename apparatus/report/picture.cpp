#include "apparatus/report/picture.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <cstdlib>

#include "apparatus/report/process.hpp"

namespace tremie::report {
namespace {

namespace fs = std::filesystem;

/// tremie-picture lies beside the program.
fs::path picture_program() {
  std::error_code error;
  const fs::path beside = fs::read_symlink("/proc/self/exe", error).parent_path() / "tremie-picture";
  return !error && fs::exists(beside, error) ? beside : find_program("tremie-picture");
}

std::vector<std::string> arguments_for(const scene::Outcome& outcome, const std::string& vtp) {
  std::vector<std::string> arguments{vtp, "shape.png"};
  if (outcome.axisymmetric) arguments.push_back("--axisymmetric");
  if (const auto spread = scene::find_number(outcome, "spread_mm"))
    arguments.insert(arguments.end(), {"--spread", fmt::format("{:.1f}", *spread)});
  return arguments;
}

}  // namespace

std::string draw_picture(const scene::Outcome& outcome, const fs::path& folder, const std::string& vtp) {
  const fs::path program = picture_program();
  if (program.empty()) return "tremie-picture is not beside tremie (building it needs VTK): no picture";
  auto arguments = arguments_for(outcome, vtp);
  // Mesa's renderer takes as many threads as the run had.
  setenv("LP_NUM_THREADS", std::to_string(omp_get_max_threads()).c_str(), 0);
  const char* display = std::getenv("DISPLAY");
  if (display && *display && run_program(program, arguments, folder) == 0) return "";
  const fs::path xvfb = find_program("xvfb-run");
  if (xvfb.empty()) return "there is no display and no xvfb-run: no picture";
  arguments.insert(arguments.begin(), {"-a", program.string()});
  if (run_program(xvfb, arguments, folder) == 0) return "";
  return "tremie-picture failed: no picture";
}

}  // namespace tremie::report
