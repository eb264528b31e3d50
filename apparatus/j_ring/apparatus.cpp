// The J-ring: the cone is lifted inside a ring of bars, and the spread and the step that the bars make are read. The spread
// without the ring comes from a second run of the same scene.

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "apparatus/common/shared_keys.hpp"
#include "apparatus/parts/bars.hpp"
#include "apparatus/parts/cone/readings.hpp"

namespace tremie::j_ring {

using namespace scene;

namespace {

Section ring_section() {
  return {.name = "ring",
          .help =
              "Bars on a circle about the cone; the defaults are EN 12350-12's narrow gaps. Or ring = "
              "\"en_wide\" or "
              "\"astm\" (ASTM C1621), names from reference_data/rings, or a path to a .toml file.",
          .keys = {{.name = "bars", .kind = Kind::integer, .range = between(4, 64), .fallback = "16"},
                   {.name = "bar_diameter", .range = positive, .fallback = "18 mm"},
                   {.name = "diameter",
                    .range = positive,
                    .fallback = "300 mm",
                    .help = "of the circle through the bars' middles"},
                   {.name = "name", .kind = Kind::text, .help = "what people call it"},
                   {.name = "standard", .kind = Kind::text, .help = "that describes it"}}};
}

void settle(Values& values) {
  cone::settle(values);
  if (values.word("model.scheme") != "implicit")
    values.fail("model.scheme", "explicit steps do not know bars; allowed: \"implicit\"");
  if (values.word("model.method") == "newton")
    values.fail("model.method", "\"newton\" does not know bars; allowed: \"auto\" or \"admm\"");
  const auto bars = values.integer("ring.bars");
  if (values.word("model.space") == "quarter" && bars % 4 != 0)
    values.fail(
        "ring.bars",
        fmt::format("{} bars do not repeat in each quadrant; allowed in a quarter: a multiple of 4", bars));
}

ApparatusKeys keys() {
  return {.name = "j_ring",
          .help = "The J-ring test of EN 12350-12 and ASTM C1621.",
          .schema = joined(
              {mix_sections(),
               cone::sections(),
               {ring_section(), floor_section(), model_section({"quarter", "full"}), output_section()}}),
          .settle = settle};
}

/// The bars must stand clear of the cone and of each other.
void check_ring(const Values& values, const cone::Scene& scene) {
  const cone::Ring& ring = *scene.ring;
  const double inside = ring.diameter - ring.bar_diameter, foot = 2.0 * scene.cone.bottom_radius;
  if (inside <= foot)
    values.fail("ring.diameter",
                fmt::format("the bars stand in the cone; allowed: more than \"{}\", its foot and a bar",
                            write_quantity(foot + ring.bar_diameter, Dimension::length)));
  const double apart = ring.diameter * std::sin(std::numbers::pi / ring.bars);
  if (apart <= ring.bar_diameter)
    values.fail("ring.bar_diameter", fmt::format("the bars touch each other; allowed: less than \"{}\"",
                                                 write_quantity(apart, Dimension::length)));
}

cone::Scene read_scene(const Values& values) {
  cone::Scene scene = cone::read_scene(values);
  scene.ring = cone::Ring{.bars = static_cast<int>(values.integer("ring.bars")),
                          .bar_diameter = values.number("ring.bar_diameter"),
                          .diameter = values.number("ring.diameter")};
  check_ring(values, scene);
  return scene;
}

/// A run with the ring beside one without.
struct View : cone::View {
  const cone::Outcome& plain;
};

std::optional<double> spread_lost(const View& v) {
  if (v.status != Status::completed || v.plain.status != Status::completed) return std::nullopt;
  return v.plain.results.spread - v.r.spread;
}

/// Whether the bars have this diameter and stand on the standards' circle of 300 mm, each to 1 mm.
bool has_bars_of(double diameter, const cone::Ring& ring) {
  const auto is = [](double x, double y) { return std::abs(x - y) < 1.001e-3; };
  return is(ring.bar_diameter, diameter) && is(ring.diameter, 0.3);
}

/// ASTM C1621's ring.
bool is_astm(const cone::Ring& ring) { return ring.bars == 16 && has_bars_of(0.016, ring); }

/// The assessment of ASTM C1621 by the spread that is lost.
std::string blocking_of(const View& v) {
  const auto lost = spread_lost(v);
  if (!lost || !is_astm(*v.scene.ring) || !cone::is_abrams(v.scene.cone, true)) return "";
  return *lost <= 0.025   ? "no visible blocking"
         : *lost <= 0.050 ? "minimal to noticeable blocking"
                          : "noticeable to extreme blocking";
}

std::string no_blocking(const View& v) {
  return spread_lost(v) ? "none: ring or cone are not those of ASTM C1621"
                        : "not known: a run did not come to its end";
}

/// EN 12350-12's rings: 12 bars for PJ1, 16 for PJ2.
bool is_en(const cone::Ring& ring) {
  return (ring.bars == 12 || ring.bars == 16) && has_bars_of(0.018, ring);
}

/// EN 206's class of passing ability: a blocking step of at most 10 mm.
std::string class_of(const View& v) {
  constexpr double most = 0.0105;  // read to whole millimetres
  const cone::Ring& ring = *v.scene.ring;
  if (v.status != Status::completed || !is_en(ring) || !cone::is_abrams(v.scene.cone, true) ||
      v.r.step >= most)
    return "";
  return ring.bars == 12 ? "PJ1" : "PJ2";
}

std::string no_class(const View& v) {
  return is_en(*v.scene.ring) && cone::is_abrams(v.scene.cone, true)
             ? "none: the step is more than 10 mm"
             : "none: ring or cone are not those of EN 12350-12";
}

const std::vector<Reading<View>>& readings() {
  using V = const View&;
  using S = const cone::Sample&;
  static const auto table = table_of<View>(
      time_column<View>(),
      Rows<View>{cone::spread_row<View>(),
                 cone::t500_row<View>(),
                 {.name = "step_mm",
                  .words = "blocking step: height at the centre less that outside of the bars (EN 12350-12)",
                  .value = [](V v) { return number(v.r.step, mm); },
                  .label = "blocking step",
                  .digits = 1,
                  .answer = [](V) { return std::optional<std::string>("blocking step"); },
                  .headline = 2,
                  .headline_digits = 1,
                  .measurable = true},
                 {.name = "class_en206_pj",
                  .words = "passing ability class PJ1 or PJ2 (EN 206), without stones",
                  .value = [](V v) { return word_or_null(class_of(v)); },
                  .label = "class",
                  .none = no_class},
                 {.name = "spread_lost_mm",
                  .words = "spread without the ring less that with it",
                  .value = [](V v) { return number(spread_lost(v), mm); },
                  .label = "spread lost",
                  .none = [](V) { return std::string("not known: a run did not come to its end"); },
                  .measurable = true},
                 {.name = "blocking_astm_c1621",
                  .words = "assessment of the spread that is lost (ASTM C1621)",
                  .value = [](V v) { return word_or_null(blocking_of(v)); },
                  .label = "assessment",
                  .none = no_blocking},
                 {"height_mm", "height at the centre", [](V v) { return number(v.r.height, mm); },
                  [](V, S s) { return s.height * mm; }}},
      stopped_row<View>(), flocculation_rows<View>(), motion_columns<View>(), step_columns<View>());
  return table;
}

/// The fastest that the concrete came through the bars: half of the spread's rate beyond the ring [m/s].
double speed_at_the_bars(const View& v) {
  double speed = 0.0;
  for (std::size_t i = 1; i < v.series.size(); ++i)
    if (v.series[i].spread > v.scene.ring->diameter && v.series[i].time > v.series[i - 1].time)
      speed = std::max(speed, 0.5 * (v.series[i].spread - v.series[i - 1].spread) /
                                  (v.series[i].time - v.series[i - 1].time));
  return speed;
}

std::string inertia_at_the_bars(const View& v) {
  return parts::bars_with_inertia(v.scene.mix, v.scene.model.law, speed_at_the_bars(v),
                                  v.scene.ring->bar_diameter);
}
std::string wide_cells_at_the_bars(const View& v) {
  return parts::cells_between_bars(v.scene.model.cell[0], v.scene.ring->bar_diameter);
}

/// The same scene without the ring; its progress is shown, its frames are nobody's.
cone::Outcome run_without_ring(cone::Scene scene, const Observer& observer) {
  scene.ring.reset();
  return cone::run(scene, {.on_progress = observer.on_progress, .interrupted = observer.interrupted});
}

Outcome run(const cone::Scene& scene, const RunOptions& options, const Observer& observer) {
  const cone::Outcome plain = run_without_ring(scene, observer), raw = cone::run(scene, observer);
  const View view{{scene, raw}, plain};
  Outcome outcome = outcome_of(readings(), view, options.measured.name, "J-ring");
  add_reasons<View>({inertia_at_the_bars, wide_cells_at_the_bars}, view, outcome.checks.reasons);
  for (const std::string& reason : plain.checks.reasons)
    outcome.checks.reasons.push_back("without the ring: " + reason);
  if (const std::string blocking = blocking_of(view); !blocking.empty())
    outcome.judged =
        fmt::format("ASTM C1621 calls a loss of {:.0f} mm {}.", mm * *spread_lost(view), blocking);
  outcome.moving_at_end = !raw.results.stopped_at;
  if (raw.results.spread < scene.ring->diameter && !outcome.moving_at_end)
    outcome.remarks.push_back(
        "The concrete stopped before it reached the bars: the ring took nothing from it.");
  outcome.remarks.push_back(
      "The bars are a drag on a fluid: no stone can block them. What concrete loses by blocking is more than "
      "this.");
  outcome.stage = cone::stage_of(scene);
  outcome.charts = cone::charts_of(scene, {});
  return outcome;
}

std::vector<std::string> uses(const cone::Scene& scene) {
  std::vector<std::string> lines = cone::uses(scene);
  const bool resolved = parts::resolves_bars(scene.model.cell[0], scene.ring->bar_diameter);
  lines.push_back(fmt::format("ring: {} bars of {:g} mm, {}; a second run without them", scene.ring->bars,
                              mm * scene.ring->bar_diameter, resolved ? "resolved" : "by their drag"));
  return lines;
}

/// Twice the steps: with the ring and without.
SizeEstimate estimate(const cone::Scene& scene) {
  SizeEstimate e = cone::estimate(scene);
  e.steps *= 2, e.steps_expected *= 2, e.time_expected *= 2.0;
  return e;
}

}  // namespace

Apparatus apparatus() {
  return make_apparatus<cone::Scene>(apparatus_of(keys(), "J-ring", readings()), read_scene, uses, run,
                                     estimate);
}

}  // namespace tremie::j_ring
