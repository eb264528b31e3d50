#pragma once

#include <string>
#include <vector>

#include "apparatus/report/fit_page/fit_page.hpp"
#include "apparatus/report/fit_page/replicates_page.hpp"
#include "rheometer/fits/fit.hpp"
#include "rheometer/fits/replicates.hpp"

namespace tremie::cli {

/// A fit in the form that its page takes. `record`: the file; `command` repeats the fit.
report::FitReport fit_report(const FitResult& result, const Instrument& instrument, const std::string& record,
                             const std::string& command);

/// Fits of one material's records, their means and their pages, in the form that the page of all takes.
report::ReplicatesReport replicates_report(const std::vector<FitResult>& fits,
                                           const std::vector<ReplicateMean>& means,
                                           std::vector<report::FitReport> reports,
                                           const std::string& command);

}  // namespace tremie::cli
