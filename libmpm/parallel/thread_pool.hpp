#pragma once

// Threads that stay together from pass to pass, and work that they share.
//
// An explicit step of a few thousand points takes a tenth of a millisecond. Starting and ending a parallel
// region of OpenMP in it costs a twentieth of that; a pool that waits at a counter for the next round costs a
// fifth as much.

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

namespace tremie {

namespace detail {

/// How often a waiting thread looks, some tenths of a millisecond, before it lets other programs run.
inline constexpr int looks = 10000;

inline void look_again() {
#ifdef __x86_64__
  __builtin_ia32_pause();
#endif
}

template <class T, class Not>
T wait_while(const std::atomic<T>& value, Not not_yet) {
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

}  // namespace detail

class ThreadPool {
 public:
  /// n in all; the caller of run() is one of them.
  explicit ThreadPool(int n) {
    for (int s = 1; s < n; ++s) others_.emplace_back([this, s] { stand_by(s); });
  }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;
  ~ThreadPool() {
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
    detail::wait_while(busy_, [](int busy) { return busy != 0; });
  }

 private:
  void start_round() {
    round_.fetch_add(1, std::memory_order_release);
    if (!others_.empty()) round_.notify_all();
  }

  void stand_by(int s) {
    for (unsigned seen = 0;;) {
      seen = detail::wait_while(round_, [seen](unsigned round) { return round == seen; });
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

/// Pieces of work 0 ... n - 1 in runs, one for each thread of a pool. Every second run goes from its end, so
/// that two threads meet where their runs do: what lies there has been in both caches.
class WorkSharing {
 public:
  /// Thread s has the pieces begin[s] ... begin[s + 1] - 1.
  void set_out(const std::vector<int>& begin) {
    n_ = begin.size() - 1;
    runs_ = std::make_unique<Run[]>(n_);
    for (std::size_t s = 0; s < n_; ++s)
      runs_[s].first = begin[s], runs_[s].size = begin[s + 1] - begin[s], runs_[s].from_end = s % 2 == 1;
  }

  /// Nothing is taken yet. Not while a thread is at it.
  void start_anew() {
    for (std::size_t s = 0; s < n_; ++s) runs_[s].taken.store(0, std::memory_order_relaxed);
  }

  /// Thread s: visit(piece) for its own pieces, and then for what the others have not taken of theirs.
  template <class Visit>
  void take(int s, Visit visit) {
    for (std::size_t k = 0; k < n_; ++k) {
      Run& run = runs_[(static_cast<std::size_t>(s) + k) % n_];
      while (run.taken.load(std::memory_order_relaxed) < run.size) {
        const int i = run.taken.fetch_add(1, std::memory_order_relaxed);
        if (i < run.size) visit(run.piece(i));
      }
    }
  }

 private:
  struct alignas(64) Run {
    std::atomic<int> taken = 0;
    int first = 0, size = 0;
    bool from_end = false;
    int piece(int i) const { return first + (from_end ? size - 1 - i : i); }
  };
  std::unique_ptr<Run[]> runs_;
  std::size_t n_ = 0;
};

/// Of each of n things the number of the last pass that is done with it. One line of a cache for each: what
/// one thread looks at again and again another must not write beside.
class EpochFlags {
 public:
  void set_out(std::size_t n) { marks_ = std::make_unique<Mark[]>(n); }
  void mark(int i, std::int64_t pass) {
    marks_[static_cast<std::size_t>(i)].pass.store(pass, std::memory_order_release);
  }
  /// Who waits longer than a pass takes lets others run, who may be what it waits for.
  void wait_for(int i, std::int64_t pass) const {
    const std::atomic<std::int64_t>& done = marks_[static_cast<std::size_t>(i)].pass;
    for (int looked = 0; done.load(std::memory_order_acquire) < pass; ++looked)
      looked < detail::looks ? detail::look_again() : std::this_thread::yield();
  }

 private:
  struct alignas(64) Mark {
    std::atomic<std::int64_t> pass = 0;
  };
  std::unique_ptr<Mark[]> marks_;
};

/// Of n things each goes to whom asks for it first in a pass.
class EpochClaims {
 public:
  void set_out(std::size_t n) { claims_ = std::make_unique<Claim[]>(n); }
  bool taken(int i, std::int64_t pass) const {
    return claims_[static_cast<std::size_t>(i)].pass.load(std::memory_order_relaxed) >= pass;
  }
  /// Whether it is the caller's. Passes must not overtake each other.
  bool take(int i, std::int64_t pass) {
    return claims_[static_cast<std::size_t>(i)].pass.exchange(pass, std::memory_order_relaxed) < pass;
  }

 private:
  struct alignas(64) Claim {
    std::atomic<std::int64_t> pass = 0;
  };
  std::unique_ptr<Claim[]> claims_;
};

}  // namespace tremie
