# Python's module: a shared object made of the same static libraries as the program, so that both have the same digits.
option(TREMIE_PYTHON "Build the module tremie for Python (needs pybind11 and NumPy)" ON)
set(TREMIE_PYTHON_FOUND OFF)
if(NOT TREMIE_PYTHON OR TREMIE_SANITIZE)
  return()
endif()

# Debian's pybind11 and NumPy are for Debian's Python, whatever else comes first in the path; -DPython_EXECUTABLE names
# another.
if(NOT DEFINED Python_EXECUTABLE AND EXISTS /usr/bin/python3)
  set(Python_EXECUTABLE /usr/bin/python3 CACHE FILEPATH "Python that the module is for")
endif()
find_package(Python 3.9 QUIET COMPONENTS Interpreter Development.Module NumPy)
set(PYBIND11_FINDPYTHON ON)
find_package(pybind11 2.9 QUIET CONFIG)
if(NOT Python_FOUND OR NOT pybind11_FOUND)
  message(STATUS "Without pybind11-dev, python3-dev and python3-numpy: no module for Python")
  return()
endif()
set(TREMIE_PYTHON_FOUND ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
# Calls inside of the shared object stay as direct, and as open to inlining, as in a program.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
