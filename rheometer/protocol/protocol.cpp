#include "rheometer/protocol/protocol.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/reference/couette_flow.hpp"
#include "rheometer/tables/text.hpp"
#include "rheometer/vane/fit_with_blades.hpp"

namespace tremie {

namespace {

bool is_flow_curve(const SectionReading& s) {
  return s.section.kind == SectionKind::flow_curve_up || s.section.kind == SectionKind::flow_curve_down;
}

/// What the sections of a record share, and what they have told so far.
class Reader {
 public:
  Reader(const ProtocolRecord& record, const FitInput& input, const ProtocolOptions& options)
      : record_(record), input_(input), options_(options) {}

  ProtocolReading read() {
    check(input_.instrument);
    result_.sheared_evenly = record_.sheared_evenly;
    for (const Section& s : find_sections(record_)) add(s);
    for (SectionReading& s : result_.sections)
      if (is_flow_curve(s)) read_flow_curve(s);
    find_law();
    for (std::size_t i = 0; i < result_.sections.size(); ++i) {
      SectionReading& s = result_.sections[i];
      if (s.section.kind == SectionKind::start_up) read_growth(s);
      if (s.section.kind == SectionKind::constant_rate) read_decay(s);
      if (i > 0) read_loop(record_, result_.sections[i - 1], s);
      for (const std::string& why : s.reasons)
        result_.reasons.push_back("section " + std::to_string(i + 1) + " (" +
                                  std::string(name_of(s.section.kind)) + "): " + why);
    }
    result_.structuration = structuration_of(result_.sections);
    read_breakdown();
    return std::move(result_);
  }

 private:
  void add(const Section& s) {
    SectionReading reading;
    reading.section = s;
    reading.first_line = record_.line[s.begin];
    reading.last_line = record_.line[s.end - 1];
    reading.start = record_.time[s.begin];
    reading.duration = record_.time[s.end - 1] - record_.time[s.begin];
    if (s.kind == SectionKind::other)
      reading.notes.push_back("neither a constant speed nor a ramp: not read");
    result_.sections.push_back(std::move(reading));
  }

  FitInput input_for(const Section& s) const {
    FitInput in = input_;
    in.omega = s.omega > 0.0 ? std::optional(s.omega) : std::nullopt;
    if (s.rest_before > 0.0) in.rest = s.rest_before;
    return in;
  }

  void read_fit(const TorqueRecord& record, const FitInput& input, SectionReading& reading) const {
    try {
      reading.fit =
          options_.blades ? noted_fit_with_blades(record, input, *options_.blades) : fit(record, input);
      reading.fit->sheared_evenly = record.sheared_evenly;
      reading.reasons.insert(reading.reasons.end(), reading.fit->reasons.begin(), reading.fit->reasons.end());
    } catch (const BladesRefused& refused) {
      reading.reasons.push_back(std::string("--blades computed: ") + refused.what());
    } catch (const std::exception& error) {  // too few rows, a torque of 0: the section has no reading
      reading.notes.push_back(std::string("no fit: ") + error.what());
    }
  }

  void read_flow_curve(SectionReading& reading) const {
    FitInput in = input_for(reading.section);
    in.law = options_.blades ? flow_laws().front().name : law_of_section(in);
    read_fit(flow_curve_of(record_, reading.section), in, reading);
  }

  /// Of the last flow curve that tells all parameters of its law, or as it is given.
  void find_law() {
    if (input_.tau_0 && input_.mu) {
      law_ = KnownLaw{flow_laws().front().name, {*input_.tau_0, *input_.mu}, {}};
      return;
    }
    for (const SectionReading& s : result_.sections) {
      if (!is_flow_curve(s)) continue;
      has_curve_ = true;
      if (!s.fit || !s.reasons.empty()) continue;
      if (auto law = known_law(*s.fit)) law_ = std::move(law), curve_ = &s;
    }
    result_.flow_curve = curve_ ? static_cast<std::size_t>(curve_ - result_.sections.data()) + 1 : 0;
  }

  void read_growth(SectionReading& reading) const {
    reading.start_up = read_start_up(record_, reading.section, input_.instrument, options_, reading.notes);
    StartUpReading& s = *reading.start_up;
    if (!s.static_yield_stress) return;
    const double omega = reading.section.omega;
    try {
      double peak = s.peak_torque;
      if (options_.blades) {
        if (!law_ && !input_.mu)
          throw BladesRefused(
              "the blades' part of the peak depends on the plastic viscosity: it needs a flow curve in the "
              "record, or --plastic-viscosity");
        const double mu = law_ ? viscosity_for_blades(*law_) : *input_.mu;
        peak = torque_of_cylinder(*options_.blades, input_.instrument, mu, omega, s.peak_torque);
        s.static_yield_stress = shear_stress_at(input_.instrument.vane_radius, peak, input_.instrument);
        reading.notes.push_back(text_of(
            "static_yield_stress: of the cylinder's torque, the peak divided by %.3f", s.peak_torque / peak));
      }
      if (law_ && omega > 0.0)
        s.static_by_law = static_yield_stress_of(*law_, peak, omega, input_.instrument);
    } catch (const BladesRefused& refused) {
      s.static_yield_stress.reset();
      reading.reasons.push_back(std::string("--blades computed: ") + refused.what());
    }
  }

