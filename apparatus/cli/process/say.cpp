#include "apparatus/cli/process/say.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace tremie::cli {
namespace {

bool has_answered = false;
int trouble = 0;  ///< the first error of the standard output

void nothing(int) {}

}  // namespace

void secure_streams() {
  // One that cannot be written, so that a lost answer is noticed.
  while (true) {
    const int file = open("/dev/null", O_RDONLY);
    if (file < 0) break;
    if (file > STDERR_FILENO) {
      close(file);
      break;
    }
  }
  struct sigaction action = {}, before = {};
  action.sa_handler = nothing;  // what is started by execv has the usual one
  action.sa_flags = SA_RESTART;
  sigaction(SIGPIPE, nullptr, &before);
  if (before.sa_handler == SIG_DFL) sigaction(SIGPIPE, &action, nullptr);
}

void write_text_to(std::FILE* stream, const std::string& text) {
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), stream) != text.size() && stream == stdout && trouble == 0)
    trouble = errno;
}

void answer(const std::string& text) {
  has_answered = true;
  write_text_to(stdout, text);
}

int exit_code_once_printed(int exit_code, int fault) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
  if (trouble == 0) trouble = errno;
  if (has_answered && (trouble == EPIPE || trouble == EBADF)) return exit_code;
  say(stderr, "tremie: the standard output cannot be written: {}\n", std::strerror(trouble));
  return has_answered && exit_code == 0 ? fault : exit_code;
}

}  // namespace tremie::cli
