#include "rheometer/reference/thixotropic_couette.hpp"

#include <ida/ida.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/reference/couette_layer.hpp"
#include "rheometer/reference/kinetics_equations.hpp"
#include "rheometer/reference/sundials_support.hpp"

namespace tremie {

namespace {

/// A part of lambda: its share and the kinetics of lambda_i/share_i.
struct Part {
  double share = 1.0;
  Kinetics kinetics;
};

/// The discretised gap. Unknowns: the parts of lambda at the n nodes, node by node, then s = T/(2 pi h R_i^2), the stress
/// at the vane [Pa].
struct Gap {
  double tau_0 = 0.0, mu = 0.0, build_rate = 0.0, gamma_c = 0.0, dx = 0.0;
  double power = 1.0;       ///< 1/n: the shear rate is excess^(1/n)
  std::vector<Part> parts;  ///< one where kinetics have no modes
  bool gated = true, find_gate = true;
  std::vector<double> x, stress_share;  ///< ln(r/R_i) and (R_i/r)^2 of the nodes
  std::vector<char> flowing;            ///< the gate's side, gated alone
  std::function<double(double)> omega;
  double compliance = 0.0;       ///< int exp(-2 x) dx / G over the whole gap [1/Pa]; 0: rigid below yield
  std::vector<LayerMean> means;  ///< of the rate that breaks structure down; none: the rate at the node
  std::unique_ptr<BandMatrix> band = {};  ///< of Newton's system with these

  std::size_t nodes() const { return x.size(); }
  /// Of the interval before node i.
  double interval(std::size_t i) const { return power == 1.0 ? dx : x[i] - x[i - 1]; }
  std::size_t unknowns() const { return nodes() * parts.size(); }  ///< but for s, which stands behind them

  double lambda(std::size_t i, std::span<const double> y) const {
    const double* part = &y[i * parts.size()];
    double sum = part[0];
    for (std::size_t j = 1; j < parts.size(); ++j) sum += part[j];
    return sum;
  }

  /// Excess stress over mu [(1/s)^n]; negative: the material does not yield.
  double excess(std::size_t i, std::span<const double> y) const {
    return (y[unknowns()] * stress_share[i] - (1.0 + lambda(i, y)) * tau_0) / mu;
  }

  /// Shear rate of an excess, which stands for itself where it is negative.
  double rate(double e) const { return power == 1.0 || !(e > 0.0) ? e : std::pow(e, power); }

  /// Its derivative; at the plug's edge, where it is infinite for n > 1, that of a small excess.
  double slope(double e) const {
    return power == 1.0 ? 1.0 : power * std::pow(std::max(e, 1e-9), power - 1.0);
  }

  /// The shear rate at node i, or a negative number.
  double gamma_dot(std::size_t i, std::span<const double> y) const { return rate(excess(i, y)); }

  bool flows(std::size_t i, double gamma_dot) const {
    if (!gated) return true;
    return find_gate ? flowing[i] != 0 : gamma_dot >= gamma_c;
  }

