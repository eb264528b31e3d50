#include "rheometer/cell/material_cell.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "rheometer/cell/elastic_cell.hpp"
#include "rheometer/cell/elastic_ode.hpp"
#include "rheometer/records/torque_record.hpp"
#include "rheometer/reference/flocculation_ode.hpp"
#include "rheometer/reference/references.hpp"
#include "rheometer/tables/table.hpp"

namespace tremie {

namespace {

/// Steps in one segment: the time step as given, else its share of 2000, and some in a short one too.
long steps_in(const MaterialCell& cell, const ShearSegment& s, double total) {
  const double count = static_cast<double>(cell.history.size());
  const double n =
      cell.time_step ? s.duration / *cell.time_step : std::max(2000.0 * s.duration / total, 400.0 / count);
  if (n > 1e7)
    throw std::invalid_argument(
        "model.time_step: too small: a segment of the history takes more than 10 million steps");
  return std::max(1L, static_cast<long>(std::ceil(n * (1.0 - 1e-12))));
}

class Run {
 public:
  Run(const MaterialCell& cell, const YieldLaw& law) : cell_(cell), law_(law) {
    const auto& t = cell.mix.thixotropy;
    if (!t) return;
    lambda_ = flocculation_after_rest(t->initial_flocculation, *t, cell.mix.tau_0, cell.rest);
    for (const double share : part_shares(t->kinetics)) parts_.push_back(share * lambda_);
    elastic_.lambda = lambda_, elastic_.parts = parts_;
  }

  CellResult operator()() {
    const double total = duration(linear_pieces(cell_.history));
    double start = 0.0;
    for (const ShearSegment& s : cell_.history) {
      if (result_.samples.empty() || s.from != result_.samples.back().shear_rate) add(start, s.from);
      const long n = steps_in(cell_, s, total);
      for (long i = 1; i <= n; ++i) step(s, start, s.duration / static_cast<double>(n), i, n);
      start += s.duration;
    }
    if (is_elastic()) {
      result_.peak = {elastic_.largest_stress, elastic_.strain_at_largest_stress};
    }
    if (has_integrated_references()) try {
        if (is_elastic())
          compare_elastic();
        else if (cell_.mix.thixotropy)
          compare();
      } catch (const std::runtime_error& error) {  // the integrator gave up: no reason to lose the run
        result_.reference_failed = error.what();
      }
    find_area();
    return std::move(result_);
  }

 private:
  void step(const ShearSegment& s, double start, double dt, long i, long n) {
    const auto rate = [&](long k) {
      return k == n ? s.to : s.from + (s.to - s.from) * static_cast<double>(k) / static_cast<double>(n);
    };
    if (is_elastic()) {
      advance(elastic_, cell_.mix, law_, rate(i - 1), rate(i), dt);
      lambda_ = elastic_.lambda;
    } else if (const auto& t = cell_.mix.thixotropy) {
      lambda_ = flocculation_step(lambda_, *t, cell_.mix.tau_0, rate(i - 1), rate(i), dt,
                                  [&](std::size_t part) -> double& { return parts_[part]; });
    }
    add(i == n ? start + s.duration : start + static_cast<double>(i) * dt, rate(i));
    ++result_.steps;
  }

  void add(double time, double gamma_dot) {
    const double tau_y = static_yield_stress(lambda_, cell_.mix.tau_0);
    const double stress =
        is_elastic() ? elastic_.stress : cell_.mix.mu * gamma_dot + tremie::stress(law_, gamma_dot, tau_y);
    stress_limit_.push_back(stress);
    CellSample sample{time, gamma_dot, stress, {}, {}};
    if (is_elastic())
      sample.strain = elastic_.strain;
    else if (is_exact(law_) && gamma_dot == 0.0 && tau_y > 0.0)
      sample.shear_stress.reset();
    if (cell_.mix.thixotropy) sample.flocculation = lambda_;
    result_.samples.push_back(sample);
  }

  void compare() {
    const Thixotropy& t = *cell_.mix.thixotropy;
    const double lambda_0 = flocculation_after_rest(t.initial_flocculation, t, cell_.mix.tau_0, cell_.rest);
    std::vector<double> times;
    for (const CellSample& sample : result_.samples) times.push_back(sample.time);
    const OdeResult reference =
        flocculation_ode(linear_pieces(cell_.history), t, cell_.mix.tau_0, lambda_0, times);
    result_.reference_steps = reference.steps;
    result_.flocculation_error_max = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      CellSample& sample = result_.samples[i];
      sample.flocculation_reference = reference.lambda[i];
      result_.flocculation_error_max =
          std::max(*result_.flocculation_error_max, std::abs(*sample.flocculation - reference.lambda[i]));
    }
  }

