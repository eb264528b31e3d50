#include "apparatus/cli/hand_over.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/process/own_file.hpp"
#include "apparatus/cli/process/say.hpp"

namespace tremie::cli {

int hand_over(char** argv) {
  const auto program = own_file().parent_path() / "tremie-study";
  // What Ceres logs is for its programmers; what went wrong is told by us.
  setenv("GLOG_minloglevel", "3", 0);
  execv(program.c_str(), argv);
  if (errno != ENOENT) {
    say(stderr, "tremie: {}: {}\n", program.string(), std::strerror(errno));
    return fault;
  }
  say(stderr,
      "tremie: {} is not there: fit, study, verify and calibrate are in that program, beside tremie. It is "
      "built where libsundials-dev, libceres-dev and libboost-dev are installed (README.md, the test line)\n",
      program.string());
  return bad_input;
}

}  // namespace tremie::cli
