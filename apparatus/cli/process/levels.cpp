#include "apparatus/cli/process/levels.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

#include "apparatus/cli/process/own_file.hpp"
#include "tremie_version.hpp"

namespace tremie::cli {

#ifdef __x86_64__

namespace {

struct Level {
  std::string_view name;
  bool here;  ///< whether this processor has it
};

/// The best first; of the instructions of a level those that tell it from the one below.
std::array<Level, 4> levels() {
  __builtin_cpu_init();
  const bool v2 = __builtin_cpu_supports("sse4.2") && __builtin_cpu_supports("popcnt"),
             v3 = v2 && __builtin_cpu_supports("avx2") && __builtin_cpu_supports("bmi2") &&
                  __builtin_cpu_supports("fma"),
             v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                  __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                  __builtin_cpu_supports("avx512vl");
  return {{{"x86-64-v4", v4}, {"x86-64-v3", v3}, {"x86-64-v2", v2}, {"x86-64", true}}};
}

/// Ends the program with code 2 where TREMIE_LEVEL names no level.
void refuse_unknown(std::string_view wanted) {
  const auto all = levels();
  if (std::ranges::any_of(all, [&](const Level& level) { return level.name == wanted; })) return;
  std::string message =
      "tremie: TREMIE_LEVEL names an unknown level \"" + std::string(wanted) + "\"; allowed:";
  for (const Level& level : all) message += ' ' + std::string(level.name);
  message += '\n';
  (void)!write(STDERR_FILENO, message.data(), message.size());
  std::exit(2);
}

}  // namespace

void become_best_level(char** argv) {
  const auto program = own_file();
  const auto folder = program.parent_path().parent_path() / "lib" / "tremie";
  const char* wanted = std::getenv("TREMIE_LEVEL");
  if (wanted) refuse_unknown(wanted);
  bool allowed = !wanted;
  for (const Level& level : levels()) {
    if (level.name == instructions) return;
    allowed = allowed || level.name == wanted;
    if (allowed && level.here)
      execv((folder / level.name / program.filename()).c_str(), argv);  // returns where there is none
  }
}

#else

void become_best_level(char**) {}

#endif

}  // namespace tremie::cli
