#pragma once

#include <string>

namespace tremie::experiment {

/// Memory that a run may have [bytes]: what is available on this machine (/proc/meminfo), in its control group
/// (memory.max) and to a process of so many threads (`ulimit -v`). Infinite where nothing says so.
double free_memory(int threads = 1);

/// The same from the texts of these files and the limit of the process [bytes].
double free_memory(const std::string& meminfo, const std::string& memory_max, double process_limit);

}  // namespace tremie::experiment
