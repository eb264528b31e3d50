#pragma once

// Threads that stay together from pass to pass.
//
// An explicit step of a few thousand points takes a tenth of a millisecond. Starting and ending two parallel
// regions of OpenMP in it costs a twentieth of that; a crew that waits at a counter between two passes costs
// a fifth as much.

#include <atomic>
#include <thread>
#include <vector>

namespace tremie {

class Crew {
 public:
  /// n in all; the caller of run() is one of them.
  explicit Crew(int n) {
    for (int s = 1; s < n; ++s) others_.emplace_back([this, s] { stand_by(s); });
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() {
    visit_ = nullptr;
    start_round();
    for (std::thread& other : others_) other.join();
  }

  int size() const { return static_cast<int>(others_.size()) + 1; }

  /// Calls visit(s) for each s below size() in a thread of its own, and waits for all.
  template <class Visit>
  void run(const Visit& visit) {
    visit_ = [](const void* of, int s) { (*static_cast<const Visit*>(of))(s); };
    of_ = &visit;
    busy_.store(static_cast<int>(others_.size()), std::memory_order_relaxed);
    start_round();
    visit(0);
    wait_while(busy_, [](int busy) { return busy != 0; });
  }

 private:
  /// Looks as often as takes some tenths of a millisecond, then sleeps: other programs want to run too.
  static constexpr int looks = 10000;

  static void look_again() {
#ifdef __x86_64__
    __builtin_ia32_pause();
#endif
  }

  template <class T, class Not>
  static T wait_while(const std::atomic<T>& value, Not not_yet) {
    T now = value.load(std::memory_order_acquire);
    for (int i = 0; not_yet(now); ++i) {
      if (i < looks)
        look_again();
      else
        value.wait(now, std::memory_order_acquire);
      now = value.load(std::memory_order_acquire);
    }
    return now;
  }

  void start_round() {
    round_.fetch_add(1, std::memory_order_release);
    if (!others_.empty()) round_.notify_all();
  }

  void stand_by(int s) {
    for (unsigned seen = 0;;) {
      seen = wait_while(round_, [seen](unsigned round) { return round == seen; });
      if (!visit_) return;
      visit_(of_, s);
      if (busy_.fetch_sub(1, std::memory_order_release) == 1) busy_.notify_one();
    }
  }

  // Each on a line of its own: what one thread looks at again and again another must not write beside.
  alignas(64) void (*visit_)(const void*, int) = nullptr;
  const void* of_ = nullptr;
  alignas(64) std::atomic<unsigned> round_ = 0;
  alignas(64) std::atomic<int> busy_ = 0;
  alignas(64) std::vector<std::thread> others_;  // last: they read the rest
};

}  // namespace tremie
