#pragma once

// A finished run as the same test with a later end.

#include <string>

#include "apparatus/report/run_files/checkpoint_files.hpp"

namespace tremie::cli {

/// The request of the same test until the time `until`, "300 s": the scene with that test.duration, as --set would have
/// made it. Throws scene::InputError where the test has no such key or was as long before.
report::RunRequest longer_test(const report::RunRequest& request, const std::string& until);

/// Throws scene::InputError with the reason why the run in a folder has no state to go on from.
[[noreturn]] void refuse_longer_test(const std::string& folder);

}  // namespace tremie::cli
