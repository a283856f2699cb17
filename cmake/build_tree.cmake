# The targets for decimesh's own tests and for projects that add this directory: the same as an installed prefix has.

set(stages "${CMAKE_CURRENT_BINARY_DIR}/lib")
set(decimesh_include_directory "${PROJECT_SOURCE_DIR}/include")
set(decimesh_shared_library "${stages}/${decimesh_default_profile}/${shared_full}")
set(decimesh_static_library "${stages}/${decimesh_default_profile}/libdecimesh.a")
include(cmake/decimeshTargets.cmake)

set_target_properties(decimesh::decimesh PROPERTIES
    IMPORTED_GLOBAL TRUE
    IMPORTED_LOCATION_DEBUG "${stages}/${decimesh_debug_profile}/${shared_full}"
    IMPORTED_SONAME_DEBUG "${decimesh_soname}")
set_target_properties(decimesh::static PROPERTIES
    IMPORTED_GLOBAL TRUE
    IMPORTED_LOCATION_DEBUG "${stages}/${decimesh_debug_profile}/libdecimesh.a")
add_dependencies(decimesh::decimesh decimesh-shared)
add_dependencies(decimesh::static decimesh-static)