  /// Of part j, whose value is `value`.
  double rate_of_part(std::size_t i, std::size_t j, double value, double gamma_dot) const {
    const Part& p = parts[j];
    return p.share * kinetics_equations::rate_of_lambda(p.kinetics, build_rate, value / p.share,
                                                        std::max(0.0, gamma_dot), flows(i, gamma_dot));
  }
};

/// int over one interval of the positive part of a linear function with end values a and b, and its
/// derivatives.
struct PositivePart {
  double integral = 0.0, d_a = 0.0, d_b = 0.0;
};

PositivePart positive_part(double a, double b, double dx) {
  if (a >= 0.0 && b >= 0.0) return {0.5 * dx * (a + b), 0.5 * dx, 0.5 * dx};
  if (a <= 0.0 && b <= 0.0) return {};
  const bool falling = a > b;
  const double top = falling ? a : b, bottom = falling ? b : a;
  const double q = top / (top - bottom);  // share of the interval that is sheared
  const double by_top = dx * q * (1.0 - 0.5 * q), by_bottom = 0.5 * dx * q * q;
  return {0.5 * dx * top * q, falling ? by_top : by_bottom, falling ? by_bottom : by_top};
}

/// int over one interval of the power p of a linear function's positive part, as above for p = 1.
PositivePart positive_power(double a, double b, double p, double dx) {
  if (a <= 0.0 && b <= 0.0) return {};
  const bool falling = a > b;
  const double top = falling ? a : b, bottom = falling ? b : a;
  if (bottom > 0.5 * top) {  // Gauss' rule of three points: the closed form cancels
    static constexpr double at[] = {0.1127016653792583, 0.5, 0.8872983346207417};
    static constexpr double weight[] = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    PositivePart part;
    for (int k = 0; k < 3; ++k) {
      const double e = a + (b - a) * at[k], value = dx * weight[k] * std::pow(e, p), slope = p * value / e;
      part.integral += value, part.d_a += slope * (1.0 - at[k]), part.d_b += slope * at[k];
    }
    return part;
  }
  const double low = std::max(0.0, bottom), width = top - bottom, of_top = std::pow(top, p),
               of_low = low > 0.0 ? std::pow(low, p) : 0.0;
  const double mean = (of_top * top - of_low * low) / ((p + 1.0) * width);
  const double by_top = dx * (of_top - mean) / width, by_bottom = dx * (mean - of_low) / width;
  return {dx * mean, falling ? by_top : by_bottom, falling ? by_bottom : by_top};
}

/// The speed that the state turns the vane at; d_excess[i] (if given) receives its derivative by the excess
/// at node i.
double speed_of(const Gap& gap, std::span<const double> y, std::vector<double>* d_excess) {
  if (d_excess) d_excess->assign(gap.nodes(), 0.0);
  double sum = 0.0, left = gap.excess(0, y);
  for (std::size_t i = 1; i < gap.nodes(); ++i) {
    const double right = gap.excess(i, y);
    const PositivePart part = gap.power == 1.0 ? positive_part(left, right, gap.dx)
                                               : positive_power(left, right, gap.power, gap.interval(i));
    sum += part.integral;
    if (d_excess) {
      (*d_excess)[i - 1] += part.d_a;
      (*d_excess)[i] += part.d_b;
    }
    left = right;
  }
  return sum;
}

/// int gamma_dot dx over each interval, with its derivatives.
void integrate_intervals(const Gap& gap, std::span<const double> y, std::vector<PositivePart>& intervals) {
  intervals.clear();
  double left = gap.excess(0, y);
  for (std::size_t i = 1; i < gap.nodes(); ++i) {
    const double right = gap.excess(i, y);
    intervals.push_back(gap.power == 1.0 ? positive_part(left, right, gap.dx)
                                         : positive_power(left, right, gap.power, gap.interval(i)));
    left = right;
  }
}

/// The shear rates that break structure down at the nodes, where they are means over a layer; nothing where they are
/// those at the nodes.
std::span<const double> mean_rates(const Gap& gap, std::span<const double> y, std::vector<double>& rates) {
  if (gap.means.empty()) return {};
  std::vector<PositivePart> intervals;
  integrate_intervals(gap, y, intervals);
  rates.assign(gap.nodes(), 0.0);
  for (std::size_t i = 0; i < gap.nodes(); ++i)
    for (std::size_t k = 0; k < gap.means[i].weight.size(); ++k)
      rates[i] += gap.means[i].weight[k] * intervals[gap.means[i].first + k].integral;
  return rates;
}

/// d(speed)/d(s) given the derivatives by the excess.
double speed_by_stress(const Gap& gap, const std::vector<double>& d_excess) {
  double sum = 0.0;
  for (std::size_t i = 0; i < gap.nodes(); ++i) sum += d_excess[i] * gap.stress_share[i];
  return sum / gap.mu;
}

/// Puts the s into y that turns the vane at omega. A Bingham material's speed is convex in s, so Newton from above stays
/// above; that of another power is kept between its bounds.
void solve_stress(const Gap& gap, std::span<double> y, double omega) {
  double& s = y[gap.unknowns()];
  double low = 0.0;
  s = (1.0 + gap.lambda(0, y)) * gap.tau_0 + gap.mu * omega;
  while (speed_of(gap, y, nullptr) < omega) low = s, s *= 2.0;
  double high = s;
  std::vector<double> d_excess;
  for (int i = 0; i < 100; ++i) {
    const double error = speed_of(gap, y, &d_excess) - omega;
    double step = error / speed_by_stress(gap, d_excess);
    if (gap.power != 1.0) {
      (error < 0.0 ? low : high) = s;
      if (!(s - step > low && s - step < high)) step = s - 0.5 * (low + high);
    }
    s -= step;
    if (std::abs(step) <= 1e-14 * s) break;
  }
}

/// Time derivatives that agree with the state: the kinetics, and the constraint differentiated.
void consistent_rates(const Gap& gap, double t, std::span<const double> y, std::span<double> rates) {
  std::vector<double> d_excess;
  const double speed = speed_of(gap, y, &d_excess);
  std::vector<double> buffer;
  const std::span<const double> mean = mean_rates(gap, y, buffer);
  double by_lambda = 0.0;
  for (std::size_t i = 0, at = 0; i < gap.nodes(); ++i) {
    const double gamma_dot = mean.empty() ? gap.gamma_dot(i, y) : mean[i];
    for (std::size_t j = 0; j < gap.parts.size(); ++j, ++at) {
      rates[at] = gap.rate_of_part(i, j, y[at], gamma_dot);
      by_lambda -= d_excess[i] * gap.tau_0 / gap.mu * rates[at];
    }
  }
  if (gap.compliance > 0.0) {
    rates[gap.unknowns()] = (gap.omega(t) - speed) / gap.compliance;
    return;
  }
  const double dt = 1e-6, d_omega = (gap.omega(t + dt) - gap.omega(t)) / dt;
  rates[gap.unknowns()] = (d_omega - by_lambda) / speed_by_stress(gap, d_excess);
}

int residual(sunrealtype t, N_Vector y_vector, N_Vector rates_vector, N_Vector result, void* user) {
  const Gap& gap = *static_cast<const Gap*>(user);
  const std::span<double> y = values(y_vector), rates = values(rates_vector), f = values(result);
  std::vector<double> buffer;
  const std::span<const double> mean = mean_rates(gap, y, buffer);
  for (std::size_t i = 0, at = 0; i < gap.nodes(); ++i) {
    const double gamma_dot = mean.empty() ? gap.gamma_dot(i, y) : mean[i];
    for (std::size_t j = 0; j < gap.parts.size(); ++j, ++at)
      f[at] = rates[at] - gap.rate_of_part(i, j, y[at], gamma_dot);
  }
  f[gap.unknowns()] = speed_of(gap, y, nullptr) - gap.omega(t);
  if (gap.compliance > 0.0) f[gap.unknowns()] += gap.compliance * rates[gap.unknowns()];
  return std::isfinite(f[gap.unknowns()]) ? 0 : 1;  // 1: IDA tries a smaller step
}

int distance_to_gate(sunrealtype, N_Vector y_vector, N_Vector, sunrealtype* g, void* user) {
  const Gap& gap = *static_cast<const Gap*>(user);
  const std::span<double> y = values(y_vector);
  std::vector<double> buffer;
  const std::span<const double> mean = mean_rates(gap, y, buffer);
  for (std::size_t i = 0; i < gap.nodes(); ++i)
    g[i] = (mean.empty() ? gap.gamma_dot(i, y) : mean[i]) - gap.gamma_c;
  return 0;
}

/// The block of a node in Newton's system: diag(diagonal) + by_sum 1^T over its parts, as the shear rate hangs on their
/// sum; `column` by s. A node of one part is a number, by_sum in its diagonal.
struct NodeBlock {
  std::span<double> diagonal, by_sum, column;
};

void fill_block(const Gap& gap, std::size_t i, std::span<const double> y, double cj, const NodeBlock& block) {
  const double e = gap.excess(i, y), gamma_dot = gap.rate(e);
  for (std::size_t j = 0; j < gap.parts.size(); ++j) {
    const Part& p = gap.parts[j];
    const auto d =
        kinetics_equations::derivatives_of(p.kinetics, gap.build_rate, y[i * gap.parts.size() + j] / p.share,
                                           std::max(0.0, gamma_dot), gap.flows(i, gamma_dot));
    const double by_rate = p.share * d.broken_by_rate * gap.slope(e);
    block.diagonal[j] = cj - d.build_by_lambda;
    block.by_sum[j] = block.column[j] = 0.0;
    if (!(e > 0.0)) continue;
    block.column[j] = d.k * by_rate * gap.stress_share[i] / gap.mu;
    if (gap.parts.size() > 1) block.by_sum[j] = -d.k * by_rate * gap.tau_0 / gap.mu;
    const double of_rate = gap.parts.size() > 1 ? 0.0 : by_rate * gap.tau_0 / gap.mu;
    block.diagonal[j] += d.k * (d.broken_by_lambda - of_rate);
  }
}

/// block^-1 (b - column x_s), by Sherman and Morrison.
void solve_block(const NodeBlock& block, std::span<const double> b, double x_s, std::span<double> x) {
  double sum = 0.0, by_sum = 1.0;
  for (std::size_t j = 0; j < x.size(); ++j) {
    x[j] = (b[j] - block.column[j] * x_s) / block.diagonal[j];
    sum += x[j];
    by_sum += block.by_sum[j] / block.diagonal[j];
  }
  if (x.size() == 1) return;
  for (std::size_t j = 0; j < x.size(); ++j) x[j] -= block.by_sum[j] / block.diagonal[j] * sum / by_sum;
}

/// Sums over the parts of block^-1 column and of block^-1 b, each times `row`.
std::pair<double, double> eliminated(const NodeBlock& block, std::span<const double> b, double row) {
  if (b.size() == 1) return {row * block.column[0] / block.diagonal[0], row * b[0] / block.diagonal[0]};
  double column = 0.0, right = 0.0, by_sum = 1.0;
  for (std::size_t j = 0; j < b.size(); ++j) {
    column += block.column[j] / block.diagonal[j];
    right += b[j] / block.diagonal[j];
    by_sum += block.by_sum[j] / block.diagonal[j];
  }
  return {row * column / by_sum, row * right / by_sum};
}

/// The parts of a node by the mean rate and by themselves: the diagonal of Newton's system, and d(residual)/d(mean rate).
struct ByMeanRate {
  std::vector<double> diagonal, by_rate;
};

ByMeanRate by_mean_rate(const Gap& gap, std::span<const double> y, std::span<const double> mean, double cj) {
  ByMeanRate by;
  for (std::size_t i = 0, at = 0; i < gap.nodes(); ++i)
    for (const Part& p : gap.parts) {
      const auto d = kinetics_equations::derivatives_of(p.kinetics, gap.build_rate, y[at++] / p.share,
                                                        mean[i], gap.flows(i, mean[i]));
      by.diagonal.push_back(cj - d.build_by_lambda + d.k * d.broken_by_lambda);
      by.by_rate.push_back(mean[i] > 0.0 ? p.share * d.k * d.broken_by_rate : 0.0);
    }
  return by;
}

/// Newton's system where the rate is a mean over a layer. Eliminating the parts leaves their sum at every node, a band of the
/// mean's reach, and s.
int solve_with_layer(const Gap& gap, std::span<const double> y, double cj, std::span<const double> b,
                     std::span<double> x) {
  const std::size_t n = gap.nodes(), parts = gap.parts.size();
  std::vector<double> buffer, d_excess, sum(n, 0.0), by_sum(n, 0.0), by_s(n, 0.0), sum_by_s(n);
  std::vector<PositivePart> intervals;
  integrate_intervals(gap, y, intervals);
  speed_of(gap, y, &d_excess);
  const ByMeanRate by = by_mean_rate(gap, y, mean_rates(gap, y, buffer), cj);
  for (std::size_t at = 0; at < n * parts; ++at) {
    sum[at / parts] += b[at] / by.diagonal[at];
    by_sum[at / parts] += by.by_rate[at] / by.diagonal[at];
  }
  const double by_lambda = -gap.tau_0 / gap.mu;  // of the excess
  gap.band->set_to_zero();
  for (std::size_t i = 0; i < n; ++i) {
    gap.band->at(i, i) += 1.0;
    for (std::size_t k = 0; k < gap.means[i].weight.size(); ++k) {
      const std::size_t j = gap.means[i].first + k;
      const double w = gap.means[i].weight[k] * by_sum[i];
      gap.band->at(i, j) += w * intervals[j].d_a * by_lambda;
      gap.band->at(i, j + 1) += w * intervals[j].d_b * by_lambda;
      by_s[i] +=
          w * (intervals[j].d_a * gap.stress_share[j] + intervals[j].d_b * gap.stress_share[j + 1]) / gap.mu;
    }
  }
  if (!gap.band->factor()) return 1;  // recoverable: IDA tries a smaller step
  gap.band->solve(sum, sum);
  gap.band->solve(by_s, sum_by_s);
  double pivot = speed_by_stress(gap, d_excess) + cj * gap.compliance, right = b[gap.unknowns()];
  for (std::size_t i = 0; i < n; ++i) {
    pivot -= d_excess[i] * by_lambda * sum_by_s[i];
    right -= d_excess[i] * by_lambda * sum[i];
  }
  if (!(std::abs(pivot) > 0.0)) return 1;
  const double s = x[gap.unknowns()] = right / pivot;
  std::vector<double> excess(n);
  for (std::size_t i = 0; i < n; ++i)
    excess[i] = gap.stress_share[i] / gap.mu * s + by_lambda * (sum[i] - sum_by_s[i] * s);
  for (std::size_t i = 0, at = 0; i < n; ++i) {
    double mean = 0.0;
    for (std::size_t k = 0; k < gap.means[i].weight.size(); ++k) {
      const std::size_t j = gap.means[i].first + k;
      mean += gap.means[i].weight[k] * (intervals[j].d_a * excess[j] + intervals[j].d_b * excess[j + 1]);
    }
    for (std::size_t j = 0; j < parts; ++j, ++at) x[at] = (b[at] - by.by_rate[at] * mean) / by.diagonal[at];
  }
  return 0;
}

/// Newton's system is an arrow: the parts of a node couple among themselves and to s, the constraint to all. Eliminating
/// them leaves one equation for s, so a solve costs O(n) where a dense factorisation would cost O(n^3).
int solve_arrow(SUNLinearSolver solver, SUNMatrix, N_Vector x_vector, N_Vector b_vector, sunrealtype) {
  void* memory = solver->content;
  sunrealtype t = 0.0, cj = 0.0;
  N_Vector y_predicted, rates_predicted, y_vector, rates_vector, res;
  void* user = nullptr;
  IDAGetNonlinearSystemData(memory, &t, &y_predicted, &rates_predicted, &y_vector, &rates_vector, &res, &cj,
                            &user);
  const Gap& gap = *static_cast<const Gap*>(user);
  const std::span<double> y = values(y_vector), x = values(x_vector), b = values(b_vector);
  const std::size_t n = gap.unknowns(), parts = gap.parts.size();
  if (!gap.means.empty()) return solve_with_layer(gap, y, cj, b, x);

  thread_local std::vector<double> d_excess, blocks;
  speed_of(gap, y, &d_excess);
  blocks.resize(3 * n);
  const auto block_at = [&](std::size_t at) {
    const std::span<double> all(blocks);
    return NodeBlock{all.subspan(at, parts), all.subspan(n + at, parts), all.subspan(2 * n + at, parts)};
  };
  double pivot = speed_by_stress(gap, d_excess) + cj * gap.compliance, right = b[n];
  for (std::size_t i = 0; i < gap.nodes(); ++i) {
    const NodeBlock block = block_at(i * parts);
    fill_block(gap, i, y, cj, block);
    const double row = -d_excess[i] * gap.tau_0 / gap.mu;
    const std::pair<double, double> gone = eliminated(block, b.subspan(i * parts, parts), row);
    pivot -= gone.first;
    right -= gone.second;
  }
  if (!(std::abs(pivot) > 0.0)) return 1;  // recoverable: IDA tries a smaller step
  x[n] = right / pivot;
  for (std::size_t at = 0; at < n; at += parts)
    solve_block(block_at(at), b.subspan(at, parts), x[n], x.subspan(at, parts));
  return 0;
}

SUNLinearSolver arrow_solver(void* memory, const SundialsContext& context) {
  SUNLinearSolver solver = SUNLinSolNewEmpty(context.get);
  if (!solver) return nullptr;
  solver->ops->gettype = [](SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; };
  solver->ops->solve = solve_arrow;
  solver->ops->free = [](SUNLinearSolver s) {
    s->content = nullptr;  // IDA's memory, not ours
    SUNLinSolFreeEmpty(s);
    return 0;
  };
  solver->content = memory;
  return solver;
}

struct FreeIda {
  void operator()(void* memory) const { IDAFree(&memory); }
};

void check(const CouetteFlow& flow) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0.0; };
  if (!positive(flow.bingham.tau_0) || !positive(flow.bingham.mu))
    throw std::invalid_argument("the yield stress and the plastic viscosity must be greater than 0");
  if (!(flow.flow_index >= 0.2 && flow.flow_index <= 2.0))
    throw std::invalid_argument("the flow index must lie between 0.2 and 2");
  if (!(std::isfinite(flow.shear_modulus) && flow.shear_modulus >= 0.0))
    throw std::invalid_argument("the shear modulus must be 0, for a rigid material, or greater");
  if (!(std::isfinite(flow.thixotropy.layer) && flow.thixotropy.layer >= 0.0))
    throw std::invalid_argument("the layer must be 0, for none, or greater");
  if (!flow.omega_of_time && !positive(flow.omega))
    throw std::invalid_argument("the speed must be greater than 0");
  kinetics_equations::check(flow.thixotropy, flow.thixotropy.initial_flocculation);
}

