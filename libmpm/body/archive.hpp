#pragma once

// State written and read back whole, by one function for both ways: archive(a, b, c) writes the three values, or
// reads them, in this order, byte by byte as they lie in memory. It is for the program that wrote it, and no other.
//
// What is not plain has a function visit(Archive&, T&) beside it that hands its members to the archive.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace tremie {

/// Whether the bytes of a value are all of it. Say so for what holds Eigen's fixed vectors, whose copies the language
/// does not know to be plain.
template <class T>
inline constexpr bool stored_plainly = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;
template <class T>
requires(T::SizeAtCompileTime >
         0) inline constexpr bool stored_plainly<T> = true;  // a fixed vector or matrix
template <class T, std::size_t n>
inline constexpr bool stored_plainly<std::array<T, n>> = stored_plainly<T>;

class Archive {
 public:
  /// Takes so many bytes away.
  using Write = std::function<void(const void*, std::size_t)>;
  /// Fills so many bytes; throws where there are no more.
  using Read = std::function<void(void*, std::size_t)>;

  explicit Archive(Write write) : write_(std::move(write)) {}
  /// Of `left` bytes in all.
  Archive(Read read, std::uint64_t left) : read_(std::move(read)), left_(left) {}

  bool reads() const { return static_cast<bool>(read_); }

  /// Throws std::length_error where more is read than there is.
  template <class... T>
  void operator()(T&... values) {
    (one(values), ...);
  }

 private:
  void bytes(void* data, std::size_t n) {
    if (!reads()) return write_(data, n);
    if (n > left_) throw std::length_error("the state is shorter than what it describes");
    left_ -= n;
    read_(data, n);
  }

  template <class T>
  void one(T& value) {
    if constexpr (stored_plainly<T>)
      bytes(&value, sizeof value);
    else
      visit(*this, value);
  }
  /// A list's length, so that none can be asked for that the rest could not fill.
  std::size_t length_of(std::size_t now, std::size_t least_bytes) {
    std::uint64_t n = now;
    one(n);
    if (reads() && n > left_ / least_bytes)
      throw std::length_error("the state is shorter than what it describes");
    return static_cast<std::size_t>(n);
  }
  template <class T>
  void one(std::vector<T>& list) {
    const std::size_t n = length_of(list.size(), stored_plainly<T> ? sizeof(T) : 1);
    if (reads()) list.resize(n);
    if constexpr (stored_plainly<T>) {
      if (n > 0) bytes(list.data(), n * sizeof(T));
    } else {
      for (T& value : list) one(value);
    }
  }
  template <class T, std::size_t n>
  requires(!stored_plainly<T>) void one(std::array<T, n>& list) {
    for (T& value : list) one(value);
  }
  void one(std::string& text) {
    text.resize(length_of(text.size(), 1));
    if (!text.empty()) bytes(text.data(), text.size());
  }

  Write write_;
  Read read_;
  std::uint64_t left_ = 0;
};

/// Hands a state to an archive, either way.
using VisitState = std::function<void(Archive&)>;

}  // namespace tremie
