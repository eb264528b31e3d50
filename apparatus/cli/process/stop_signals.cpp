#include "apparatus/cli/process/stop_signals.hpp"

#include <signal.h>

#include <ctime>

namespace tremie::cli {

std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

namespace {

std::atomic<std::time_t> first_request{0};
static_assert(std::atomic<std::time_t>::is_always_lock_free, "set from a signal handler");

/// Whoever stops a program often signals it and its group: what comes at once is one request.
void request_stop(int signal_number) {
  const std::time_t now = std::time(nullptr);
  if (!stop_requested.exchange(true)) {
    first_request = now;
  } else if (now - first_request > 1) {
    signal(signal_number, SIG_DFL);
    raise(signal_number);
  }
}

/// What the caller has the program ignore (nohup) it goes on ignoring.
void handle(int signal_number) {
  struct sigaction action = {}, before = {};
  action.sa_handler = request_stop;
  action.sa_flags = SA_RESTART;
  for (int other : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&action.sa_mask, other);
  sigaction(signal_number, nullptr, &before);
  if (signal_number == SIGHUP && before.sa_handler == SIG_IGN) return;
  sigaction(signal_number, &action, nullptr);
}

}  // namespace

void stop_on_interrupt() {
  for (int signal_number : {SIGINT, SIGTERM, SIGHUP}) handle(signal_number);
}

}  // namespace tremie::cli
