#pragma once

#include <string>

#include "apparatus/report/fit_page/fit_page.hpp"
#include "rheometer/fits/fit.hpp"

namespace tremie::cli {

/// A fit in the form that its page takes. `record`: the file; `command` repeats the fit.
report::FitReport fit_report(const FitResult& result, const Instrument& instrument, const std::string& record,
                             const std::string& command);

}  // namespace tremie::cli
