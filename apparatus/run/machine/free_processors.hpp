#pragma once

#include <string>

namespace tremie::experiment {

/// Processors that a run may have: what the process may use (its affinity, its control group's quota) less what others
/// keep busy, at least 1. Beside a busy process a second thread makes a run slower, not faster: its pauses hold up the
/// first one at every step. `loadavg` and `cpu_max` are the texts of the files of these names.
int free_processors(int hardware_threads, const std::string& loadavg, const std::string& cpu_max);

/// The same with what this machine says now; a system without these files counts as idle.
int free_processors();

}  // namespace tremie::experiment
