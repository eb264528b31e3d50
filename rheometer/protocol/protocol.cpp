#include "rheometer/protocol/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "rheometer/reference/reiner_riwlin.hpp"
#include "rheometer/regression/least_squares.hpp"
#include "rheometer/regression/statistics.hpp"
#include "rheometer/tables/text.hpp"

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
    d.power_t0 = p->parameters[2];
  }
  return d;
}

/// The integral of the torque over the speed between the two branches, over the speeds that both have.
std::optional<double> area_between(const ProtocolRecord& r, const Section& up, const Section& down) {
  const auto branch = [&](const Section& s) {
    std::vector<std::pair<double, double>> points;
    for (std::size_t i = s.begin; i < s.end; ++i) points.emplace_back(r.omega[i], r.torque[i]);
    std::sort(points.begin(), points.end());
    return points;
  };
  const auto rising = branch(up), falling = branch(down);
  const double low = std::max(rising.front().first, falling.front().first),
               high = std::min(rising.back().first, falling.back().first);
  if (!(high > low)) return std::nullopt;
  const auto torque_at = [](const std::vector<std::pair<double, double>>& points, double omega) {
    const auto behind = std::lower_bound(points.begin(), points.end(), std::pair(omega, -HUGE_VAL));
    if (behind == points.begin()) return behind->second;
    if (behind == points.end()) return points.back().second;
    const auto& [x, y] = *std::prev(behind);
    return behind->first > x ? y + (behind->second - y) * (omega - x) / (behind->first - x) : y;
  };
  constexpr int pieces = 1000;
  double sum = 0.0;
  for (int i = 0; i <= pieces; ++i) {
    const double omega = low + (high - low) * i / pieces, weight = i == 0 || i == pieces ? 0.5 : 1.0;
    sum += weight * (torque_at(rising, omega) - torque_at(falling, omega));
  }
  const double area = sum * (high - low) / pieces;
  return r.sheared_evenly ? area / evenly_sheared_speed : area;
}

/// The loop of a flow curve down behind one up.
void read_loop(const ProtocolRecord& record, SectionReading& before, SectionReading& reading) {
  if (before.section.kind != SectionKind::flow_curve_up ||
      reading.section.kind != SectionKind::flow_curve_down)
    return;
  reading.loop_area = area_between(record, before.section, reading.section);
  if (reading.loop_area)
    reading.notes.push_back(text_of("loop: %.4g %s between the branch up and this one", *reading.loop_area,
                                    record.sheared_evenly ? "Pa/s" : "W"));
}

/// The last Bingham flow curve that tells both parameters; null where the record has none.
const SectionReading* own_flow_curve(const std::vector<SectionReading>& sections) {
  const SectionReading* found = nullptr;
  for (const SectionReading& s : sections)
    if (s.fit && s.fit->kind == RecordKind::flow_curve && s.reasons.empty() && s.fit->tau_0 && s.fit->mu)
      found = &s;
  return found;
}

/// The decay by the yield stress and viscosity of the flow curve; told where its own end differs from what those ask for.
void read_decay(const ProtocolRecord& record, FitInput in, const SectionReading* curve,
                SectionReading& reading) {
  const TorqueRecord decay = decay_of(record, reading.section);
  reading.fit_origin = record.time[peak_of(record, reading.section)] - reading.start;
  reading.decay = read_decay_shape(decay.time, decay.torque);
  if (curve && !in.tau_0 && !in.mu) {
    in.tau_0 = std::max(0.0, curve->fit->tau_0->value), in.mu = curve->fit->mu->value;
    const double steady = reiner_riwlin({*in.tau_0, *in.mu}, *in.omega, in.instrument).torque;
    const double end = reading.decay->end_torque;
    reading.notes.push_back(text_of("yield_stress, plastic_viscosity: of the flow curve on lines %ld to %ld",
                                    curve->first_line, curve->last_line));
    if (std::abs(end / steady - 1.0) > 0.1)
      reading.notes.push_back(
          text_of("the decay ends at %.4g, where that flow curve has %.4g %s: the two sections "
                  "contradict each other by %.0f %%",
                  record.sheared_evenly ? end : 1e3 * end, record.sheared_evenly ? steady : 1e3 * steady,
                  record.sheared_evenly ? "Pa" : "mN.m", 100.0 * std::abs(end / steady - 1.0)));
  }
  read_fit(decay, in, reading);
}

}  // namespace

std::string law_of_section(const FitInput& input) {
  return input.mu ? "bingham" : input.law == FitInput{}.law ? "auto" : input.law;
}

ProtocolReading read_protocol(const ProtocolRecord& record, const FitInput& input,
                              const ProtocolOptions& options) {
  check(input.instrument);
  ProtocolReading result;
  result.sheared_evenly = record.sheared_evenly;
  const auto input_for = [&](const Section& s) {
    FitInput in = input;
    in.omega = s.omega > 0.0 ? std::optional(s.omega) : std::nullopt;
    if (s.rest_before > 0.0) in.rest = s.rest_before;
    return in;
  };
  for (const Section& s : find_sections(record)) {
    SectionReading reading;
    reading.section = s;
    reading.first_line = record.line[s.begin];
    reading.last_line = record.line[s.end - 1];
    reading.start = record.time[s.begin];
    reading.duration = record.time[s.end - 1] - record.time[s.begin];
    if (s.kind == SectionKind::start_up) {
      reading.start_up = read_start_up(record, s, input.instrument, options, reading.notes);
    } else if (s.kind == SectionKind::flow_curve_up || s.kind == SectionKind::flow_curve_down) {
      FitInput in = input_for(s);
      in.law = law_of_section(in);
      read_fit(flow_curve_of(record, s), in, reading);
      if (!result.sections.empty()) read_loop(record, result.sections.back(), reading);
    } else if (s.kind == SectionKind::other) {
      reading.notes.push_back("neither a constant speed nor a ramp: not read");
    }
    result.sections.push_back(std::move(reading));
  }
  const SectionReading* curve = own_flow_curve(result.sections);
  for (std::size_t i = 0; i < result.sections.size(); ++i) {
    SectionReading& reading = result.sections[i];
    const Section& s = reading.section;
    if (s.kind == SectionKind::constant_rate) read_decay(record, input_for(s), curve, reading);
    for (const std::string& why : reading.reasons)
      result.reasons.push_back("section " + std::to_string(i + 1) + " (" + std::string(name_of(s.kind)) +
                               "): " + why);
  }
  result.structuration = structuration_of(result.sections);
  std::vector<Section> sections;
  for (const SectionReading& s : result.sections) sections.push_back(s.section);
  result.breakdown = breakdown_of(falls_of(record, sections), input.instrument, input.choose_kinetics);
  return result;
}

}  // namespace tremie
