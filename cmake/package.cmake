# A Debian package of the program and its mixes: cpack in the build folder of the preset package, which compiles for
# any x86-64 processor.
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION share/doc/tremie RENAME copyright)
execute_process(COMMAND gzip -9nc ${PROJECT_SOURCE_DIR}/CHANGELOG.md OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz)
install(FILES ${PROJECT_BINARY_DIR}/changelog.gz DESTINATION share/doc/tremie)

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
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS gnuplot-nox)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
                                                WORLD_READ WORLD_EXECUTE)
include(CPack)
