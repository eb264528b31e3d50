#include "rheometer/whole_fit/fit_record.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "rheometer/fits/flow_law.hpp"
#include "rheometer/tables/text.hpp"
#include "rheometer/vane/fit_with_blades.hpp"
#include "rheometer/vane/vane_ends.hpp"
#include "rheometer/whole_fit/protocol_replicates.hpp"
#include "rheometer/whole_fit/record_reading.hpp"
#include "rheometer/whole_fit/tribometer.hpp"

namespace tremie {
namespace {

/// What all fits of a call share.
struct Fitting {
  const FitOptions& options;
  const std::vector<std::filesystem::path>& data_folders;
  RecordReading reading;

  const Geometry& geometry() const { return reading.geometry; }
  bool computed_ends() const { return options.ends == "computed"; }

  DataTable ends() const { return data_table(data_folders, "vane_ends", "--ends computed"); }
  BladeTable blades() const {
    const auto [text, name] = data_table(data_folders, "vane_blades", "--blades computed");
    return blade_table(text, name);
  }
};

/// Faults of a fit with the name of what it is of, if it has one.
template <class Call>
auto named(const std::string& name, Call call) {
  try {
    return call();
  } catch (const std::invalid_argument& error) {
    throw RecordError(name.empty() ? error.what() : name + ": " + error.what());
  }
}

TorqueRecord read(const Fitting& f, const RecordSource& source) {
  const double torque_offset = f.options.torque_offset;
  if (!source.record) return read_torque_record(source.name, torque_offset, f.reading.options);
  TorqueRecord record = *source.record;
  for (double& torque : record.torque) torque -= torque_offset;
  if (!f.reading.options.stress_constant) return record;
  for (double& torque : record.torque) torque *= *f.reading.options.stress_constant;
  for (double& speed : record.omega) speed *= *f.reading.options.strain_constant * evenly_sheared_speed;
  record.sheared_evenly = true;
  return record;
}

// --- evenly sheared

/// Of parallel plates: the part of the stress that goes as the rate to the power n is 3/(n + 3) of the rim's.
void correct_for_plates(FitResult& result) {
  const auto scale = [](std::optional<ParameterEstimate>& e, double factor) {
    if (!e || e->given) return;
    e->value *= factor;
    if (e->ci95) e->ci95 = Interval{e->ci95->low * factor, e->ci95->high * factor};
  };
  scale(result.mu, 4.0 / 3.0);
  if (const auto& n = result.of_law["flow_index"])
    scale(result.of_law["consistency"], (n->value + 3.0) / 3.0);
  result.notes.push_back(
      "parallel plates: corrected for the rate that falls from the rim to the axis, by the law fitted");
}

/// The fit of a record whose shear is even: no gap, no plug, no vane enters it.
FitResult fit_evenly_sheared(const Fitting& f, const TorqueRecord& record, FitInput in) {
  if (f.options.ends != "none" || f.options.blades != "none")
    throw std::invalid_argument("--ends and --blades are a vane's; this record has shear rates and stresses");
  if (f.geometry().plates && record.kind != RecordKind::flow_curve)
    throw std::invalid_argument(
        "a decay between parallel plates is not read: the rate falls from the rim to the axis");
  if (f.geometry().plates && in.mu) *in.mu *= 0.75;
  in.instrument = evenly_sheared();
  FitResult result = fit(record, in);
  if (f.geometry().plates && in.mu && result.mu) result.mu->value /= 0.75;
  if (f.geometry().plates) correct_for_plates(result);
  std::erase_if(result.notes, [](const std::string& note) { return note.starts_with("plug:"); });
  result.sheared_evenly = true;
  result.plug.reset(), result.plug_below.reset(), result.sheared_radius.reset();
  return result;
}

// --- blades and ends of a fit

/// A note where the ends' factor is that of the table's last Bingham number.
void note_beyond_ends(const Fitting& f, const FitInput& in, FitResult& result) {
  if (!f.computed_ends() || !in.omega || !result.tau_0 || !result.mu) return;
  const auto [text, name] = f.ends();
  const double last = largest_bingham_number(text, name),
               Bi = result.tau_0->value / (result.mu->value * *in.omega);
  if (Bi > last)
    result.notes.push_back(text_of(
        "ends: the Bingham number, %.3g, lies beyond the table's %.3g, whose factor is taken", Bi, last));
}

/// The fit of a vane: of the torques that its cylinder would have taken, where the blades are corrected for.
FitResult fit_vane(const Fitting& f, const TorqueRecord& record, const FitInput& in) {
  if (f.options.blades == "none") {
    FitResult result = fit(record, in);
    if (f.geometry().cylinders && f.options.ends == "none") return result;
    result.notes.push_back(
        f.options.ends == "none"
            ? taken_for_a_cylinder
            : "the ends alone are corrected: a vane with blades takes 15 to 30 % less than the "
              "cylinder of this fit, which --blades computed corrects");
    return result;
  }
  return noted_fit_with_blades(record, in, f.blades());
}

/// A flow curve as it would be if the ends carried at every speed what they carry at the middle one, for which `factor`
/// stands in the vane's height: each torque over what its own Bingham number has, by the values of `fitted`.
TorqueRecord with_even_ends(const Fitting& f, const TorqueRecord& record, const FitInput& in, double factor,
                            const FitResult& fitted) {
  const auto [text, name] = f.ends();
  Instrument vane = in.instrument;
  vane.vane_height /= factor;
  TorqueRecord even = record;
  for (std::size_t i = 0; i < record.omega.size(); ++i)
    if (record.omega[i] > 0.0)
      even.torque[i] *= factor / end_factor_from_table(text, name, vane,
                                                       std::max(0.0, fitted.tau_0->value) /
                                                           (fitted.mu->value * record.omega[i]));
  return even;
}

/// The law of a decay's material by the last flow curve of the same file that tells it, as --protocol takes it.
void take_own_flow_curve(const Fitting& f, const TorqueRecord& record, FitInput& in,
                         std::vector<std::string>& notes) {
  if (in.tau_0 && in.mu) return;
  const bool blades = f.options.blades != "none" && !record.sheared_evenly;
  for (auto curve = record.flow_curves.rbegin(); curve != record.flow_curves.rend(); ++curve) try {
      FitInput of_curve = in;
      of_curve.law = blades ? flow_laws().front().name : law_of_section(in);
      in.curve =
          known_law(blades ? fit_with_blades(*curve, of_curve, f.blades()).fit : fit(*curve, of_curve));
      if (!in.curve) continue;
      notes.push_back(text_of("%s: of the flow curve on lines %ld to %ld", names_of(*in.curve).c_str(),
                              curve->line.front(), curve->line.back()));
      return;
    } catch (const std::invalid_argument&) {  // too few rows: no flow curve
    }
}

/// `factor`: of the ends, which is in the height of `in` already; 1 for none.
FitResult read_and_fit(const Fitting& f, const RecordSource& source, FitInput in, double factor) {
  return named(source.name, [&] {
    const TorqueRecord record = read(f, source);
    if (in.omega && record.sheared_evenly) *in.omega *= f.geometry().strain_constant * evenly_sheared_speed;
    if (in.omega && !(*in.omega > 0.0)) in.omega.reset();  // a record of shear rates has no speed
    if (!in.omega && record.speed > 0.0) in.omega = record.speed;
    if (!in.rest && record.rest > 0.0) in.rest = record.rest;
    if (record.is_section && record.kind == RecordKind::flow_curve && f.options.blades == "none")
      in.law = law_of_section(in);
    std::vector<std::string> notes{"geometry: " +
                                   geometry_words(f.reading, f.options, record.sheared_evenly)};
    notes.insert(notes.end(), record.understood.begin(), record.understood.end());
    if (record.kind == RecordKind::flow_curve && f.options.speed)
      notes.push_back("--speed is a torque decay's; this flow curve has its own speeds");
    FitInput of_curve = in;
    if (record.sheared_evenly) of_curve.instrument = evenly_sheared();
    take_own_flow_curve(f, record, of_curve, notes);
    in.curve = of_curve.curve;
    FitResult result = record.sheared_evenly ? fit_evenly_sheared(f, record, in) : fit_vane(f, record, in);
    if (f.computed_ends() && factor != 1.0 && record.kind == RecordKind::flow_curve && result.tau_0 &&
        result.mu && result.mu->value > 0.0)
      result = fit_vane(f, with_even_ends(f, record, in, factor, result), in);
    note_beyond_ends(f, in, result);
    result.notes.insert(result.notes.begin(), notes.begin(), notes.end());
    return result;
  });
}

// --- the ends' factor

constexpr double usual_bingham_number = 1.0;

/// tau_0/(mu Omega) of the record at the middle of its speeds, by what is given or by a fit without ends, whose quotient
/// the ends leave as it is; that of usual concrete where the record tells no viscosity or is a protocol's.
double bingham_number(const Fitting& f, const RecordSource& first, const FitInput& in) {
  std::optional<double> tau_0 = in.tau_0, mu = in.mu, omega = in.omega;
  if (!f.options.protocol) {
    const FitResult none = read_and_fit(f, first, in, 1.0);
    if (none.tau_0) tau_0 = none.tau_0->value;
    if (none.mu) mu = none.mu->value;
    std::vector<double> speeds = none.curve.x;
    if (none.kind == RecordKind::flow_curve && !speeds.empty()) {
      std::nth_element(speeds.begin(), speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2),
                       speeds.end());
      omega = speeds[speeds.size() / 2];
    }
  }
  if (!tau_0 || !mu || !omega || *mu <= 0.0 || *omega <= 0.0) return usual_bingham_number;
  return std::max(0.0, *tau_0 / (*mu * *omega));
}

/// The factor of the ends on the height of the vane.
double end_factor(const Fitting& f, const RecordSource& first, const FitInput& in) {
  if (f.options.ends == "textbook") return textbook_end_factor(in.instrument);
  if (f.options.ends == "none") return 1.0;
  return named("--ends computed", [&] {
    const auto [text, name] = f.ends();
    return end_factor_from_table(text, name, in.instrument, bingham_number(f, first, in));
  });
}

/// By how much the ends move each value: the same fit without them, beside the fit with them.
std::vector<MoveByEnds> moves_by_ends(const Fitting& f, const RecordSource& source, FitInput in,
                                      double factor, const FitResult& with) {
  if (f.options.ends == "none") return {};
  in.instrument.vane_height /= factor;
  const FitResult none = read_and_fit(f, source, in, 1.0);
  std::vector<MoveByEnds> moves;
  for (const FitParameter& p : fit_parameters()) {
    const auto a = value_of(with, p), b = value_of(none, p);
    if (a && b && !a->given && p.member != &FitResult::exponent)
      moves.push_back({p.key, b->value, a->value / b->value - 1.0});
  }
  return moves;
}

void set_geometry(const Fitting& f, bool sheared_evenly, RecordFits& all) {
  all.geometry = geometry_words(f.reading, f.options, sheared_evenly);
  all.default_geometry = !sheared_evenly && f.reading.default_geometry;
  if (sheared_evenly) all.instrument = evenly_sheared();
}

ProtocolFit fit_protocol(const Fitting& f, const std::string& file, const FitInput& in) {
  return named(file, [&] {
    ProtocolFit p{
        parse_protocol_record(read_text_file(file), file, f.options.torque_offset, f.reading.options), {}};
    const bool corrected = f.options.ends != "none" || f.options.blades != "none";
    if (p.record.sheared_evenly && (corrected || f.geometry().plates))
      throw std::invalid_argument(
          f.geometry().plates ? "--protocol does not read parallel plates"
                              : "--ends and --blades are a vane's; this record has shear rates and stresses");
    p.record.understood.insert(p.record.understood.begin(),
                               "geometry: " + geometry_words(f.reading, f.options, p.record.sheared_evenly));
    FitInput of_record = in;
    if (p.record.sheared_evenly) of_record.instrument = evenly_sheared();
    ProtocolOptions options{
        .compliance = f.options.instrument_compliance, .elastic = f.options.elastic, .blades = {}};
    if (f.options.blades != "none") options.blades = f.blades();
    p.reading = read_protocol(p.record, of_record, options);
    return p;
  });
}

/// Protocols of one material by one law, which most of them have, and their means.
void fit_protocols(const Fitting& f, const std::vector<RecordSource>& sources, const FitInput& in,
                   RecordFits& all) {
  std::vector<ProtocolReading> readings;
  for (const RecordSource& source : sources) {
    all.protocols.push_back(fit_protocol(f, source.name, in));
    readings.push_back(all.protocols.back().reading);
    if (readings.back().sheared_evenly != readings.front().sheared_evenly)
      throw RecordError(source.name +
                        ": replicates are of one instrument: all have torques, or all shear stresses");
  }
  set_geometry(f, all.protocols.front().record.sheared_evenly, all);
  const bool several = sources.size() > 1;
  const std::string law = several ? common_law(readings) : "";
  for (std::size_t i = 0; i < sources.size(); ++i) {
    const std::string own = law_read(readings[i]);
    if (!law.empty() && !own.empty() && own != law) {
      FitInput by_law = in;
      by_law.law = law, by_law.law_given = true;
      all.protocols[i] = fit_protocol(f, sources[i].name, by_law);
      readings[i] = all.protocols[i].reading;
      all.notes.push_back(
          sources[i].name + ": alone its flow curve has the law " + own + "; " +
          (law_read(readings[i]) == law
               ? "it is read by " + law + " as most of the records are: one material has one law"
               : law + ", which most of the records have, does not describe it: it is left out of the "
                       "flow curves' means"));
    }
    for (const auto& why : readings[i].reasons)
      all.reasons.push_back(several ? sources[i].name + ": " + why : why);
  }
  if (several) all.means = replicate_means(readings);
}

/// The records of a tribometer, each at its fill height, as one fit.
FitResult fit_tribometer_records(const Fitting& f, const std::vector<RecordSource>& sources,
                                 const FitInput& in) {
  std::vector<double> heights{in.instrument.vane_height};
  if (!f.options.fill_height.empty())
    heights = named("--fill-height", [&] { return fill_heights(f.options.fill_height); });
  if (heights.size() != sources.size())
    throw std::invalid_argument("--fill-height: one for each record, " + std::to_string(sources.size()) +
                                "; " + std::to_string(heights.size()) + " given");
  std::vector<TribometerSeries> series;
  for (std::size_t i = 0; i < sources.size(); ++i)
    series.push_back({heights[i], named(sources[i].name, [&] { return read(f, sources[i]); })});
  const SmoothWall wall = f.options.smooth_wall == "container" ? SmoothWall::container : SmoothWall::cylinder;
  FitResult result = named(sources.front().name, [&] { return fit_tribometer(series, in, wall); });
  result.notes.insert(result.notes.begin(), "geometry: " + geometry_words(f.reading, f.options, false));
  return result;
}

}  // namespace

