#include "apparatus/parts/cone/readings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "apparatus/slump_flow/slump_flow.hpp"
#include "libmpm/constitutive/constants.hpp"

namespace tremie::slump_flow {
namespace {

using namespace scene;
using cone::Results;

// Accepted for tremie concrete by the sources of Wilkes, Kumar and Biscontin (EFFC/DFI).
constexpr double tremie_range_low = 0.450, tremie_range_high = 0.650;

bool in_tremie_range(double spread) { return spread >= tremie_range_low && spread <= tremie_range_high; }

bool stopped(const Results& r) { return r.stopped_at.has_value() && std::isfinite(r.spread); }

/// Classes are those of concrete at rest that the Abrams cone left.
bool has_classes(const cone::Scene& scene, const Results& r) {
  return stopped(r) && cone::is_abrams(scene.cone);
}

std::string class_of(const cone::Scene& scene, const Results& r) {
  return has_classes(scene, r) ? cone::spread_class(r.spread) : std::string{};
}

double slump_at(const cone::View& v, double height) { return std::max(0.0, v.scene.cone.height - height); }
double slump_of(const cone::View& v) { return slump_at(v, v.r.height); }

std::string slump_class_of(const cone::View& v) {
  return has_classes(v.scene, v.r) ? cone::slump_class(slump_of(v)) : std::string{};
}

/// Concrete that a laboratory reads by its slump: up to S4.
bool is_stiff(const cone::View& v) { return has_classes(v.scene, v.r) && slump_class_of(v) != "S5"; }

/// Read to 10 mm, as the standard has it, so that SF1 begins at 545 mm.
bool is_below(const Results& r) { return r.spread < 0.545; }

ResultValue range_of(const cone::Scene& scene, const Results& r) {
  if (!has_classes(scene, r)) return std::monostate{};
  return in_tremie_range(r.spread);
}

/// What was measured on the mix by the Abrams cone after the rest that this scene has; nothing for any other rest or cone.
/// [measured] wins.
std::optional<Measurement> measurement_for(const cone::Scene& scene, const Measured& measured,
                                           double spread) {
  std::optional<double> value = measured.spread;
  double tolerance = measured.spread_tolerance.value_or(0.03);
  if (!value && cone::is_abrams(scene.cone)) {
    if (scene.rest == 0.0) value = measured.slump_flow_0;
    if (scene.rest == 240.0) value = measured.slump_flow_240;
    tolerance = measured.tolerance;
  }
  if (!value) return std::nullopt;
  return Measurement{"spread_mm",
                     "spread",
                     "mm",
                     *value * mm,
                     tolerance * mm,
                     (spread - *value) * mm,
                     measured.spread ? std::string{} : measured.on};
}

std::vector<Reference> references_for(const std::optional<Measurement>& measured) {
  if (!measured) return {};
  const std::string label = measured->on.empty() ? "measured" : "measured on " + measured->on;
  return {{label, measured->value, measured->tolerance}};
}

/// A run beside what was measured on its concrete.
struct View : cone::View {
  const Measured& measured;
  std::optional<Measurement> measurement = measurement_for(scene, measured, r.spread);
};

/// Concrete that hardly left the cone's own foot and height.
bool kept_its_shape(const Results& r, const cone::Cone& cone) {
  return r.spread < 2.1 * cone.bottom_radius && r.height > 0.9 * cone.height;
}

/// Class and accepted range; only of concrete at rest.
std::string judged(const cone::View& v) {
  const cone::Scene& scene = v.scene;
  const Results& r = v.r;
  if (!stopped(r)) return {};
  if (!cone::is_abrams(scene.cone))
    return "Not the Abrams cone of EN 12350: its spread has no class, and no accepted range.";
  if (kept_its_shape(r, scene.cone))
    return "It kept the cone's shape: too stiff for a slump flow, so there is no spread to read.";
  const std::string slump = slump_class_of(v);
  if (is_stiff(v))
    return fmt::format("{}; too stiff for the classes of self-compacting concrete and for tremie concrete.",
                       slump.empty() ? "A slump below class S1 of EN 206"
                                     : fmt::format("Class {} of EN 206 by its slump (read to 10 mm)", slump));
  const std::string cls = class_of(scene, r);
  std::string text = !cls.empty()  ? fmt::format("Class {} of EN 206 (the spread read to 10 mm)", cls)
                     : is_below(r) ? "Below the classes of self-compacting concrete (SF1 begins at 550 mm)"
                                   : "Above the classes of self-compacting concrete (SF3 ends at 850 mm)";
  return text + (in_tremie_range(r.spread)
                     ? "; within the 450 to 650 mm that are accepted for tremie concrete."
                     : "; outside of the 450 to 650 mm that are accepted for tremie concrete.");
}

/// Why a spread may differ from the measured one although the computation is right.
constexpr const char* why_it_may_differ =
    "Where a spread differs from the measured one by more than the error of the computation, the scene's "
    "values are the likely cause. Yield stress and viscosity come from a rheometer, and instruments differ "
    "by "
    "a quarter and more. After a rest the rate of breakdown decides: measure it on your own concrete. The "
    "plate may hold the concrete or let it slide (floor.contact). tremie calibrate finds the values that "
    "meet "
    "the measurements.";

/// Whether t500, or its existence, depends on the last millimetres: below 514 mm estimates from a t500 end too.
bool near_500(const cone::Scene& scene, const Results& r) {
  return stopped(r) && cone::is_abrams(scene.cone, true) && std::abs(r.spread - 0.5) < 0.014;
}

/// EN 12350-8's plate.
constexpr double plate = 0.9;

bool beyond_the_plate(const cone::Scene& scene, const Results& r) {
  return cone::is_abrams(scene.cone, true) && r.spread > plate;
}

/// Whether the mould is so small, and its concrete so fluid, that the spread depends on the lift: while the cone rises, what
/// runs out of it has come to rest already.
bool hangs_on_the_lift(const cone::Scene& scene) {
  return cone::scale_of(scene.cone) < 0.6 &&
         scene.mix.tau_0 < 0.05 * scene.mix.density * tremie::gravity * scene.cone.height;
}

/// What a reader must know who has no measurement to compare with, or a spread that is hard to read.
std::vector<std::string> remarks_on(const cone::Scene& scene, const std::optional<Measurement>& measured,
                                    const Results& r) {
  std::vector<std::string> remarks;
  if (measured && measured->on.empty())
    remarks.push_back(why_it_may_differ);
  else
    remarks.push_back(
        "Not compared with a measurement. For three measured concretes, a rheometer's values gave spreads "
        "5 to 12 % too small when fresh. Values estimated from a spread avoid this difference.");
  const auto alpha = scene.mix.thixotropy ? destructuration(scene.mix.thixotropy->kinetics) : std::nullopt;
  if (scene.rest > 0.0 && alpha && !(measured && measured->on.empty()))
    remarks.push_back(
        fmt::format("The destructuration α (here {:.3g}) decides how much of what built up at rest is left "
                    "after the lift. It is seldom measured: see what 0.01 and 1 give.",
                    *alpha));
  if (beyond_the_plate(scene, r))
    remarks.push_back(
        "The spread is wider than the standard's plate of 900 mm: a laboratory would see it run off.");
  if (hangs_on_the_lift(scene))
    remarks.push_back(
        "A small cone's spread depends on its lift (10 Pa, 0.3 Pa·s in the Haegermann cone: 291 mm if "
        "removed instantaneously, 278 at 15 cm/s, 249 at 1 cm/s): set test.lift_speed to that of the "
        "experiment.");
  if (near_500(scene, r))
    remarks.push_back(
        "The spread is so close to 500 mm that t500, or its existence, depends on the last millimetres: "
        "finer cells may change t500 by a third.");
  return remarks;
}

std::string no_class(const cone::Scene& scene, const Results& r, Status status) {
  if (!cone::is_abrams(scene.cone)) return "no class: not the Abrams cone";
  if (stopped(r)) return is_below(r) ? "below class SF1 (550 mm)" : "above class SF3 (850 mm)";
  return ended_early(status) ? "so far: no class" : "no class yet: it still moves";
}

std::string class_text(const cone::Scene& scene, const Results& r, Status status) {
  const std::string cls = class_of(scene, r);
  return cls.empty() ? no_class(scene, r, status) : "class " + cls + " (read to 10 mm)";
}

std::vector<std::string> range_lines(const View& v) {
  if (!has_classes(v.scene, v.r)) return {};
  return {fmt::format("tremie concrete {} the accepted 450 to 650 mm",
                      in_tremie_range(v.r.spread) ? "within" : "outside of")};
}

using V = const View&;

/// What was measured on the concrete, and how far off the run is.
Rows<View> measured_rows() {
  return table_of<View>(
      only_where<View>(
          [](V v) { return v.measurement.has_value(); },
          {{"measured.spread_mm", "measured slump flow", [](V v) { return number(v.measurement->value); }},
           {"measured.tolerance_mm", "its tolerance", [](V v) { return number(v.measurement->tolerance); }},
           {"measured.difference_mm", "computed minus measured",
            [](V v) { return number(v.measurement->difference); }}}),
      only_where<View>([](V v) { return v.measured.t500.has_value(); },
                       {{"measured.t500_s", "measured t500", [](V v) { return number(v.measured.t500); }},
                        {"measured.t500_difference_s", "", [](V v) {
                           return v.r.t500 ? number(*v.r.t500 - *v.measured.t500) : ResultValue{};
                         }}}));
}

const std::vector<Reading<View>>& readings() {
  using S = const cone::Sample&;
  static const auto table = [] {
    Reading<View> spread = cone::spread_row<View>(), t500 = cone::t500_row<View>();
    spread.remark = [](V v) {
      return "   " + class_text(v.scene, v.r, v.status) +
             (beyond_the_plate(v.scene, v.r) ? ", wider than the plate of 900 mm" : "");
    };
    spread.answer = [](V v) { return is_stiff(v) ? std::nullopt : std::optional(std::string()); };
    t500.none = [](V v) {
      return cone::is_abrams(v.scene.cone, true) ? not_reached(v) : std::string("not the Abrams cone");
    };
    t500.remark = [](V v) {
      return std::string(near_500(v.scene, v.r) ? "   not to be relied on: the spread ends too near to 500 mm"
                                                : "");
    };
    return table_of<View>(
        time_column<View>(),
        Rows<View>{spread,
                   {"spread_max_point_mm", "twice the radius of the outermost point's centre",
                    [](V v) { return number(v.r.spread_max_point, mm); },
                    [](V, S s) { return s.spread_max_point * mm; }},
                   {.name = "height_mm",
                    .words = "height at the centre",
                    .value = [](V v) { return number(v.r.height, mm); },
                    .at = [](V, S s) { return s.height * mm; },
                    .label = "height",
                    .headline = 2,
                    .headline_digits = 1,
                    .measurable = true},
                   t500},
        stopped_row<View>(),
        Rows<View>{{.name = "class_en12350_8",
                    .words = "slump-flow class (EN 206); of concrete at rest",
                    .value = [](V v) { return word_or_null(class_of(v.scene, v.r)); },
                    .none = [](V v) { return no_class(v.scene, v.r, v.status); }}},
        flocculation_rows<View>(),
        Rows<View>{{"shear_rate_mean_peak_per_s", "largest mean shear rate",
                    [](V v) { return number(v.r.shear_rate_mean_peak); }},
                   {"mean_velocity_mm_per_s", "(SF − 200 mm)/(2 t_stop): high for a mix that stops early",
                    [](V v) { return number(v.r.mean_velocity, mm); }},
                   {.name = "within_tremie_range",
                    .words = "within 450 to 650 mm (tremie concrete)",
                    .value = [](V v) { return range_of(v.scene, v.r); },
                    .none =
                        [](V v) {
                          return std::string(cone::is_abrams(v.scene.cone) ? "not yet known: it still moved"
                                                                           : "not the Abrams cone");
                        },
                    .lines = range_lines}},
        measured_rows(),
        Rows<View>{cone::time_row<View>("t400_s", "t400, time to a diameter of 400 mm", "t400",
                                        [](V v) { return number(cone::time_to_spread(v.series, 0.4)); })},
        motion_columns<View>(),
        Rows<View>{{"kinetic_energy_J", "", {}, [](V, S s) { return s.kinetic_energy; }}},
        step_columns<View>(),
        Rows<View>{
            {.name = "slump_mm",
             .words = "slump, the cone's height less that of the concrete",
             .value = [](V v) { return number(slump_of(v), mm); },
             .at = [](V v, S s) { return slump_at(v, s.height) * mm; },
             .label = "slump",
             .remark =
                 [](V v) {
                   const std::string cls = slump_class_of(v);
                   return cls.empty() ? cls : "   class " + cls;
                 },
             .answer = [](V v) { return is_stiff(v) ? std::optional<std::string>("slump") : std::nullopt; },
             .measurable = true},
            {.name = "class_en206_slump",
             .words = "slump class (EN 206); of concrete at rest, from the Abrams cone",
             .value = [](V v) { return word_or_null(slump_class_of(v)); },
             .none =
                 [](V v) {
                   if (!cone::is_abrams(v.scene.cone)) return std::string("not the Abrams cone");
                   return std::string(stopped(v.r) ? "below class S1 (10 mm)"
                                                   : "not yet known: it still moved");
                 }}});
  }();
  return table;
}

Outcome run(const cone::Scene& scene, const RunOptions& options, const Observer& observer) {
  const cone::Outcome raw = cone::run(scene, observer);
  const View view{{scene, raw}, options.measured};
  Outcome outcome = outcome_of(readings(), view, options.measured.name, "slump flow");
  outcome.measured = view.measurement;
  outcome.moving_at_end = !raw.results.stopped_at;
  outcome.judged = judged(view);
  outcome.remarks = remarks_on(scene, outcome.measured, raw.results);
  outcome.stage = cone::stage_of(scene);
  outcome.charts = cone::charts_of(scene, references_for(outcome.measured));
  outcome.axisymmetric = scene.model.space == SpaceKind::axisymmetric;
  return outcome;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<cone::Scene>(apparatus_of(keys(), "slump flow", readings()), cone::read_scene,
                                     cone::uses, run, cone::estimate);
}

}  // namespace tremie::slump_flow
