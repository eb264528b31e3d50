// The inverted cone: the slump cone upside down, full of concrete, and the time that it takes to empty through its narrow end.

#include "apparatus/parts/funnel/funnel.hpp"

namespace tremie::inverted_cone {

using namespace scene;

Apparatus apparatus() {
  static const auto readings =
      table_of<funnel::View>(time_column<funnel::View>(), funnel::flow_rows(), funnel::course_rows());
  return funnel::apparatus_of({.name = "inverted_cone",
                               .words = "inverted cone",
                               .help = "The flow time of concrete through the slump cone upside down.",
                               .standard = {.top = 0.2, .mouth = 0.1, .taper = 0.3}},
                              readings);
}

}  // namespace tremie::inverted_cone
