#pragma once

// An opening through which concrete leaves the run. Points beyond it are taken out between two steps and their volume and
// mass are counted; those that stay keep their order, so that nothing depends on the number of threads. What belongs to
// cells and nodes is made anew from the points by the next step.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "libmpm/particles/particles.hpp"

namespace tremie {

/// The half space normal . x > offset: a point in it has left. `normal` is a unit vector.
template <int D>
struct Outlet {
  Vec<D> normal = Vec<D>::Zero();
  double offset = 0.0;  ///< [m]

  bool lets_out(const Vec<D>& x) const { return normal.dot(x) > offset; }
};

/// What has left so far.
struct Outflow {
  double volume = 0.0;  ///< as it left [m^3]
  double mass = 0.0;    ///< [kg]
  std::int64_t points = 0;
};

namespace detail {

/// Keeps the entries of an array with one for each point; an empty array stays empty.
template <class T>
void keep_entries(const std::vector<std::size_t>& kept, std::vector<T>& entries) {
  if (entries.empty()) return;
  for (std::size_t i = 0; i < kept.size(); ++i) entries[i] = entries[kept[i]];
  entries.resize(kept.size());
}

}  // namespace detail

/// Takes the points beyond the outlet out of the run and adds them to what has left.
template <int D>
void let_out(const Outlet<D>& outlet, Points<D>& points, Outflow& left) {
  std::vector<std::size_t> kept;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!outlet.lets_out(points.x[p])) {
      kept.push_back(p);
      continue;
    }
    left.volume += points.volume(p);
    left.mass += points.mass[p];
    ++left.points;
  }
  if (kept.size() == points.size()) return;
  detail::keep_entries(kept, points.x);
  detail::keep_entries(kept, points.v);
  detail::keep_entries(kept, points.C);
  for (std::vector<double>* entries :
       {&points.mass, &points.V0, &points.ln_J, &points.lambda, &points.gamma_dot})
    detail::keep_entries(kept, *entries);
  for (std::vector<double>& part : points.lambda_parts) detail::keep_entries(kept, part);
}

}  // namespace tremie