Gap make_gap(const CouetteFlow& flow, double width, const Instrument& in, const CouetteOptions& options) {
  const Thixotropy& t = flow.thixotropy;
  Gap gap;
  gap.tau_0 = flow.bingham.tau_0;
  gap.mu = flow.bingham.mu;
  gap.power = 1.0 / flow.flow_index;
  gap.build_rate = t.A_thix / flow.bingham.tau_0;
  for (const BreakdownMode& mode : kinetics_equations::modes_of(t.kinetics))
    if (mode.share > 0.0) gap.parts.push_back({mode.share, kinetics_equations::of_part(t.kinetics, mode)});
  gap.gated = gate(t.kinetics).has_value();
  gap.gamma_c = gate(t.kinetics).value_or(0.0);
  gap.find_gate = options.find_gate;
  gap.dx = width / options.intervals;
  for (int i = 0; i <= options.intervals; ++i) {
    const double share = static_cast<double>(i) / options.intervals;
    gap.x.push_back(gap.power == 1.0 ? i * gap.dx : width * share * share);
    gap.stress_share.push_back(is_evenly_sheared(in) ? 1.0 : std::exp(-2.0 * gap.x.back()));
  }
  if (t.layer > 0.0) {
    gap.means = layer_means(gap.x, t.layer / in.vane_radius);
    gap.band = std::make_unique<BandMatrix>(gap.nodes(), reach_of(gap.means));
  }
  if (flow.shear_modulus > 0.0)
    gap.compliance = 0.5 * (1.0 - std::pow(in.vane_radius / in.container_radius, 2)) / flow.shear_modulus;
  const double omega = flow.omega;
  gap.omega = flow.omega_of_time ? flow.omega_of_time : [omega](double) { return omega; };
  return gap;
}

