# tremie_precompile(TARGET HEADER...): reads wide headers once for all files of a target. It pays from five files on: reading
# Eigen, fmt and the standard library takes g++ some two seconds a file.
option(TREMIE_PRECOMPILE "Precompile wide headers" ON)
function(tremie_precompile target)
  if(TREMIE_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()

# tremie_cold(TARGET...): little time of a run is spent in these; compiling them takes a third less with fewer
# optimisations, half with none, as under sanitizers.
if(TREMIE_SANITIZE)
  set(cold -O0)
else()
  set(cold $<$<CONFIG:Release>:-O1>)
endif()
list(APPEND cold $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>
                 $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow>)  # false, in the compiler's own headers
function(tremie_cold)
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE ${cold})
  endforeach()
endfunction()

# tremie_cold_headers(TARGET...): cold targets that share the wide headers of apparatus/cold_headers.cpp, read once for all.
# They are compiled as those were: position independent, with OpenMP.
function(tremie_cold_headers)
  tremie_cold(${ARGN})
  foreach(target ${ARGN})
    target_compile_options(${target} PRIVATE -fPIC ${OpenMP_CXX_FLAGS})
    target_compile_definitions(${target} PRIVATE EIGEN_DONT_PARALLELIZE)
    if(TREMIE_PRECOMPILE AND NOT target STREQUAL tremie_cold_headers)
      target_precompile_headers(${target} REUSE_FROM tremie_cold_headers)
    endif()
  endforeach()
endfunction()
