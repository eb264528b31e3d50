#pragma once

namespace tremie::cli {

/// Becomes tremie-study, with the same arguments; returns an exit code where that cannot be. A build without
/// SUNDIALS or Ceres has no tremie-study, and says what to install.
int hand_over(char** argv);

}  // namespace tremie::cli
