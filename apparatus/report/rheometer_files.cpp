#include "apparatus/report/rheometer_files.hpp"

#include <nlohmann/json.hpp>

#include "apparatus/report/summary.hpp"

namespace tremie::cli {

nlohmann::ordered_json summary_of(const scene::Outcome& outcome) {
  auto json = report::run_summary(outcome);
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

}  // namespace tremie::cli
