#include "apparatus/report/rheometer_files.hpp"

#include <nlohmann/json.hpp>

#include "apparatus/report/process.hpp"
#include "apparatus/report/summary.hpp"
#include "libmpm/io/write_error.hpp"

namespace tremie::cli {

nlohmann::ordered_json summary_of(const scene::Outcome& outcome) {
  auto json = nlohmann::ordered_json::parse(report::summary_json(outcome));
  auto& checks = json["checks"];
  for (const char* key : {"volume_change", "mass_error", "unconverged_steps", "points_lost",
                          "max_speed_end_m_per_s", "stability_limit_exceeded"})
    checks[key] = nullptr;
  for (const char* key : {"cells_active", "bytes_per_point"}) json["cost"][key] = nullptr;
  if (outcome.cost.points == 0)
    for (const char* key : {"steps", "points", "simulated_s"}) json["cost"][key] = nullptr;
  return json;
}

HeldInterrupts::HeldInterrupts() {
  sigset_t held;
  sigemptyset(&held);
  for (const int number : {SIGINT, SIGTERM}) sigaddset(&held, number);
  sigprocmask(SIG_BLOCK, &held, &before_);
}

HeldInterrupts::~HeldInterrupts() { sigprocmask(SIG_SETMASK, &before_, nullptr); }

std::string draw(const std::filesystem::path& folder, const std::string& script) {
  const auto gnuplot = report::find_program("gnuplot");
  if (gnuplot.empty()) return "gnuplot is not installed: no charts";
  const auto file = folder / ".chart.gp";
  io::write_text(file, script);
  const auto code = report::run_program(gnuplot, {file.filename().string()}, folder);
  std::filesystem::remove(file);
  return code == 0 ? "" : "gnuplot failed: charts are missing or not complete";
}

}  // namespace tremie::cli
