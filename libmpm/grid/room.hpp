#pragma once

#include <cstddef>
#include <vector>

namespace tremie {

/// Gives back what a vector holds; `v = {}` would keep its room.
template <class T>
void give_back(std::vector<T>& v) {
  std::vector<T>().swap(v);
}

/// Room for n values that are to be written anew: no more than n, and never the old ones beside the new.
template <class T>
void make_room(std::vector<T>& v, std::size_t n) {
  if (n > v.capacity()) {
    give_back(v);
    v.reserve(n);
  }
  v.resize(n);
}

}  // namespace tremie
