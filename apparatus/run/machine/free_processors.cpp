#include "apparatus/run/machine/free_processors.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>

namespace tremie::experiment {
namespace {

std::string first_line(const char* file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Processors that others keep busy: the mean over a minute, and no more than run at the moment ("2/345" counts the
/// asking process too), so that work that has just ended does not count.
int busy_processors(const std::string& loadavg) {
  std::istringstream in(loadavg);
  double minute = 0.0, five = 0.0, fifteen = 0.0;
  int running = 1;
  if (!(in >> minute >> five >> fifteen >> running)) return 0;
  return std::max(0, std::min(static_cast<int>(std::lround(minute)), running - 1));
}

/// Processors of the quota "200000 100000", rounded up; `all` where there is none ("max 100000").
int quota(const std::string& cpu_max, int all) {
  std::istringstream in(cpu_max);
  double allowed = 0.0, period = 0.0;
  if (!(in >> allowed >> period) || !(period > 0.0)) return all;
  return static_cast<int>(std::clamp(std::ceil(allowed / period), 1.0, static_cast<double>(all)));
}

}  // namespace

int free_processors(int hardware_threads, const std::string& loadavg, const std::string& cpu_max) {
  const int all = std::max(1, hardware_threads);
  return std::clamp(all - busy_processors(loadavg), 1, quota(cpu_max, all));
}

int free_processors() {
  return free_processors(static_cast<int>(std::thread::hardware_concurrency()), first_line("/proc/loadavg"),
                         first_line("/sys/fs/cgroup/cpu.max"));
}

}  // namespace tremie::experiment
