// The paper's runs as the code that it names takes them, in plain loops, with a key for each thing that the
// text leaves open. One quarter, explicit USF, GIMP, FLIP, Papanastasiou with m = 5 s.
//
//   paper_code [key=value]...     keys and what they stand for unless set: `keys` below
//
// One line: the keys that were set; peak of the mean shear rate over points, at any step and at every tenth
// of a second [1/s]; lambda at the start, at the end, and without build-up; shear summed up over time; spread
// as Tremie reads it, over 99 % of the concrete and between the outermost points [mm]; volume change.

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>

#include "apparatus/parts/cone/cone.hpp"
#include "apparatus/parts/cone/spread.hpp"
#include "libmpm/grid/tiles.hpp"

namespace tremie::cone {
namespace {

std::map<std::string, double> values;
double& key(const char* name, double fallback) { return values[name] = fallback; }
namespace keys {
// Mix 0, 1, 2: A, B, C; its rest and the run [s], its alpha, and the rate under which lambda builds up [1/s].
double &mix = key("mix", 0), &rest = key("rest", 0), &seconds = key("seconds", 20),
       &alpha = key("alpha", 0.01), &gate = key("gate", 0.1);
double &cell = key("cell", 0.015), &dt = key("dt", 1e-4);  // [m], [s]
// Half of a point's extent, in cells; the code's own: 1 over twice the number of points in a cell.
double& extent = key("extent", 0.25);
// What the off-diagonal parts of D are taken times, and how often each of them counts in D:D.
double &shear = key("shear", 1), &counted = key("counted", 2);
double& trace = key("trace", 0);  // 1: D with its volume part in shear rate and stress
double& point_force =
    key("point_force", 0);  // 1: the pressure acts with the point's gradients, not its cell's
double& fixed_volume = key("fixed_volume", 0);  // 1: points keep the volume that they start with
double& hydrostatic = key("hydrostatic", 1);    // 0: no pressure at the start
double& pic = key("pic", 0);                    // 1: points take the velocity of the nodes
double& coast = key("coast", 0);  // 1: a floor node that friction should stop coasts (cb-geo/mpm, issue 639)
// The cone: rigid points on the same grid [m/s], none at 0; their density [kg/m^3].
double &lift = key("lift", 0.15), &cone_density = key("cone_density", 7850);
}  // namespace keys

constexpr int D = 3;
constexpr double g = 9.81, density = 2400.0, m = 5.0;
const double K = 1e4 / (3.0 * (1.0 - 2.0 * 0.45));
struct PaperMix {
  double tau_0, mu, A_thix, friction;
};
constexpr PaperMix mixes[] = {{54, 35.8, 1.3, 0.35}, {61, 29, 1.8, 0.45}, {130, 30.2, 2.9, 0.43}};

/// A material point; lane 3 of v is 1, so that m v is momentum and mass at once.
struct Point {
  f64x4 x{}, v{0, 0, 0, 1};
  double mass = 0, V = 0, ln_J = 0, lambda = 0, broken = 0;  ///< broken: lambda without build-up
  double rate = 0;
  bool rigid = false;
  // Of this step:
  std::array<int, D> base{};
  double w[D][3], dw[D][3];
  std::array<int, D> cell{};
};

/// Nodes of a box; index 0 lies on the walls x = 0, y = 0, z = 0.
struct Grid {
  double h;
  std::array<int, D> n, high{};  ///< nodes a side, with one beyond; the highest in use
  std::vector<f64x4> v, f;
  std::size_t at(int i, int j, int k) const {
    return (static_cast<std::size_t>(i + 1) * n[1] + static_cast<std::size_t>(j + 1)) * n[2] +
           static_cast<std::size_t>(k + 1);
  }
};

/// Hats averaged over the point's extent; without extent next to the node on a wall.
void weigh(const Grid& grid, double extent, Point& p) {
  for (int d = 0; d < D; ++d) {
    const double X = p.x[d] / grid.h, nearest = std::floor(X + 0.5), u = X - nearest;
    const double half = nearest == 0.0 ? 1e-12 : extent, whole = 2.0 * half;
    const double below = std::min(std::max(half - u, 0.0), whole),
                 above = std::min(std::max(half + u, 0.0), whole);
    double *const w = p.w[d], *const dw = p.dw[d];
    dw[0] = -below / whole / grid.h, dw[2] = above / whole / grid.h, dw[1] = -dw[0] - dw[2];
    w[0] = 0.5 * below * below / whole + std::max(-u - half, 0.0);
    w[2] = 0.5 * above * above / whole + std::max(u - half, 0.0);
    w[1] = 1.0 - w[0] - w[2];
    p.base[d] = static_cast<int>(nearest) - 1;
    p.cell[d] = static_cast<int>(std::floor(X));
  }
}

/// visit(node, N, gradient) for the 27 nodes of a point; lane 3 of the gradient is 0.
template <class Visit>
[[gnu::always_inline]] inline void for_nodes(const Grid& grid, const Point& p, Visit visit) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const std::size_t row = grid.at(p.base[0] + i, p.base[1] + j, p.base[2]);
      const double ww = p.w[0][i] * p.w[1][j], dx = p.dw[0][i] * p.w[1][j], dy = p.w[0][i] * p.dw[1][j];
      for (int k = 0; k < 3; ++k)
        visit(row + static_cast<std::size_t>(k), ww * p.w[2][k],
              f64x4{dx * p.w[2][k], dy * p.w[2][k], ww * p.dw[2][k], 0.0});
    }
}

