#include "rheometer/protocol/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rheometer/regression/least_squares.hpp"
#include "rheometer/regression/statistics.hpp"

namespace tremie {

namespace {

void read_fit(const TorqueRecord& record, const FitInput& input, SectionReading& reading) {
  try {
    reading.fit = fit(record, input);
    reading.fit->sheared_evenly = record.sheared_evenly;
    reading.reasons.insert(reading.reasons.end(), reading.fit->reasons.begin(), reading.fit->reasons.end());
  } catch (const std::exception& error) {  // too few rows, a torque of 0: the section has no reading
    reading.notes.push_back(std::string("no fit: ") + error.what());
  }
}

/// The relative scatter of T_end + C shape(t) with two parameters of the shape at most.
template <class Shape>
std::optional<LeastSquaresFit> shape_fit(const std::vector<double>& t, const std::vector<double>& torque,
                                         std::vector<double> start, Shape shape) {
  LeastSquaresProblem p;
  p.observed = torque;
  p.count.assign(torque.size(), 1.0);
  p.start = {0.5 * torque.back(), torque.front() - 0.5 * torque.back()};
  p.start.insert(p.start.end(), start.begin(), start.end());
  p.lower = {0.0, 0.0, 1e-6 * t.back(), 0.01};
  p.upper = {10.0 * torque.front(), 100.0 * torque.front(), 100.0 * t.back(), 20.0};
  p.lower.resize(p.start.size());
  p.upper.resize(p.start.size());
  p.model = [&](std::span<const double> q, std::span<double> fitted, std::span<double> jacobian) {
    const auto value = [&](const std::vector<double>& v, std::size_t i) {
      return v[0] + v[1] * shape(v, t[i]);
    };
    const std::vector<double> at(q.begin(), q.end());
    for (std::size_t i = 0; i < t.size(); ++i) fitted[i] = value(at, i);
    for (std::size_t k = 0; !jacobian.empty() && k < at.size(); ++k) {
      std::vector<double> moved = at;
      const double step = 1e-6 * std::max(std::abs(at[k]), 1e-6 * torque.front());
      moved[k] += step;
      for (std::size_t i = 0; i < t.size(); ++i)
        jacobian[i * at.size() + k] = (value(moved, i) - fitted[i]) / step;
    }
    return std::all_of(fitted.begin(), fitted.end(), [](double f) { return f > 0.0 && std::isfinite(f); });
  };
  try {
    return fit_least_squares(
        p, {.readings_in_time_order = true, .parameter_tolerance = 1e-8, .max_iterations = 200});
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

/// The shape of the torque from its peak on; time counts from the peak.
DecayShape read_decay_shape(const std::vector<double>& time, const std::vector<double>& torque) {
  DecayShape d;
  d.peak_torque = torque.front();
  d.end_torque = torque.back();
  for (std::size_t i = 1; i < torque.size() && !d.half_time; ++i) {
    const double half = 0.5 * torque.front();
    if (torque[i] > half) continue;
    const double share = (torque[i - 1] - half) / (torque[i - 1] - torque[i]);
    d.half_time = time[i - 1] + share * (time[i] - time[i - 1]);
  }
  if (torque.size() < 8 || !(torque.back() > 0.0) || !(torque.back() < 0.95 * torque.front())) return d;
  std::vector<double> t, T;  // some hundred readings tell a shape
  const std::size_t every = 1 + torque.size() / 400;
  for (std::size_t i = 0; i < torque.size(); i += every)
    if (torque[i] > 0.0) t.push_back(time[i]), T.push_back(torque[i]);
  const double guess = d.half_time.value_or(0.2 * time.back());
  if (const auto e = shape_fit(t, T, {guess}, [](const auto& v, double x) { return std::exp(-x / v[2]); }))
    d.exponential_scatter = e->scatter;
  if (const auto p = shape_fit(t, T, {0.5 * guess, 0.7},
                               [](const auto& v, double x) { return std::pow(1.0 + x / v[2], -v[3]); })) {
    d.power_scatter = p->scatter;
    d.power_m = p->parameters[3];
  }
  return d;
}

}  // namespace

ProtocolReading read_protocol(const ProtocolRecord& record, const FitInput& input,
                              const ProtocolOptions& options) {
  check(input.instrument);
  ProtocolReading result;
  result.sheared_evenly = record.sheared_evenly;
  for (const Section& s : find_sections(record)) {
    SectionReading reading;
    reading.section = s;
    reading.first_line = record.line[s.begin];
    reading.last_line = record.line[s.end - 1];
    reading.start = record.time[s.begin];
    reading.duration = record.time[s.end - 1] - record.time[s.begin];
    FitInput in = input;
    in.omega = s.omega > 0.0 ? std::optional(s.omega) : std::nullopt;
    if (s.rest_before > 0.0) in.rest = s.rest_before;
    if (s.kind == SectionKind::start_up) {
      reading.start_up = read_start_up(record, s, input.instrument, options, reading.notes);
    } else if (s.kind == SectionKind::constant_rate) {
      const TorqueRecord decay = decay_of(record, s);
      reading.fit_origin = record.time[peak_of(record, s)] - reading.start;
      reading.decay = read_decay_shape(decay.time, decay.torque);
      read_fit(decay, in, reading);
    } else if (s.kind == SectionKind::flow_curve_up || s.kind == SectionKind::flow_curve_down) {
      in.law = in.mu ? "bingham" : "auto";
      read_fit(flow_curve_of(record, s), in, reading);
    } else if (s.kind == SectionKind::other) {
      reading.notes.push_back("neither a constant speed nor a ramp: not read");
    }
    result.sections.push_back(std::move(reading));
    for (const std::string& why : result.sections.back().reasons)
      result.reasons.push_back("section " + std::to_string(result.sections.size()) + " (" +
                               std::string(name_of(s.kind)) + "): " + why);
  }
  result.structuration = structuration_of(result.sections);
  return result;
}

}  // namespace tremie
