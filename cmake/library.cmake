# find_package(tremie): the libraries and their headers, as targets tremie::mpm, tremie::rheometer, tremie::scene, ...
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)
set(exported tremie_flags tremie_constitutive tremie_mpm tremie_rheometer tremie_scene_reader tremie_run_loop tremie_parts
             tremie_scene)
foreach(name ${TREMIE_APPARATUS})
  list(APPEND exported tremie_${name})
endforeach()
if(TARGET tremie_fits)
  list(APPEND exported tremie_fits)
endif()
foreach(target ${exported})
  string(REPLACE tremie_ "" name ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
endforeach()
install(TARGETS ${exported} EXPORT tremieTargets)
foreach(folder ${TREMIE_PUBLIC_FOLDERS})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tremie/${folder}
          FILES_MATCHING PATTERN *.hpp)
endforeach()

set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/tremie)
install(EXPORT tremieTargets NAMESPACE tremie:: DESTINATION ${config_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/tremieConfig.cmake.in ${PROJECT_BINARY_DIR}/tremieConfig.cmake
                              INSTALL_DESTINATION ${config_folder})
# Before 1.0 a minor version may change what is public.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tremieConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tremieConfig.cmake ${PROJECT_BINARY_DIR}/tremieConfigVersion.cmake
        DESTINATION ${config_folder})
