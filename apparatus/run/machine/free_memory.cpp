#include "apparatus/run/machine/free_memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <limits>

namespace tremie::experiment {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

std::string text_of(const char* file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// "MemAvailable:   12345 kB" among other lines.
double available(const std::string& meminfo) {
  const std::string key = "MemAvailable:";
  const auto at = meminfo.find(key);
  return at == std::string::npos ? unlimited : 1024.0 * std::atof(meminfo.c_str() + at + key.size());
}

/// "max", or bytes.
double of_group(const std::string& memory_max) {
  const double bytes = std::atof(memory_max.c_str());
  return bytes > 0.0 ? bytes : unlimited;
}

/// Addresses that each further thread takes without using them: its stack, and the arena of its heap (glibc).
constexpr double addresses_of_a_thread = 72.0 * 1024 * 1024;

/// What the limit leaves beside the program itself, whose pages come first in statm, and its further threads.
double of_process(int threads) {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  const double used =
      std::atof(text_of("/proc/self/statm").c_str()) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - used - (threads - 1) * addresses_of_a_thread);
}

}  // namespace

double free_memory(const std::string& meminfo, const std::string& memory_max, double process_limit) {
  return std::min({available(meminfo), of_group(memory_max), process_limit});
}

double free_memory(int threads) {
  return free_memory(text_of("/proc/meminfo"), text_of("/sys/fs/cgroup/memory.max"), of_process(threads));
}

}  // namespace tremie::experiment
