#include <fmt/format.h>

#include <cstdio>

#include "apparatus/cli/commands.hpp"
#include "apparatus/cli/hand_over.hpp"
#include "apparatus/cli/process/say.hpp"

namespace tremie::cli {

int hand_over(char** argv) {
  say(stderr, "tremie {}: not in this build, which lacks {}; apt-get install {} and build again\n", argv[1],
      TREMIE_MISSING_PACKAGES, TREMIE_MISSING_PACKAGES);
  return bad_input;
}

}  // namespace tremie::cli