RecordFits fit_records(const std::vector<RecordSource>& sources, const FitOptions& options,
                       const std::vector<std::filesystem::path>& data_folders) {
  check(options);
  const Fitting f{options, data_folders, reading_of(options, data_folders)};
  FitInput in = input_of(options);
  if (f.geometry().cylinders) in.instrument = *f.geometry().cylinders;
  named("the instrument", [&] { check(in.instrument); });
  RecordFits all;
  all.options = options;
  all.options.law = law_of(options);
  if (options.tribometer) {
    all.instrument = in.instrument;
    all.fits = {fit_tribometer_records(f, sources, in)};
    all.reasons = all.fits.front().reasons;
    set_geometry(f, false, all);
    return all;
  }
  all.end_factor = end_factor(f, sources.front(), in);
  in.instrument.vane_height *= all.end_factor;  // torque and height enter all formulas as their quotient
  all.instrument = in.instrument;
  if (options.protocol) {
    fit_protocols(f, sources, in, all);
    return all;
  }
  for (const RecordSource& source : sources) {
    all.fits.push_back(read_and_fit(f, source, in, all.end_factor));
    for (const auto& why : all.fits.back().reasons)
      all.reasons.push_back(sources.size() > 1 ? source.name + ": " + why : why);
  }
  set_geometry(f, all.fits.front().sheared_evenly, all);
  if (sources.size() > 1)
    all.means = replicate_means(all.fits);
  else
    all.moves = moves_by_ends(f, sources.front(), in, all.end_factor, all.fits.front());
  return all;
}

}  // namespace tremie
