# Toolchain of the preset web: Debian's emscripten, wherever it is installed. Binaries for the browser find no
# packages of this machine; the headers that they need are named in apparatus/web/CMakeLists.txt.
execute_process(COMMAND em-config EMSCRIPTEN_ROOT OUTPUT_VARIABLE root OUTPUT_STRIP_TRAILING_WHITESPACE RESULT_VARIABLE failed)
if(failed)
  message(FATAL_ERROR "The preset web needs emscripten: apt-get install emscripten")
endif()
include(${root}/cmake/Modules/Platform/Emscripten.cmake)