class Integrator {
 public:
  Integrator(Gap gap, double lambda, const CouetteOptions& options)
      : gap_(std::move(gap)),
        y_(gap_.unknowns() + 1, context_),
        rates_(gap_.unknowns() + 1, context_),
        memory_(IDACreate(context_.get)),
        solver_(arrow_solver(memory_.get(), context_)) {
    const std::span<double> y = values(y_.get);
    for (std::size_t i = 0; i < gap_.unknowns(); ++i) y[i] = gap_.parts[i % gap_.parts.size()].share * lambda;
    if (gap_.compliance > 0.0)
      y[gap_.unknowns()] = 0.0;
    else
      solve_stress(gap_, y, gap_.omega(0.0));
    if (!std::isfinite(y[gap_.unknowns()])) throw std::runtime_error("the Couette flow has no finite torque");
    std::vector<double> buffer;
    const std::span<const double> mean = mean_rates(gap_, y, buffer);
    for (std::size_t i = 0; i < gap_.nodes(); ++i)
      gap_.flowing.push_back((mean.empty() ? gap_.gamma_dot(i, y) : mean[i]) >= gap_.gamma_c);
    consistent_rates(gap_, 0.0, y, values(rates_.get));
    void* m = memory_.get();
    sundials_ok(IDAInit(m, residual, 0.0, y_.get, rates_.get), "IDAInit");
    sundials_ok(IDASStolerances(m, options.relative_tolerance, options.absolute_tolerance),
                "IDASStolerances");
    sundials_ok(IDASetUserData(m, &gap_), "IDASetUserData");
    sundials_ok(IDASetLinearSolver(m, solver_.get, nullptr), "IDASetLinearSolver");
    sundials_ok(IDASetMaxNumSteps(m, 1'000'000), "IDASetMaxNumSteps");
    sundials_ok(IDASetErrHandlerFn(
                    m, [](int, const char*, const char*, char*, void*) {}, nullptr),
                "IDASetErrHandlerFn");
    if (gap_.gated && gap_.find_gate) {
      sundials_ok(IDARootInit(m, static_cast<int>(gap_.nodes()), distance_to_gate), "IDARootInit");
      sundials_ok(IDASetNoInactiveRootWarn(m), "IDASetNoInactiveRootWarn");
    }
  }

