#pragma once

namespace tremie::report {

/// The one visual style of every report: screen from 390 px, light and dark, A4 print.
extern const char* const style_sheet;

}  // namespace tremie::report
