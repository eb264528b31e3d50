#include "apparatus/registry/machine_pace.hpp"

#include <time.h>

#include <algorithm>
#include <string>
#include <vector>

#include "apparatus/run/machine/threads.hpp"

namespace tremie::scene {
namespace {

/// A few steps of a slump flow, and what they take the machine of the rates.
struct Blink {
  std::vector<std::string> settings;
  double cpu;  ///< [s]
};

const Blink& blink_for(const Scene& scene) {
  static const Blink section{{"model.cell=20 mm", "test.duration=0.3 s"}, 0.024},
      space{{"model.space=quarter", "model.cell=30 mm", "test.duration=0.05 s"}, 0.117},
      explicit_steps{{"preset=paper", "model.space=quarter", "model.cell=30 mm", "test.duration=0.1 s"},
                     0.058};
  const Model& model = model_of(scene);
  if (model.scheme != SchemeKind::implicit) return explicit_steps;
  return experiment::is_3d(model.space) ? space : section;
}

/// CPU time of this thread [s]: a run by one thread is all in it, and other threads, which may still spin for a while after
/// they were last needed, are not.
double thread_cpu() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double machine_pace(const Scene& scene) {
  const Blink& blink = blink_for(scene);
  Scene small =
      read_text("apparatus = \"slump_flow\"\nmix = \"mix_a\"\n", "the blink of a run", blink.settings);
  set_threads(small, 1);
  const auto cpu = [&] {
    const double start = thread_cpu();
    run(small);
    return thread_cpu() - start;
  };
  return std::min(cpu(), cpu()) / blink.cpu;  // the smaller one: caches are cold and others busy at times
}

}  // namespace tremie::scene
