#pragma once

// Looks at Python while a run goes on without its lock: signals (Ctrl-C) and the caller's progress function.

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>

#include "apparatus/common/outcome.hpp"

namespace tremie::python {

class Watch {
 public:
  /// `progress`: called with (time, duration, time_step, reading), or None. Make it and drop it with the lock.
  explicit Watch(pybind11::object progress) : progress_(std::move(progress)) {}

  /// The observer of a run that stops between two steps where Python raises something.
  scene::Observer observer() {
    scene::Observer observer;
    observer.interrupted = &stop_;
    observer.on_progress = [this](const scene::Progress& p) { look(p); };
    return observer;
  }

  /// Throws what Python raised meanwhile: KeyboardInterrupt, or an error of the progress function.
  void rethrow() const {
    if (raised_) std::rethrow_exception(raised_);
  }

 private:
  /// Twenty times a second: the lock costs more than a short step.
  void look(const scene::Progress& p) {
    const auto now = std::chrono::steady_clock::now();
    if (stop_ || now - last_ < std::chrono::milliseconds(50)) return;
    last_ = now;
    const pybind11::gil_scoped_acquire lock;
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (!progress_.is_none()) progress_(p.time, p.duration, p.time_step, p.reading);
    } catch (const pybind11::error_already_set&) {
      raised_ = std::current_exception();
      stop_ = true;
    }
  }

  pybind11::object progress_;
  std::atomic<bool> stop_{false};
  std::exception_ptr raised_;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace tremie::python