  void advance(double t, CouetteDecay& result) {
    double reached = now_;
    while (now_ < t) {
      const int flag = IDASolve(memory_.get(), t, &reached, y_.get, rates_.get, IDA_NORMAL);
      sundials_ok(flag, "IDASolve");
      now_ = reached;
      if (flag == IDA_ROOT_RETURN) pass_gate(result);
    }
  }

  void report(double t, bool keep_profile, const Instrument& in, CouetteDecay& result) const {
    const std::span<const double> y = values(y_.get);
    const double r_i = in.vane_radius, s = y[gap_.unknowns()];
    result.time.push_back(t);
    result.torque.push_back(s * 2.0 * std::numbers::pi * r_i * r_i * in.vane_height);
    result.sheared_radius.push_back(r_i * std::exp(sheared_x(y)));
    if (!keep_profile) return;
    CouetteProfile& profile = result.profile.emplace_back();
    for (std::size_t i = 0; i < gap_.nodes(); ++i) {
      profile.lambda.push_back(gap_.lambda(i, y));
      profile.gamma_dot.push_back(std::max(0.0, gap_.gamma_dot(i, y)));
    }
  }

  const Gap& gap() const { return gap_; }

  long steps() const {
    long n = 0;
    IDAGetNumSteps(memory_.get(), &n);
    return n + steps_before_;
  }

