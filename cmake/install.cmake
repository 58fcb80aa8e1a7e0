# Installs the CMake package, the pkg-config file, GLSL and WGSL, and the license. See docs/install.md.
if(NOT LACEDRING_INSTALL)
    return()
endif()
include(CMakePackageConfigHelpers)
get_property(io_packages GLOBAL PROPERTY lacedring_io_packages)  # dependencies of lacedring::io
string(REPLACE ";" " " io_packages "${io_packages}")
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/lacedring-config.cmake.in
                              ${PROJECT_BINARY_DIR}/cmake/lacedring-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lacedring
                              PATH_VARS CMAKE_INSTALL_DATADIR CMAKE_INSTALL_INCLUDEDIR)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/cmake/lacedring-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cmake/lacedring-config.cmake ${PROJECT_BINARY_DIR}/cmake/lacedring-config-version.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/lacedring)
file(RELATIVE_PATH to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/lacedring.pc.in ${PROJECT_BINARY_DIR}/cmake/lacedring.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/cmake/lacedring.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
# GLSL and WGSL that decode streams, to include in other programs' shaders: glslangValidator -I${lacedring_GLSL_DIR}.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/shaders/include/ DESTINATION ${CMAKE_INSTALL_DATADIR}/lacedring)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
