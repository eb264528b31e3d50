# Debian packages: tremie (program, libraries, headers, mixes, man pages, completions) and python3-tremie. cpack in the
# build folder of the preset package, which compiles for any x86-64 processor.
include(GNUInstallDirs)

# Man pages from the program's help, completions that ask the program.
find_program(TREMIE_HELP2MAN help2man)
if(TREMIE_HELP2MAN)
  set(stamp ${PROJECT_BINARY_DIR}/man/tremie.1.gz)
  add_custom_command(OUTPUT ${stamp} DEPENDS tremie ${PROJECT_SOURCE_DIR}/cmake/man_pages.sh
                     COMMAND ${PROJECT_SOURCE_DIR}/cmake/man_pages.sh ${TREMIE_HELP2MAN} $<TARGET_FILE:tremie>
                             ${PROJECT_BINARY_DIR}/man VERBATIM)
  add_custom_target(tremie_man ALL DEPENDS ${stamp})
  install(DIRECTORY ${PROJECT_BINARY_DIR}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
else()
  message(STATUS "Without help2man: no man pages")
endif()
install(FILES ${PROJECT_SOURCE_DIR}/cmake/completions/tremie.bash
        DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME tremie)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/completions/_tremie
        DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)

# The programs and Python's core once more for each level of x86-64 that is named: at its start the program becomes, and the
# module takes, the best that the processor has (apparatus/cli/process/levels.hpp).
set(TREMIE_LEVELS "" CACHE STRING "Levels of x86-64 that the programs are compiled for too, as -march names them")
include(ExternalProject)
foreach(level ${TREMIE_LEVELS})
  set(folder ${PROJECT_BINARY_DIR}/levels/${level})
  set(targets tremie)
  if(TREMIE_PYTHON_FOUND)
    list(APPEND targets tremie_python)
  endif()
  ExternalProject_Add(tremie_${level} SOURCE_DIR ${PROJECT_SOURCE_DIR} BINARY_DIR ${folder} PREFIX ${folder}-project
    CMAKE_GENERATOR ${CMAKE_GENERATOR} LIST_SEPARATOR | BUILD_ALWAYS ON USES_TERMINAL_BUILD ON INSTALL_COMMAND ""
    CMAKE_ARGS -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE} -DCMAKE_SKIP_RPATH=ON -DTREMIE_NATIVE=OFF -DTREMIE_TESTS=OFF -DTREMIE_PICTURES=OFF
      "-DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS} -march=${level}" "-DCMAKE_EXE_LINKER_FLAGS=${CMAKE_EXE_LINKER_FLAGS} -s"
      "-DCMAKE_MODULE_LINKER_FLAGS=${CMAKE_SHARED_LINKER_FLAGS} -s" -DPython_EXECUTABLE=${Python_EXECUTABLE}
    BUILD_COMMAND ${CMAKE_COMMAND} --build ${folder} --target ${targets})
  set(programs ${folder}/tremie)
  if(TARGET tremie_study)
    list(APPEND programs ${folder}/tremie-study)
  endif()
  install(PROGRAMS ${programs} DESTINATION lib/tremie/${level})
  if(TREMIE_PYTHON_FOUND)
    install(DIRECTORY ${folder}/python/tremie/ DESTINATION ${TREMIE_PYTHON_FOLDER}/tremie/${level} COMPONENT python
            FILES_MATCHING PATTERN *.so)
  endif()
endforeach()

# Two changelogs in a package: ours for users, and Debian's by version.
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/CHANGELOG.md)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz)
execute_process(COMMAND ${PROJECT_SOURCE_DIR}/cmake/debian_changelog.sh ${PROJECT_SOURCE_DIR}/CHANGELOG.md ${PROJECT_VERSION}
                        ${CPACK_DEBIAN_PACKAGE_RELEASE}
                COMMAND gzip -9nc OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.Debian.gz)
set(changelogs ${PROJECT_BINARY_DIR}/changelog.gz ${PROJECT_BINARY_DIR}/changelog.Debian.gz)
set(documents ${CMAKE_INSTALL_DATADIR}/doc)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${documents}/tremie RENAME copyright)
install(FILES ${changelogs} DESTINATION ${documents}/tremie)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME tremie)
set(CPACK_PACKAGE_CONTACT "Tremie contributors <maintainers@tremie.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "virtual test apparatus for thixotropic fresh concrete")
set(CPACK_PACKAGE_DESCRIPTION
    "Slump flow, L-box and vane rheometer by the Material Point Method, and fits of\n torque records.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_NAME tremie)
set(CPACK_DEBIAN_UNSPECIFIED_DESCRIPTION ${CPACK_PACKAGE_DESCRIPTION})
set(CPACK_DEBIAN_UNSPECIFIED_PACKAGE_SUGGESTS "libeigen3-dev, libfmt-dev, libsundials-dev, libceres-dev, libboost-dev")
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)

if(TREMIE_PYTHON_FOUND)
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${documents}/python3-tremie RENAME copyright COMPONENT python)
  install(FILES ${changelogs} DESTINATION ${documents}/python3-tremie COMPONENT python)
  math(EXPR next_minor "${Python_VERSION_MINOR} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-tremie)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "The same in Python: scenes, fits and estimates in process, results as NumPy\n arrays.")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "tremie (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), python3 (>= ${Python_VERSION_MAJOR}.${Python_VERSION_MINOR}), python3 (<< ${Python_VERSION_MAJOR}.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-h5py, python3-matplotlib")
endif()
include(CPack)
