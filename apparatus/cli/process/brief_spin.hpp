#pragma once

namespace tremie::cli {

/// Before a run with several threads: starts the program anew with OpenMP's threads told to sleep
/// after a tenth of a millisecond of waiting, unless the user has set OMP_WAIT_POLICY or GOMP_SPINCOUNT. Call it
/// before anything is written.
/// Returns where there is nothing to do, or where the program cannot be started again.
void spin_briefly(int threads);

}  // namespace tremie::cli
