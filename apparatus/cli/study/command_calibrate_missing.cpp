#include <fmt/format.h>

#include <cstdio>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/options/command.hpp"
#include "apparatus/cli/process/say.hpp"
#include "apparatus/cli/program.hpp"

namespace tremie::cli {

void add_command_calibrate(CLI::App& app, int& exit_code) {
  Command command(app, calibrate_command.name, calibrate_command.description);
  command.anything();
  command.run([&exit_code] {
    say(stderr,
        "tremie calibrate: not in this build, which lacks libopenturns-dev; apt-get install "
        "libopenturns-dev and build again\n");
    exit_code = bad_input;
  });
}

}  // namespace tremie::cli