/// The same for the 8 corners of its cell, with the gradients at its centre.
template <class Visit>
[[gnu::always_inline]] inline void for_corners(const Grid& grid, const Point& p, Visit visit) {
  const double slope = 0.25 / grid.h;
  for (int c = 0; c < 8; ++c)
    visit(grid.at(p.cell[0] + (c & 1), p.cell[1] + (c >> 1 & 1), p.cell[2] + (c >> 2)),
          f64x4{c & 1 ? slope : -slope, c & 2 ? slope : -slope, c & 4 ? slope : -slope, 0.0});
}

template <class Visit>
void for_used(const Grid& grid, Visit visit) {
  for (int i = -1; i <= grid.high[0]; ++i)
    for (int j = -1; j <= grid.high[1]; ++j)
      for (int k = -1; k <= grid.high[2]; ++k) visit(grid.at(i, j, k), i, j, k);
}

void hold_at_walls(int i, int j, int k, f64x4& v) {
  if (i <= 0) v[0] = 0.0;
  if (j <= 0) v[1] = 0.0;
  if (k <= 0) v[2] = 0.0;
}

struct Deviator {
  double diagonal[D], xy, yz, xz;
};

/// Viscous stress of a point from L[b][a] = dv_a/dx_b; breaks lambda down, or builds it up, over dt.
Deviator update_state(const PaperMix& mix, const f64x4 (&L)[D], double dt, Point& p) {
  const double shear = 0.5 * keys::shear, third = keys::trace > 0 ? 0.0 : 1.0 / 3.0;
  const double div = L[0][0] + L[1][1] + L[2][2];
  Deviator tau{{L[0][0] - third * div, L[1][1] - third * div, L[2][2] - third * div},
               shear * (L[1][0] + L[0][1]),
               shear * (L[2][1] + L[1][2]),
               shear * (L[2][0] + L[0][2])};
  double sum = keys::counted * (tau.xy * tau.xy + tau.yz * tau.yz + tau.xz * tau.xz);
  for (double d : tau.diagonal) sum += d * d;
  const double rate = p.rate = std::sqrt(2.0 * sum), decay = std::exp(-keys::alpha * rate * dt);
  p.broken *= decay;
  p.lambda = rate < keys::gate ? p.lambda + mix.A_thix / mix.tau_0 * dt : p.lambda * decay;
  const double x = m * rate;
  const double secant = (1.0 + p.lambda) * mix.tau_0 * (x > 1e-6 ? -std::expm1(-x) / rate : m);
  const double eta = 2.0 * (mix.mu + secant);
  for (double& d : tau.diagonal) d *= eta;
  tau.xy *= eta, tau.yz *= eta, tau.xz *= eta;
  return tau;
}

