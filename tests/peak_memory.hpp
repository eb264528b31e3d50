#pragma once

// Most memory that a process of its own holds, for tests of what a large body costs.

#include <malloc.h>
#include <omp.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tremie::test {

/// The sanitizer's own memory would be most of it.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool memory_can_be_measured = false;
#else
inline constexpr bool memory_can_be_measured = true;
#endif

/// Peak of a child process in which run() is true, with one thread and arrays of a megabyte and more given
/// back at once [bytes]; 0 where it is false.
template <class Run>
double peak_memory_of(Run run) {
  const pid_t child = fork();
  if (child == 0) {
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    omp_set_num_threads(1);
    _exit(run() ? 0 : 1);
  }
  int status = 0;
  struct rusage usage {};
  if (wait4(child, &status, 0, &usage) != child || status != 0) return 0.0;
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace tremie::test
