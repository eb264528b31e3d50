#pragma once

// Work in processes of their own, some at a time: one that crashes or is killed ends itself alone.

#include <atomic>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>

namespace tremie::study {

struct Finished {
  std::size_t item = 0;
  std::optional<std::string> text;  ///< what the work returned; empty where its process died
  std::string death;                ///< how it died: "killed by signal 9 (Killed)"
};

/// Runs work(item) for every item, `jobs` at a time, each in a process forked from this one, and hands what
/// it returned to `done` in this process as it comes. False where `stop` ended it early; what was under way is
/// then lost. Throws std::runtime_error where no process can be made.
bool run_pool(std::span<const std::size_t> items, int jobs,
              const std::function<std::string(std::size_t)>& work,
              const std::function<void(const Finished&)>& done, const std::atomic<bool>* stop = nullptr);

}  // namespace tremie::study
