# One interface target carries every compile option, so that a target opts in with a single link line.
add_library(tremie_flags INTERFACE)
target_include_directories(tremie_flags INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
                                                  $<INSTALL_INTERFACE:include/tremie>)
target_compile_features(tremie_flags INTERFACE cxx_std_20)
target_compile_options(tremie_flags INTERFACE
  "$<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wshadow;-Wconversion;-Werror>"
  -fno-math-errno
  # Eight doubles are passed between inlined functions alone, never over a binary interface.
  -Wno-psabi
  # As g++ has it: in C++ its -Wconversion leaves signs out.
  $<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion -Wno-unknown-attributes>
  # g++ 12 reports these inside Eigen's and the standard library's inlined code.
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized -Wno-array-bounds -Wno-stringop-overread -Wno-restrict
                             -Wno-aggressive-loop-optimizations>)

if(TREMIE_NATIVE AND NOT TREMIE_SANITIZE)
  target_compile_options(tremie_flags INTERFACE -march=native)  # exported too: Eigen's alignment depends on it
endif()

if(TREMIE_SANITIZE)
  target_compile_options(tremie_flags INTERFACE -fsanitize=${TREMIE_SANITIZE} -fno-omit-frame-pointer
                                                -fno-sanitize-recover=all)
  target_link_options(tremie_flags INTERFACE -fsanitize=${TREMIE_SANITIZE})
  # With this sanitizer g++ 12 reports what Eigen's factors leave unset until they factorise.
  if(TREMIE_SANITIZE MATCHES "undefined")
    target_compile_options(tremie_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized>)
  endif()
endif()