 private:
  void pass_gate(CouetteDecay& result) {
    std::vector<int> direction(gap_.nodes());
    sundials_ok(IDAGetRootInfo(memory_.get(), direction.data()), "IDAGetRootInfo");
    bool changed = false;
    for (std::size_t i = 0; i < gap_.nodes(); ++i) {
      if (direction[i] == 0 || gap_.flowing[i] == (direction[i] > 0)) continue;
      gap_.flowing[i] = direction[i] > 0;
      ++result.gate_crossings;
      changed = true;
    }
    if (!changed) return;
    steps_before_ = steps();  // a new start sets the counter to 0
    if (!(gap_.compliance > 0.0)) solve_stress(gap_, values(y_.get), gap_.omega(now_));
    consistent_rates(gap_, now_, values(y_.get), values(rates_.get));
    sundials_ok(IDAReInit(memory_.get(), now_, y_.get, rates_.get), "IDAReInit");
  }

  /// x of the outermost point with a positive excess, linear between the nodes.
  double sheared_x(std::span<const double> y) const {
    for (std::size_t i = gap_.nodes(); i-- > 0;) {
      const double e = gap_.excess(i, y);
      if (e <= 0.0) continue;
      return i + 1 == gap_.nodes() ? gap_.x[i]
                                   : gap_.x[i] + gap_.interval(i + 1) * e / (e - gap_.excess(i + 1, y));
    }
    return 0.0;
  }