  /// As compare(), of stress and lambda.
  void compare_elastic() {
    const Mix& mix = cell_.mix;
    const auto* hb = std::get_if<HerschelBulkley>(&law_);
    const HerschelBulkleyFluid fluid{mix.tau_0, hb && hb->n != 1.0 ? hb->k : mix.mu, hb ? hb->n : 1.0};
    std::vector<double> times;
    for (const CellSample& sample : result_.samples) times.push_back(sample.time);
    const double lambda_0 = mix.thixotropy ? flocculation_after_rest(mix.thixotropy->initial_flocculation,
                                                                     *mix.thixotropy, mix.tau_0, cell_.rest)
                                           : 0.0;
    const ElasticOdeResult reference =
        elastic_ode(linear_pieces(cell_.history), {fluid, mix.G, mix.thixotropy}, lambda_0, times);
    double off_stress = 0.0, off_lambda = 0.0;
    for (std::size_t i = 0; i < times.size(); ++i) {
      CellSample& sample = result_.samples[i];
      sample.shear_stress_reference = reference.stress[i];
      off_stress = std::max(off_stress, std::abs(*sample.shear_stress - reference.stress[i]));
      if (!sample.flocculation) continue;
      sample.flocculation_reference = reference.lambda[i];
      off_lambda = std::max(off_lambda, std::abs(*sample.flocculation - reference.lambda[i]));
    }
    result_.stress_error_max = off_stress;
    if (mix.thixotropy) result_.flocculation_error_max = off_lambda;
  }

  bool is_elastic() const { return cell_.mix.G > 0.0; }

  void find_area() {
    const std::vector<CellSample>& s = result_.samples;
    const auto [low, high] = std::minmax_element(
        s.begin(), s.end(), [](const auto& a, const auto& b) { return a.shear_rate < b.shear_rate; });
    if (s.front().shear_rate != s.back().shear_rate || low->shear_rate == high->shear_rate) return;
    double area = 0.0;
    for (std::size_t i = 1; i < s.size(); ++i)
      area += 0.5 * (stress_limit_[i - 1] + stress_limit_[i]) * (s[i].shear_rate - s[i - 1].shear_rate);
    result_.hysteresis_area = area;
  }

  const MaterialCell& cell_;
  const YieldLaw& law_;
  double lambda_ = 0.0;
  std::vector<double> parts_;  ///< of lambda_, where it has any
  ElasticCell elastic_;        ///< where there is a shear modulus
  std::vector<double> stress_limit_;
  CellResult result_;
};

}  // namespace

CellResult run_cell(const MaterialCell& cell, const YieldLaw& law) {
  if (cell.history.empty()) throw std::invalid_argument("the history is empty");
  for (const ShearSegment& s : cell.history) linear_piece(s);  // throws where a segment is out of range
  if (cell.time_step && !(*cell.time_step > 0.0))
    throw std::invalid_argument("the time step must be greater than 0");
  if (cell.mix.G > 0.0 && (!is_exact(law) || !(cell.mix.tau_0 > 0.0)))
    throw std::invalid_argument(
        "an elastic cell needs an exact law and a yield stress greater than 0: without them it flows at "
        "once");
  return Run(cell, law)();
}

std::vector<ShearSegment> parse_shear_history(std::string_view text, const std::string& name) {
  const NumberTable table = parse_number_table(text, name,
                                               {{"time",
                                                 {{"s", 1.0}, {"ms", 1e-3}, {"min", 60.0}, {"h", 3600.0}},
                                                 "time_s, time_ms, time_min or time_h"},
                                                {"shear_rate",
                                                 {{"/s", 1.0}, {"1/s", 1.0}, {"/min", 1.0 / 60.0}},
                                                 "shear_rate_per_s or shear_rate_per_min"}});
  for (const std::size_t k : {0u, 1u})
    if (table.position[k] == 0)
      throw RecordError(
          at_position(name, table.header_line, 1, "a history needs the columns time_s,shear_rate_per_s"));
  if (table.left_out > 0)
    throw RecordError(
        at_position(name, table.header_line, 1,
                    std::to_string(table.left_out) +
                        " rows have no value in one of their columns; a history needs both in every row"));
  const auto &time = table.column[0], &rate = table.column[1];
  if (time.size() < 2)
    throw RecordError(at_position(name, table.header_line, 1, "a history needs two rows or more"));
  std::vector<ShearSegment> segments;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (rate[i] < 0.0)
      throw RecordError(at_position(name, table.line[i], table.position[1],
                                    "the shear rate is negative; 0 or more is allowed"));
    if (i == 0) continue;
    if (time[i] < time[i - 1])
      throw RecordError(at_position(name, table.line[i], table.position[0],
                                    "time runs backwards; the rows must ascend in time"));
    if (time[i] > time[i - 1]) segments.push_back({time[i] - time[i - 1], rate[i - 1], rate[i]});
  }
  if (segments.empty())
    throw RecordError(at_position(name, table.line.back(), table.position[0], "all rows have the same time"));
  return segments;
}

}  // namespace tremie
