#pragma once

// Results as NumPy arrays that own the buffers which C++ filled: nothing is copied.

#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <vector>

namespace tremie::python {

namespace py = pybind11;

namespace detail {

template <class T>
py::array owning(std::vector<T>&& values, const std::vector<py::ssize_t>& shape) {
  auto kept = std::make_unique<std::vector<T>>(std::move(values));
  const auto* first = reinterpret_cast<const double*>(kept->data());
  const py::capsule owner(kept.get(), [](void* p) { delete static_cast<std::vector<T>*>(p); });
  kept.release();
  return py::array_t<double>(shape, first, owner);
}

}  // namespace detail

/// n values, shape (n,).
inline py::array array_of(std::vector<double>&& values) {
  const auto n = static_cast<py::ssize_t>(values.size());
  return detail::owning(std::move(values), {n});
}

/// n vectors, shape (n, 3).
inline py::array array_of(std::vector<std::array<double, 3>>&& values) {
  const auto n = static_cast<py::ssize_t>(values.size());
  return detail::owning(std::move(values), {n, 3});
}

}  // namespace tremie::python