  SundialsContext context_;
  Gap gap_;
  SundialsVector y_, rates_;
  std::unique_ptr<void, FreeIda> memory_;
  SundialsLinearSolver solver_;
  double now_ = 0.0;
  long steps_before_ = 0;
};

}  // namespace

namespace {

/// ln(r/R_i) as far as the material can be sheared while lambda falls: a tenth more than at time 0.
double sheared_width(const CouetteFlow& flow, const Instrument& in) {
  const double tau_y = static_yield_stress(flow.thixotropy.initial_flocculation, flow.bingham.tau_0);
  const double omega = flow.omega_of_time ? flow.omega_of_time(0.0) : flow.omega;
  const double radius = steady_torque({tau_y, flow.bingham.mu, flow.flow_index}, omega, in).sheared_radius;
  return 1.1 * std::log(radius / in.vane_radius);
}

/// Empty where the shear reached the outer end of the resolved width.
std::optional<CouetteDecay> solve(const CouetteFlow& flow, std::span<const double> times,
                                  const Instrument& in, const CouetteOptions& options, double width,
                                  bool whole) {
  Integrator integrator(make_gap(flow, width, in, options), flow.thixotropy.initial_flocculation, options);
  CouetteDecay result;
  for (const double x : integrator.gap().x) result.radius.push_back(in.vane_radius * std::exp(x));
  for (const double t : times) {
    integrator.advance(t, result);
    integrator.report(t, options.keep_profiles, in, result);
    if (!whole && result.sheared_radius.back() >= result.radius.back()) return std::nullopt;
  }
  result.steps = integrator.steps();
  return result;
}

/// The stress is the same at every radius, so that no layer can break down before the others: as in a cone and plate, where a
/// stress that falls with the shear would otherwise grow bands out of the gap's 2e-5.
CouetteDecay even_shear(const CouetteFlow& flow, std::span<const double> times, const Instrument& in,
                        CouetteOptions options) {
  options.intervals = 2;
  return *solve(flow, times, in, options, std::log(in.container_radius / in.vane_radius), true);
}

}  // namespace