/// Deforms a point and gives the nodes its forces.
void stress(const PaperMix& mix, double dt, Grid& grid, Point& p) {
  f64x4 L[D] = {};  // L[b][a] = dv_a/dx_b
  for_nodes(grid, p, [&](std::size_t n, double, const f64x4& dN) {
    for (int b = 0; b < D; ++b) L[b] += dN[b] * grid.v[n];
  });
  const Deviator tau = update_state(mix, L, dt, p);
  double divergence = 0.0;
  for_corners(grid, p, [&](std::size_t n, const f64x4& dN) {
    const f64x4 part = dN * grid.v[n];
    divergence += part[0] + part[1] + part[2];
  });
  p.ln_J += divergence * dt;
  if (keys::fixed_volume == 0) p.V *= std::exp(divergence * dt);
  const double pressure = -K * p.ln_J, own = keys::point_force > 0 ? pressure : 0.0;
  const f64x4 s[D] = {-p.V * f64x4{tau.diagonal[0] - own, tau.xy, tau.xz, 0.0},
                      -p.V * f64x4{tau.xy, tau.diagonal[1] - own, tau.yz, 0.0},
                      -p.V * f64x4{tau.xz, tau.yz, tau.diagonal[2] - own, 0.0}};
  for_nodes(grid, p, [&](std::size_t n, double, const f64x4& dN) {
    grid.f[n] += dN[0] * s[0] + dN[1] * s[1] + dN[2] * s[2];
  });
  if (keys::point_force == 0)
    for_corners(grid, p, [&](std::size_t n, const f64x4& dN) { grid.f[n] += p.V * pressure * dN; });
}

/// Acceleration of a floor node under Coulomb friction, before its normal part is taken away.
void rub(double friction, double dt, const f64x4& v, f64x4& a) {
  if (a[2] >= 0.0) return;
  const double least = -friction * a[2] * dt, ux = v[0] + a[0] * dt, uy = v[1] + a[1] * dt;
  const double u = std::hypot(ux, uy);
  if (u > least) {
    a[0] -= least / dt * ux / u, a[1] -= least / dt * uy / u;
  } else {
    const double over = keys::coast > 0 ? 1.0 : dt;
    a[0] = -v[0] / over, a[1] = -v[1] / over;
  }
}

void step(const PaperMix& mix, double dt, Grid& grid, std::vector<Point>& points) {
  const double friction = mix.friction, extent = keys::extent;
  grid.high = {};
  for (Point& p : points) {
    weigh(grid, extent, p);
    for (int d = 0; d < D; ++d) grid.high[d] = std::max(grid.high[d], p.base[d] + 2);
  }
  for_used(grid, [&](std::size_t n, int, int, int) { grid.v[n] = grid.f[n] = f64x4{}; });
  for (const Point& p : points) {
    const f64x4 momentum = p.mass * p.v;
    for_nodes(grid, p, [&](std::size_t n, double N, const f64x4&) { grid.v[n] += N * momentum; });
  }
  for_used(grid, [&](std::size_t n, int i, int j, int k) {
    f64x4& v = grid.v[n];
    const double mass = v[3];
    if (mass > 1e-15) v = v / mass;
    v[3] = mass;
    hold_at_walls(i, j, k, v);
  });
  for (Point& p : points)
    if (!p.rigid) stress(mix, dt, grid, p);
  for_used(grid, [&](std::size_t n, int i, int j, int k) {
    f64x4 &v = grid.v[n], &a = grid.f[n];
    const double mass = v[3];
    a = mass > 1e-15 ? a / mass + f64x4{0, 0, -g, 0} : f64x4{};
    if (k <= 0) rub(friction, dt, v, a);
    hold_at_walls(i, j, k, a);
    a[3] = 0.0;
    v += dt * a;
  });
  for (Point& p : points) {
    f64x4 v = {}, a = {};
    for_nodes(grid, p,
              [&](std::size_t n, double N, const f64x4&) { v += N * grid.v[n], a += N * grid.f[n]; });
    v[3] = 0.0;
    if (p.rigid) v = p.v, v[3] = 0.0;
    if (!p.rigid) p.v = keys::pic > 0 ? v + f64x4{0, 0, 0, 1} : p.v + dt * a;
    p.x += dt * v;
    for (int d = 0; d < D; ++d) p.x[d] = std::max(p.x[d], 1e-6 * grid.h);
  }
}

Point point_at(const Vec<D>& x, double V, const PaperMix& mix) {
  Point p;
  p.x = f64x4{x[0], x[1], x[2], 0.0}, p.V = V, p.mass = density * V;
  p.lambda = p.broken = mix.A_thix * keys::rest / mix.tau_0;
  return p;
}

std::vector<Point> filled(const Cone& cone, const PaperMix& mix, double h) {
  std::vector<Point> points;
  const double spacing = 0.5 * h, wall = 0.75 * h;
  for (double z = 0.5 * spacing; z < cone.height; z += spacing)
    for (double y = 0.5 * spacing; y < 2.0 * cone.bottom_radius; y += spacing)
      for (double x = 0.5 * spacing; x < 2.0 * cone.bottom_radius; x += spacing) {
        const double outside = std::hypot(x, y) - inner_radius(cone, z);
        if (outside > wall || (outside > 0.0 && keys::lift == 0.0)) continue;
        Point& p = points.emplace_back(point_at({x, y, z}, std::pow(spacing, 3), mix));
        p.rigid = outside > 0.0;
        if (p.rigid) p.mass = keys::cone_density * p.V, p.v[2] = keys::lift;
      }
  if (keys::hydrostatic > 0)
    for (Point& p : points)
      if (!p.rigid) p.ln_J = -density * g * (cone.height - p.x[2]) / K;
  return points;
}

