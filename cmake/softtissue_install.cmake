# Install rules: headers, the CMake package, the pkg-config file. All of it independent of the architecture.
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(softtissue_package_dir "${CMAKE_INSTALL_DATADIR}/cmake/softtissue")
set(softtissue_pkgconfig_dir "${CMAKE_INSTALL_DATADIR}/pkgconfig")
file(RELATIVE_PATH softtissue_prefix_from_pkgconfig
     "/${softtissue_pkgconfig_dir}" "/")
string(REGEX REPLACE "/$" "" softtissue_prefix_from_pkgconfig "${softtissue_prefix_from_pkgconfig}")

install(TARGETS softtissue EXPORT softtissue_targets
    FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}"
    FILE_SET optional DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}")
install(EXPORT softtissue_targets NAMESPACE softtissue:: FILE softtissueTargets.cmake
    DESTINATION "${softtissue_package_dir}")

configure_package_config_file(cmake/softtissueConfig.cmake.in softtissueConfig.cmake
    INSTALL_DESTINATION "${softtissue_package_dir}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(softtissueConfigVersion.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES
    "${PROJECT_BINARY_DIR}/softtissueConfig.cmake"
    "${PROJECT_BINARY_DIR}/softtissueConfigVersion.cmake"
    "${PROJECT_SOURCE_DIR}/cmake/softtissue_components.cmake"
    DESTINATION "${softtissue_package_dir}")

configure_file(cmake/softtissue.pc.in softtissue.pc @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/softtissue.pc" DESTINATION "${softtissue_pkgconfig_dir}")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DATADIR}/doc/libsofttissue-dev" RENAME copyright)

# A Debian package: cpack --config <build>/CPackConfig.cmake. Not for those who only include this project.
if(PROJECT_IS_TOP_LEVEL)
    set(CPACK_GENERATOR DEB)
    set(CPACK_PACKAGE_NAME libsofttissue-dev)
    set(CPACK_PACKAGE_CONTACT "the authors of softtissue <softtissue@localhost>")
    set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
    set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
    set(CPACK_VERBATIM_VARIABLES TRUE)
    set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
    set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE all)
    set(CPACK_DEBIAN_PACKAGE_SECTION libdevel)
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4)")
    # What the optional components look for; see softtissue_components.cmake.
    set(packages "")
    foreach(component IN LISTS softtissue_COMPONENTS)
        foreach(row IN LISTS softtissue_${component}_LIBRARIES)
            string(REGEX REPLACE "^.*[|]" "" package "${row}")
            list(APPEND packages "${package}")
        endforeach()
    endforeach()
    list(JOIN packages ", " CPACK_DEBIAN_PACKAGE_SUGGESTS)
    include(CPack)
endif()
