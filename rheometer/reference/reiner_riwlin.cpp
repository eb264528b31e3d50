#include "rheometer/reference/reiner_riwlin.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace tremie {

namespace {

constexpr double pi = std::numbers::pi;

void require(bool condition, const std::string& what) {
  if (!condition) throw std::invalid_argument(what);
}

bool positive(double x) { return std::isfinite(x) && x > 0.0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0.0; }

/// y - ln(1 + y) without the cancellation at small y.
double excess_minus_log(double y) {
  if (std::abs(y) > 1e-3) return y - std::log1p(y);
  return y * y * (0.5 - y * (1.0 / 3.0 - y * (0.25 - y * (0.2 - y / 6.0))));
}

/// The y >= 0 with y - ln(1 + y) = c. The function is convex, so Newton from the right of the root stays
/// there.
double excess_stress(double c) {
  double y = c + std::sqrt(2.0 * c);  // y - ln(1+y) >= c here
  for (int i = 0; i < 60 && y > 0.0; ++i) {
    const double step = (excess_minus_log(y) - c) * (1.0 + y) / y;
    y -= step;
    if (std::abs(step) <= 1e-15 * y) break;
  }
  return y;
}

double fully_sheared_torque(const Bingham& b, double omega, const Instrument& in) {
  const double a =
      1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (in.container_radius * in.container_radius);
  return 4.0 * pi * in.vane_height *
         (omega * b.mu + b.tau_0 * std::log(in.container_radius / in.vane_radius)) / a;
}

/// Radius where the stress of this torque equals tau_0, R_o at most.
double sheared_radius(const Bingham& b, double torque, const Instrument& in) {
  if (b.tau_0 <= 0.0) return in.container_radius;
  return std::min(in.container_radius, std::sqrt(torque / (2.0 * pi * in.vane_height * b.tau_0)));
}

/// d(mu Omega)/dT at constant tau_0. The plug radius does not enter: mu Omega is stationary in R_s.
double stiffness(double radius, const Instrument& in) {
  return (1.0 / (in.vane_radius * in.vane_radius) - 1.0 / (radius * radius)) / (4.0 * pi * in.vane_height);
}

}  // namespace

void check(const Instrument& in) {
  require(positive(in.vane_radius), "the vane radius must be greater than 0");
  require(positive(in.vane_height), "the vane height must be greater than 0");
  require(std::isfinite(in.container_radius) && in.container_radius > in.vane_radius,
          "the container radius must be greater than the vane radius");
}

CouetteState reiner_riwlin(const Bingham& b, double omega, const Instrument& in) {
  check(in);
  require(not_negative(b.tau_0), "the yield stress must not be negative");
  require(not_negative(b.mu), "the plastic viscosity must not be negative");
  require(not_negative(omega), "the speed must not be negative");

  CouetteState s{.torque = fully_sheared_torque(b, omega, in), .sheared_radius = in.container_radius};
  const double torque_at_yield_of_vane =
      2.0 * pi * in.vane_height * in.vane_radius * in.vane_radius * b.tau_0;
  const double ratio = in.container_radius / in.vane_radius;
  if (b.tau_0 > 0.0 && s.torque < torque_at_yield_of_vane * ratio * ratio) {
    s.plug = true;
    s.torque = torque_at_yield_of_vane * (1.0 + excess_stress(2.0 * b.mu * omega / b.tau_0));
    s.sheared_radius = sheared_radius(b, s.torque, in);
  }
  const double radius = s.sheared_radius, k = stiffness(radius, in);
  if (k > 0.0) {
    s.d_torque_d_mu = omega / k;
    s.d_torque_d_tau_0 = std::log(radius / in.vane_radius) / k;
  } else {  // nothing but the vane's own surface is sheared
    s.d_torque_d_tau_0 = torque_at_yield_of_vane / b.tau_0;
  }
  return s;
}

double reiner_riwlin_speed(const Bingham& b, double torque, const Instrument& in) {
  check(in);
  require(not_negative(b.tau_0), "the yield stress must not be negative");
  require(positive(b.mu), "a speed from a torque needs a plastic viscosity greater than 0");
  require(not_negative(torque), "the torque must not be negative");
  const double radius = sheared_radius(b, torque, in);
  if (radius <= in.vane_radius) return 0.0;
  if (radius < in.container_radius) {  // b.tau_0 > 0
    const double y = torque / (2.0 * pi * in.vane_height * in.vane_radius * in.vane_radius * b.tau_0) - 1.0;
    return b.tau_0 / (2.0 * b.mu) * excess_minus_log(y);
  }
  return std::max(0.0, (torque * stiffness(radius, in) - b.tau_0 * std::log(radius / in.vane_radius)) / b.mu);
}

