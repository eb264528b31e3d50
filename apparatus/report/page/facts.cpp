// Date, version and machine: what a reader needs to make a report again.

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <ctime>
#include <fstream>

#include "apparatus/report/page/page.hpp"
#include "tremie_version.hpp"

namespace tremie::report {
namespace {

std::string date_now() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{:%Y-%m-%d %H:%M %z}", local);
}

/// "AMD EPYC 7B13" where the system tells it, else its architecture.
std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  utsname name{};
  return uname(&name) == 0 ? name.machine : "unknown";
}

}  // namespace

std::vector<Fact> facts_of_this_run(const std::string& command) {
  std::vector<Fact> facts{
      {"date", date_now()},
      {"program", fmt::format("Tremie {} ({}), {}, {}", version, commit, compiler, instructions)},
      {"machine", fmt::format("{}, {} processors", processor(), sysconf(_SC_NPROCESSORS_ONLN))}};
  if (!command.empty()) facts.push_back({"to repeat it", command});
  return facts;
}

}  // namespace tremie::report
