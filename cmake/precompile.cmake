# tremie_precompile(TARGET HEADER...): reads wide headers once for all files of a target. It pays from five files on: reading
# Eigen, fmt and the standard library takes g++ some two seconds a file.
option(TREMIE_PRECOMPILE "Precompile wide headers" ON)
function(tremie_precompile target)
  if(TREMIE_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()