namespace {

double squared_error(const Bingham& b, std::span<const FlowPoint> points, const Instrument& in) {
  double sum = 0.0;
  for (const FlowPoint& p : points) {
    const double r = p.torque - reiner_riwlin(b, p.omega, in).torque;
    sum += r * r;
  }
  return sum;
}

/// Normal equations J^T J step = J^T r with Marquardt's damping, kept in the quarter plane.
struct Normal {
  double aa = 0, ab = 0, bb = 0, ra = 0, rb = 0;

  Bingham step(Bingham b, double damping) const {
    const double paa = aa * (1.0 + damping), pbb = bb * (1.0 + damping), det = paa * pbb - ab * ab;
    double da = (pbb * ra - ab * rb) / det, db = (paa * rb - ab * ra) / det;
    if (b.tau_0 + da < 0.0) {  // on the edge tau_0 = 0 the other parameter alone is left
      da = -b.tau_0;
      db = (rb - ab * da) / pbb;
    } else if (b.mu + db < 0.0) {
      db = -b.mu;
      da = (ra - ab * db) / paa;
    }
    return {std::max(0.0, b.tau_0 + da), std::max(0.0, b.mu + db)};
  }
};

Normal normal_equations(const Bingham& b, std::span<const FlowPoint> points, const Instrument& in) {
  Normal n;
  for (const FlowPoint& p : points) {
    const CouetteState s = reiner_riwlin(b, p.omega, in);
    const double r = p.torque - s.torque;
    n.aa += s.d_torque_d_tau_0 * s.d_torque_d_tau_0;
    n.ab += s.d_torque_d_tau_0 * s.d_torque_d_mu;
    n.bb += s.d_torque_d_mu * s.d_torque_d_mu;
    n.ra += s.d_torque_d_tau_0 * r;
    n.rb += s.d_torque_d_mu * r;
  }
  return n;
}

/// The fully sheared law is linear in both parameters, so it gives a start; a yield stress is kept in it.
Bingham first_guess(std::span<const FlowPoint> points, const Instrument& in) {
  const auto [low, high] = std::minmax_element(
      points.begin(), points.end(), [](const auto& p, const auto& q) { return p.torque < q.torque; });
  const double full = fully_sheared_torque({1.0, 0.0}, 0.0, in);
  const auto fastest = std::max_element(points.begin(), points.end(),
                                        [](const auto& p, const auto& q) { return p.omega < q.omega; });
  const double tau_0 = 0.5 * low->torque / full;
  const double rest = std::max(high->torque - tau_0 * full, 0.1 * high->torque);
  return {tau_0, rest / fully_sheared_torque({0.0, 1.0}, fastest->omega, in)};
}

/// Where a thin layer at the vane alone is sheared, the torque rises with the root of the viscosity, and the guess above leads to its
/// edge, 0. So a second guess takes the slowest reading for little more than the yield torque, and the layer of the fastest.
Bingham thin_layer_guess(std::span<const FlowPoint> points, const Instrument& in) {
  constexpr double yields = 0.97;
  const auto [slowest, fastest] = std::minmax_element(
      points.begin(), points.end(), [](const auto& p, const auto& q) { return p.omega < q.omega; });
  const double area = 2.0 * pi * in.vane_height * in.vane_radius * in.vane_radius;
  const double tau_0 = yields * slowest->torque / area;
  const double y = std::max(1.0 / yields, fastest->torque / slowest->torque / yields) - 1.0;
  return {tau_0, tau_0 * excess_minus_log(y) / (2.0 * fastest->omega)};
}

Bingham fitted(Bingham best, std::span<const FlowPoint> points, const Instrument& in) {
  double error = squared_error(best, points, in), damping = 1e-3;
  for (int i = 0; i < 200 && damping < 1e12; ++i) {
    const Bingham next = normal_equations(best, points, in).step(best, damping);
    const double next_error = squared_error(next, points, in);
    const bool still = std::abs(next.tau_0 - best.tau_0) <= 1e-15 * next.tau_0 &&
                       std::abs(next.mu - best.mu) <= 1e-15 * next.mu;
    if (next_error < error) {
      best = next;
      error = next_error;
      damping *= 0.05;
    } else {
      damping = std::max(4.0 * damping, 1e-12);
    }
    if (still || error == 0.0) break;
  }
  return best;
}

}  // namespace

Bingham bingham_from_flow_curve(std::span<const FlowPoint> points, const Instrument& in) {
  check(in);
  require(points.size() >= 2, "a flow curve needs at least two points");
  for (const FlowPoint& p : points)
    require(positive(p.omega) && positive(p.torque),
            "every speed and torque of a flow curve must be greater than 0");
  const auto same = [&](const FlowPoint& p) { return p.omega == points.front().omega; };
  require(!std::all_of(points.begin(), points.end(), same),
          "a flow curve needs at least two different speeds");

  const Bingham best = fitted(first_guess(points, in), points, in);
  if (best.mu > 0.0) return best;
  const Bingham other = fitted(thin_layer_guess(points, in), points, in);
  return squared_error(other, points, in) < squared_error(best, points, in) ? other : best;
}

}  // namespace tremie
