#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "libmpm/boundary/contact.hpp"
#include "libmpm/constitutive/equation_of_state.hpp"
#include "libmpm/particles/particles.hpp"

namespace tremie {

/// A moving rigid wall as seen from a point near it.
template <int D>
struct WallView {
  double gap = 0.0;  ///< signed distance, positive in the concrete [m]
  Vec<D> normal;     ///< from the wall into the concrete
  Vec<D> velocity;   ///< of the wall [m/s]
};

/// A rigid wall as a signed distance with a motion; empty where the wall is too far to matter. An empty
/// function is no wall, and costs nothing. Threads may ask it at once.
template <int D>
using RigidWall = std::function<std::optional<WallView<D>>(const Vec<D>& x, double time)>;

/// Time in which an overlap with a wall is closed at the soonest [s].
inline constexpr double contact_relaxation = 1e-3;

/// Factor on the contact penalty of a wall that moves with `speed` [m/s]; it rises as the wall slows down. Penetration adds up
/// over the steps in which the wall passes, so a slower wall, which takes more steps, must let less through in each. The
/// constants are calibrated: about a hundredth of the concrete goes through a cone lifted at 5 to 50 mm/s (lift.md).
inline double slow_wall_factor(double speed) {
  constexpr double fast = 0.15, most = 100.0;  // [m/s], [1]
  return std::clamp(std::pow(fast / std::max(speed, 1e-3 * fast), 2.3), 1.0, most);
}

/// Contact of the points with a wall over a step of length dt that ends at `time`.
/// `gap_min`: how near a point may come, its half spacing [m]; `penalty`: stiffness in units of m/dt, more
/// where that would let the point's pressure push it through; `K`: bulk modulus [Pa].
template <int D>
std::vector<ContactPoint<D>> find_contact(const ActiveGrid<D>& grid, const Points<D>& points,
                                          const RigidWall<D>& wall, double time, double dt, double gap_min,
                                          double penalty, double K) {
  std::vector<ContactPoint<D>> contact;
  if (!wall) return contact;
  for (int c = 0; c < grid.n_cells(); ++c)
    for (int i = grid.cell_begin[c]; i < grid.cell_begin[c + 1]; ++i) {
      const int p = grid.order[i];
      const auto view = wall(points.x[p], time);
      if (!view) continue;
      const Vec<D> s = local_coordinates<D>(grid.axes, grid.cell_index[c], points.x[p]);
      ContactPoint<D> contact_point;
      contact_point.cell = c;
      for (int d = 0; d < D; ++d)
        contact_point.along[d] = splines(grid.axes[d], grid.cell_index[c][d], s[d]).N;
      contact_point.normal = view->normal;
      // The wall already stands where it is at the end of the step: what is missing of the gap is closed by
      // then, at most a tenth of a cell a step so that a deep overlap does not shoot a point off.
      const double reach = 0.1 * grid.cell_size_min();
      contact_point.target = std::min((gap_min - view->gap) / dt, reach / dt);
      // Points are seeded some microns too near: closed within a step that is shorter than
      // `contact_relaxation`, that would be a speed like 1/dt out of nothing. It is closed slowly, and the
      // wall's own motion is followed.
      const double wall_speed = view->normal.dot(view->velocity),
                   overlap = gap_min - view->gap - wall_speed * dt;
      if (dt < contact_relaxation && overlap > 0.0)
        contact_point.target = std::min(contact_point.target, wall_speed + overlap / contact_relaxation);
      // A layer of the points' spacing, 2 gap_min, under the pressure p gives way by p dt^2 / (2 rho gap_min)
      // over the penalty: no farther than the points are kept from the wall, nor than a step gives back.
      const double rho = points.mass[p] / points.volume(p),
                   p_wall = std::max(0.0, pressure(points.ln_J[p], K));
      const double needed = slow_wall_factor(view->velocity.norm()) * p_wall * dt * dt /
                            (2.0 * rho * gap_min * std::min(gap_min, reach));
      contact_point.stiffness = std::max(penalty, needed) * points.mass[p] / dt;
      contact.push_back(contact_point);
    }
  contact.shrink_to_fit();
  return contact;
}

/// Puts points back on their side of a slow wall that a step from `before` to `after` has taken through it: contact gives way a
/// little, and what evens the points out knows no wall. `from`: where they were; `margin`: how far off the wall [m].
template <int D>
void keep_on_its_side(const RigidWall<D>& wall, double before, double after, const std::vector<Vec<D>>& from,
                      double margin, std::vector<Vec<D>>& x) {
#pragma omp parallel for schedule(static)
  for (std::size_t p = 0; p < x.size(); ++p) {
    const auto now = wall(x[p], after);
    if (!now || now->gap >= 0.0 || slow_wall_factor(now->velocity.norm()) == 1.0) continue;
    const auto then = wall(from[p], before);
    if (then && then->gap >= 0.0) x[p] += (margin - now->gap) * now->normal;
  }
}

}  // namespace tremie