CouetteDecay thixotropic_couette(const CouetteFlow& flow, std::span<const double> times, const Instrument& in,
                                 const CouetteOptions& options) {
  check(in);
  check(flow);
  if (options.intervals < 2) throw std::invalid_argument("the gap needs at least 2 intervals");
  if (!std::is_sorted(times.begin(), times.end()) || (!times.empty() && times.front() < 0.0))
    throw std::invalid_argument("the times must ascend from 0 or later");
  const double gap = std::log(in.container_radius / in.vane_radius);
  if (is_evenly_sheared(in)) return even_shear(flow, times, in, options);
  if (!options.whole_gap && flow.thixotropy.layer == 0.0) {
    const double width = sheared_width(flow, in);
    if (width < gap)
      if (auto result = solve(flow, times, in, options, width, false)) return *std::move(result);
  }
  return *solve(flow, times, in, options, gap, true);
}

double dissipated_power(const CouetteProfile& p, std::span<const double> radius, const Bingham& b,
                        const Instrument& in) {
  const auto density = [&](std::size_t i) {
    const double g = p.gamma_dot[i];
    return (b.mu * g * g + (1.0 + p.lambda[i]) * b.tau_0 * g) * 2.0 * std::numbers::pi * radius[i] *
           in.vane_height;
  };
  double sum = 0.0;
  for (std::size_t i = 1; i < radius.size(); ++i)
    sum += 0.5 * (density(i - 1) + density(i)) * (radius[i] - radius[i - 1]);
  return sum;
}

}  // namespace tremie
