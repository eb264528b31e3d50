#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace tremie {

/// Gives back what a vector holds; `v = {}` would keep its memory.
template <class T>
void release(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

/// Gives the system back what lies free within the heap, some twentieth of a large body's memory.
inline void release_free_heap() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

/// Asks the system to keep a large block in large pages: a body of a million points is read in order, over
/// and over, and the processor does not know the places of as many small pages at once. Does nothing where
/// the system has none.
inline void ask_for_large_pages([[maybe_unused]] void* block, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__) && defined(MADV_HUGEPAGE)
  constexpr std::uintptr_t page = 1 << 21;
  const auto begin = reinterpret_cast<std::uintptr_t>(block);
  const std::uintptr_t first = (begin + page - 1) / page * page, last = (begin + bytes) / page * page;
  if (last >= first + page) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

/// Room for n values that are to be written anew: no more than n, and never the old ones beside the new.
template <class T>
void resize_for_overwrite(std::vector<T>& v, std::size_t n) {
  if (n > v.capacity()) {
    release(v);
    v.reserve(n);
    ask_for_large_pages(v.data(), n * sizeof(T));
  }
  v.resize(n);
}

}  // namespace tremie
