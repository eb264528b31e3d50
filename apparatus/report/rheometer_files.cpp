#include "apparatus/report/rheometer_files.hpp"

#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <nlohmann/json.hpp>

#include "apparatus/report/summary.hpp"

namespace tremie::cli {

namespace {

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

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

Stopwatch::Stopwatch() : cpu_(cpu_seconds()), wall_(wall_seconds()) {}

void Stopwatch::stop(Cost& cost) const {
  cost.cpu = cpu_seconds() - cpu_;
  cost.wall = wall_seconds() - wall_;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  cost.peak_rss_bytes = std::int64_t{usage.ru_maxrss} * 1024;
}

HeldInterrupts::HeldInterrupts() {
  sigset_t held;
  sigemptyset(&held);
  for (const int number : {SIGINT, SIGTERM}) sigaddset(&held, number);
  sigprocmask(SIG_BLOCK, &held, &before_);
}

HeldInterrupts::~HeldInterrupts() { sigprocmask(SIG_SETMASK, &before_, nullptr); }

}  // namespace tremie::cli
