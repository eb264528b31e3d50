// The program `tremie`: scenes and the law. What fits and verifies is handed over to tremie-study.

#include <malloc.h>
#include <unistd.h>

#include <cstring>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/hand_over.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/process/levels.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/program.hpp"

namespace {

using namespace tremie::cli;

constexpr StudyCommand study_commands[] = {fit_command, read_command, study_command, calibrate_command,
                                           verify_command};

bool is_study_command(const char* word) {
  for (const StudyCommand& command : study_commands)
    if (std::strcmp(word, command.name) == 0) return true;
  return false;
}

/// Arrays of four megabytes and more go back to the system when they are freed. By its own rule the allocator
/// keeps ever larger ones, in pieces: a quarter more memory for a large body in space. What lies free at the
/// heap's end stays up to 32 MB: given back and asked for again in every step, it costs a body of 13,000
/// points a tenth of its time.
void return_large_blocks() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 1 << 22);
  mallopt(M_TRIM_THRESHOLD, 1 << 25);
#endif
}

/// The commands of tremie-study, for --help.
void name_study_commands(CLI::App& app) {
  for (const StudyCommand& command : study_commands) Command(app, command.name, command.description);
}

}  // namespace

int main(int argc, char** argv) {
  secure_streams();
  become_best_level(argv);
  return_large_blocks();
  if (argc > 1 && is_study_command(argv[1])) return hand_over(argv);
  return run_program(argc, argv, [](CLI::App& app, int& exit_code) {
    add_command_run(app, exit_code);
    add_command_resume(app, exit_code);
    add_command_watch(app, exit_code);
    add_command_check(app, exit_code);
    add_command_new(app, exit_code);
    add_command_cell(app, exit_code);
    add_command_compare(app, exit_code);
    add_command_estimate(app, exit_code);
    name_study_commands(app);
  });
}
