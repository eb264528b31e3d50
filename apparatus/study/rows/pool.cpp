#include "apparatus/study/rows/pool.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <vector>

namespace tremie::study {
namespace {

struct Child {
  std::size_t item;
  pid_t process;
  int pipe;
  std::string text;
};

void write_all(int file, const std::string& text) {
  for (std::size_t at = 0; at < text.size();) {
    const ssize_t n = write(file, text.data() + at, text.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) _exit(1);
    at += static_cast<std::size_t>(n);
  }
}

[[noreturn]] void be_child(std::size_t item, int pipe, pid_t parent,
                           const std::function<std::string(std::size_t)>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // a study that is killed leaves nobody at work
  if (getppid() != parent) _exit(1);
  signal(SIGINT, SIG_IGN);  // the study ends its runs itself
  signal(SIGTERM, SIG_DFL);
  try {
    write_all(pipe, work(item));
    _exit(0);
  } catch (const std::exception& error) {
    // what work() lets out is a fault of ours: the parent says so
    fprintf(stderr, "tremie: %s\n", error.what());
  } catch (...) {
  }
  _exit(1);
}

Child start(std::size_t item, const std::function<std::string(std::size_t)>& work) {
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error(fmt::format("no pipe: {}", std::strerror(errno)));
  const pid_t parent = getpid();
  const pid_t process = fork();
  if (process < 0) throw std::runtime_error(fmt::format("no new process: {}", std::strerror(errno)));
  if (process == 0) {
    close(ends[0]);
    be_child(item, ends[1], parent, work);
  }
  close(ends[1]);
  return {item, process, ends[0], {}};
}

/// False at the end of what the child says.
bool read_some(Child& child) {
  char buffer[65536];
  const ssize_t n = read(child.pipe, buffer, sizeof buffer);
  if (n < 0) return errno == EINTR;
  child.text.append(buffer, static_cast<std::size_t>(n));
  return n > 0;
}

Finished bury(Child& child) {
  close(child.pipe);
  int status = 0;
  while (waitpid(child.process, &status, 0) < 0 && errno == EINTR) {
  }
  Finished finished{child.item, {}, {}};
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
    finished.text = std::move(child.text);
  else if (WIFSIGNALED(status))
    finished.death = fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  else
    finished.death = fmt::format("ended with exit code {}", WEXITSTATUS(status));
  return finished;
}

void end_all(std::vector<Child>& children) {
  for (Child& child : children) kill(child.process, SIGKILL);
  for (Child& child : children) bury(child);
}

void wait_for_some(std::vector<Child>& children, const std::function<void(const Finished&)>& done) {
  std::vector<pollfd> polled;
  for (const Child& child : children) polled.push_back({child.pipe, POLLIN, 0});
  if (poll(polled.data(), polled.size(), 200) <= 0) return;
  for (std::size_t i = children.size(); i-- > 0;) {
    if (polled[i].revents == 0 || read_some(children[i])) continue;
    const Finished finished = bury(children[i]);
    children.erase(children.begin() + static_cast<std::ptrdiff_t>(i));
    done(finished);
  }
}

}  // namespace

bool run_pool(std::span<const std::size_t> items, int jobs,
              const std::function<std::string(std::size_t)>& work,
              const std::function<void(const Finished&)>& done, const std::atomic<bool>* stop) {
  std::vector<Child> children;
  std::size_t next = 0;
  try {
    while (next < items.size() || !children.empty()) {
      if (stop && *stop) {
        end_all(children);
        return false;
      }
      while (next < items.size() && children.size() < static_cast<std::size_t>(jobs))
        children.push_back(start(items[next++], work));
      wait_for_some(children, done);
    }
  } catch (...) {
    end_all(children);
    throw;
  }
  return true;
}

}  // namespace tremie::study
