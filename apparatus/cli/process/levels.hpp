#pragma once

namespace tremie::cli {

/// Becomes the same program compiled for the best level of x86-64 that this processor has, where the installation has one
/// better than this: PREFIX/lib/tremie/LEVEL beside PREFIX/bin. The environment's TREMIE_LEVEL names a level, which is
/// then the best; a name that is none ends the program with code 2.
void become_best_level(char** argv);

}  // namespace tremie::cli