  /// The decay by the law of the flow curve; told where its own end differs from what that asks for.
  void read_decay(SectionReading& reading) const {
    FitInput in = input_for(reading.section);
    const TorqueRecord decay = decay_of(record_, reading.section);
    reading.fit_origin = record_.time[peak_of(record_, reading.section)] - reading.start;
    reading.decay = read_decay_shape(decay.time, decay.torque);
    if (curve_) {
      in.curve = law_;
      note_curve(reading);
    } else if (in.law_given && in.law != "auto" && in.law != flow_laws().front().name) {
      reading.reasons.push_back(
          "--law " + in.law +
          ": no flow curve of the record tells all parameters of a law, and a decay at one speed "
          "gives only a yield stress and a plastic viscosity; --law bingham reads it so");
      return;
    } else if (has_curve_ && !(in.tau_0 && in.mu)) {
      reading.notes.push_back(
          "law: Bingham, by this section alone: no flow curve of the record tells all parameters of its law");
    }
    read_fit(decay, in, reading);
  }

  void note_curve(SectionReading& reading) const {
    reading.notes.push_back(text_of("%s: of the flow curve on lines %ld to %ld; %s", names_of(*law_).c_str(),
                                    curve_->first_line, curve_->last_line,
                                    law_->covariance.empty()
                                        ? "the decay's intervals hold for these values as they stand"
                                        : "the decay's intervals contain what that curve leaves open"));
    if (options_.blades) return;  // its torques are not the record's
    const double end = reading.decay->end_torque;
    double steady = 0.0;
    try {
      const ViscousStress v = viscous_stress(*law_);
      steady = steady_torque({law_->parameters.front(), v.k, v.n}, reading.section.omega, input_.instrument)
                   .torque;
    } catch (const std::invalid_argument&) {  // the fit refuses the law and says why
      return;
    }
    if (std::abs(end / steady - 1.0) > 0.1)
      reading.notes.push_back(
          text_of("the decay ends at %.4g, where that flow curve has %.4g %s: the two sections "
                  "contradict each other by %.0f %%",
                  record_.sheared_evenly ? end : 1e3 * end, record_.sheared_evenly ? steady : 1e3 * steady,
                  record_.sheared_evenly ? "Pa" : "mN.m", 100.0 * std::abs(end / steady - 1.0)));
  }

  /// Rates of breakdown are those of the torque as it stands: what blades take of it hardly changes while it falls.
  void read_breakdown() {
    std::vector<Section> sections;
    for (const SectionReading& s : result_.sections) sections.push_back(s.section);
    Breakdown& b = result_.breakdown;
    std::vector<Fall> falls = falls_of(record_, sections);
    if (options_.elastic) add_compliance(falls);
    b = breakdown_of(falls, input_.instrument, input_.choose_kinetics);
    if (options_.blades && !b.times.empty())
      b.notes.push_back(
          "breakdown_rate: by the vane's torques as they stand; with four blades it reads some 10 % less "
          "than with a "
          "cylinder, the exponent the same");
  }

  /// A start-up without a rise of its own turns elastically by the mean angle of the others' peaks: stiffness grows with
  /// the peak.
  void add_compliance(std::vector<Fall>& falls) const {
    double angles = 0.0, n = 0.0;
    const auto rise_of = [&](const Fall& f) {
      const auto& start_up = result_.sections[f.section - 1].start_up;
      return start_up ? start_up->rise : std::nullopt;
    };
    for (const Fall& f : falls)
      if (const auto rise = rise_of(f)) angles += f.torque.front() / *rise, n += 1.0;
    for (Fall& f : falls)
      if (f.start_up && n > 0.0)
        f.compliance = rise_of(f) ? 1.0 / *rise_of(f) : angles / n / f.torque.front();
  }

  const ProtocolRecord& record_;
  const FitInput& input_;
  const ProtocolOptions& options_;
  ProtocolReading result_;
  std::optional<KnownLaw> law_;
  const SectionReading* curve_ = nullptr;
  bool has_curve_ = false;
};

}  // namespace

std::string law_of_section(const FitInput& input) {
  const bool chosen = input.law_given || input.law != FitInput{}.law;
  if (chosen && input.law != "auto") return input.law;
  return input.mu ? FitInput{}.law : "auto";
}

std::string names_of(const KnownLaw& law) {
  std::string names;
  for (const LawParameter& p : flow_law(law.name).parameters)
    names += (names.empty() ? "" : ", ") + p.row.name;
  return names;
}

ProtocolReading read_protocol(const ProtocolRecord& record, const FitInput& input,
                              const ProtocolOptions& options) {
  return Reader(record, input, options).read();
}

}  // namespace tremie