/// Diameter within which 99 % of the points are.
double diameter_of_99(const Points<D>& points) {
  std::vector<double> r;
  for (const Vec<D>& x : points.x) r.push_back(x.head<2>().norm());
  std::sort(r.begin(), r.end());
  return r.empty() ? 0.0 : 2.0 * r[r.size() * 99 / 100];
}

struct Means {
  double rate = 0, lambda = 0, broken = 0, volume = 0;
};
Means means(const std::vector<Point>& points) {
  Means sum;
  double n = 0;
  for (const Point& p : points)
    if (!p.rigid)
      n += 1, sum.rate += p.rate, sum.lambda += p.lambda, sum.broken += p.broken, sum.volume += p.V;
  sum.rate /= n, sum.lambda /= n, sum.broken /= n;
  return sum;
}

/// A stray point that would leave the grid is given up.
bool outside(const Grid& grid, const Point& p) {
  for (int d = 0; d < D; ++d)
    if (!(p.x[d] < (grid.n[static_cast<std::size_t>(d)] - 5) * grid.h)) return true;
  return false;
}

void run_keys() {
  const PaperMix& mix = mixes[static_cast<int>(keys::mix)];
  const Cone cone;
  const double h = keys::cell, dt = keys::dt;
  Grid grid{.h = h, .n = {}, .v = {}, .f = {}};
  grid.n = {static_cast<int>(0.6 / h), static_cast<int>(0.6 / h), static_cast<int>(0.9 / h)};
  grid.v.assign(static_cast<std::size_t>(grid.n[0] * grid.n[1] * grid.n[2]), f64x4{});
  grid.f = grid.v;
  std::vector<Point> points = filled(cone, mix, h);
  const Means start = means(points);
  double peak = 0, sampled = 0, shear = 0;
  const auto steps = static_cast<long>(std::lround(keys::seconds / dt)), tenth = std::lround(0.1 / dt);
  for (long s = 1; s <= steps; ++s) {
    step(mix, dt, grid, points);
    const bool gone = static_cast<double>(s) * dt * keys::lift > 0.35;
    std::erase_if(points, [&](const Point& p) { return p.rigid ? gone : outside(grid, p); });
    const double rate = means(points).rate;
    peak = std::max(peak, rate), shear += rate * dt;
    if (s % tenth == 0) sampled = std::max(sampled, rate);
    if (!std::isfinite(rate)) break;
    if (s % (50 * tenth) == 0 && s < steps)
      fmt::print(stderr, "{:.0f} s: {:.3f} 1/s, lambda {:.3f} {:.3f}\n", static_cast<double>(s) * dt, rate,
                 means(points).lambda, means(points).broken);
  }
  Points<D> left;
  double widest = 0;
  for (const Point& p : points)
    if (!p.rigid) {
      add_point<D>(left, {p.x[0], p.x[1], p.x[2]}, p.mass, p.V, 0.0);
      widest = std::max({widest, p.x[0], p.x[1]});
    }
  const Means end = means(points);
  fmt::print(
      "{} points | {:.2f} {:.2f} | {:.2f} -> {:.2f} {:.2f}, {:.2f} | {:.1f} {:.1f} {:.1f} | {:.1f} %\n",
      left.size(), peak, sampled, start.lambda, end.lambda, end.broken, shear, 1e3 * spread(left, h, true),
      1e3 * diameter_of_99(left), 2e3 * widest, 100.0 * (end.volume / start.volume - 1.0));
}

}  // namespace
}  // namespace tremie::cone

int main(int argc, char** argv) {
  auto& values = tremie::cone::values;
  for (int i = 1; i < argc; ++i) {
    const std::string set = argv[i];
    const auto sign = set.find('=');
    const auto at = values.find(set.substr(0, sign));
    if (sign == std::string::npos || at == values.end()) {
      fmt::print(stderr, "no key: {}\n", set);
      return 2;
    }
    at->second = std::atof(set.c_str() + sign + 1);
    fmt::print("{} ", set);
  }
  fmt::print("| ");
  tremie::cone::run_keys();
}
