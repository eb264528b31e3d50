# tremie_precompile(TARGET HEADER...): reads wide headers once for all files of a target. It pays from five files on: reading
# Eigen, fmt and the standard library takes g++ some two seconds a file.
option(TREMIE_PRECOMPILE "Precompile wide headers" ON)
function(tremie_precompile target)
  if(TREMIE_PRECOMPILE)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <functional> <optional> <string> <vector> ${ARGN})
  endif()
endfunction()

# tremie_together(TARGET...): files of a target are compiled eight at a time. Most of a small file's compilation is its
# headers', the templates of fmt and JSON among them: eight together take g++ a third of their time one by one. Under
# sanitizers and in a debug build each is compiled alone, so that none leans on what another has included. A file whose own
# names another has too is named by tremie_alone(FILE...).
option(TREMIE_UNITY "Compile small files together" ON)
function(tremie_together)
  foreach(target ${ARGN})
    set_target_properties(${target} PROPERTIES UNITY_BUILD ${TREMIE_UNITY} UNITY_BUILD_BATCH_SIZE 8
      UNITY_BUILD_CODE_BEFORE_INCLUDE "#pragma GCC diagnostic ignored \"-Wshadow\"")  # a file's names do not hide another's
  endforeach()
endfunction()
function(tremie_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
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
  tremie_together(${ARGN})
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
