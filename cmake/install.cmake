# What goes to an installed prefix. No file of it knows where the prefix is, so that it can be moved.
#
# Components: `runtime` (what a linked program needs), `development` (headers, package files, the link the linker
# looks for), `static`.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/decimesh")
set(generated "${CMAKE_CURRENT_BINARY_DIR}/package")

install(FILES "${decimesh_stage}/${shared_full}" "${decimesh_stage}/${shared_major}"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT runtime)
install(FILES "${decimesh_stage}/${shared_plain}" DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT development)
install(FILES "${decimesh_stage}/libdecimesh.a" DESTINATION "${CMAKE_INSTALL_LIBDIR}" COMPONENT static)
install(FILES include/decimesh.h include/decimesh.hpp
    DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}" COMPONENT development)
install(FILES LICENSE-MIT LICENSE-APACHE DESTINATION "${CMAKE_INSTALL_DOCDIR}" COMPONENT runtime)

configure_package_config_file(cmake/decimeshConfig.cmake.in "${generated}/decimeshConfig.cmake"
    INSTALL_DESTINATION "${package_directory}"
    PATH_VARS CMAKE_INSTALL_INCLUDEDIR CMAKE_INSTALL_LIBDIR)
# As for the loader, the major version is the ABI's.
write_basic_package_version_file("${generated}/decimeshConfigVersion.cmake" COMPATIBILITY SameMajorVersion)
install(FILES "${generated}/decimeshConfig.cmake" "${generated}/decimeshConfigVersion.cmake"
    cmake/decimeshTargets.cmake
    DESTINATION "${package_directory}" COMPONENT development)

# pkg-config knows where the .pc file lies, and from there the rest is found.
file(RELATIVE_PATH pc_to_prefix "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
file(RELATIVE_PATH pc_to_include "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
list(JOIN decimesh_system_libraries " " pc_system_libraries)
configure_file(cmake/decimesh.pc.in "${generated}/decimesh.pc" @ONLY)
install(FILES "${generated}/decimesh.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig" COMPONENT development)
