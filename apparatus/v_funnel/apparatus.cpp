// The V-funnel of EN 12350-9: a flat funnel, and the time until light is seen through its gate.

#include <fmt/format.h>

#include <cmath>

#include "apparatus/parts/funnel/funnel.hpp"

namespace tremie::v_funnel {

using namespace scene;

namespace {

constexpr funnel::FunnelTest test{
    .name = "v_funnel",
    .words = "V-funnel",
    .help = "The V-funnel test of EN 12350-9.",
    .standard = {.top = 0.515, .mouth = 0.065, .taper = 0.45, .throat = 0.15, .depth = 0.075},
    .cell = "[\"5 mm\", \"8 mm\"]"};

/// EN 12350-9's funnel, whose dimensions may be off by 1 mm.
bool is_standard(const funnel::Shape& s) {
  const auto off = [](double x, double y) { return std::abs(x - y) > 1.001e-3; };
  const funnel::Shape& as = test.standard;
  return !(off(s.top, as.top) || off(s.mouth, as.mouth) || off(s.pipe, as.pipe) || off(s.taper, as.taper) ||
           off(s.throat, as.throat) || off(s.depth, as.depth));
}

/// EN 206's class of a flow time read to 0.1 s: "VF1" below 9.0 s, "VF2" up to 25.0 s; "" beyond.
std::string flow_class(double seconds) {
  const long tenths = std::lround(10.0 * seconds);
  return tenths < 90 ? "VF1" : tenths <= 250 ? "VF2" : "";
}

std::string class_of(const funnel::View& v) {
  return v.r.flow_time && is_standard(v.scene.shape) ? flow_class(*v.r.flow_time) : "";
}

std::string no_class(const funnel::View& v) {
  if (!is_standard(v.scene.shape)) return "none: the funnel is not that of EN 12350-9";
  return v.r.flow_time ? "none: the flow time is above 25.0 s" : "none: there is no flow time";
}

Rows<funnel::View> class_rows() {
  using V = const funnel::View&;
  return {{.name = "class_en12350_9",
           .words = "viscosity class of a flow time (EN 206)",
           .value = [](V v) { return word_or_null(class_of(v)); },
           .label = "class",
           .none = no_class}};
}

void judge(const funnel::View& v, Outcome& outcome) {
  const std::string cls = class_of(v);
  if (!cls.empty())
    outcome.judged =
        fmt::format("Class {} of EN 206: {}.", cls,
                    cls == "VF1" ? "the flow time is below 9.0 s" : "the flow time is 9.0 to 25.0 s");
}

}  // namespace

Apparatus apparatus() {
  static const auto readings = table_of<funnel::View>(time_column<funnel::View>(), funnel::flow_rows(),
                                                      class_rows(), funnel::course_rows());
  return funnel::apparatus_of(test, readings, judge);
}

}  // namespace tremie::v_funnel
