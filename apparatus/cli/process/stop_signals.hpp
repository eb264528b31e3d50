#pragma once

#include <atomic>

namespace tremie::cli {

/// Whether somebody asked the program to stop; for Observer::interrupted.
extern std::atomic<bool> stop_requested;

/// From here on SIGINT, SIGTERM and SIGHUP (a terminal that is closed) ask the run to stop and write what it has; one
/// a second or two later ends the program. A reader of the output that went away is told at the end, and stops
/// nothing.
void stop_on_interrupt();

}  // namespace tremie::cli
