// The Orimet: an upright pipe with a narrower casting orifice at its foot, and the time in which its concrete falls out.

#include "apparatus/parts/funnel/funnel.hpp"

namespace tremie::orimet {

using namespace scene;

Apparatus apparatus() {
  static const auto readings =
      table_of<funnel::View>(time_column<funnel::View>(), funnel::flow_rows(), funnel::course_rows());
  return funnel::apparatus_of({.name = "orimet",
                               .words = "Orimet",
                               .help = "The flow time of concrete through the Orimet.",
                               .standard = {.top = 0.12, .mouth = 0.08, .pipe = 0.6, .taper = 0.09}},
                              readings);
}

}  // namespace tremie::orimet
