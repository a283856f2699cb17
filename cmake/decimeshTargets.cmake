# decimesh::decimesh and decimesh::static, in decimesh's own build tree and in an installed prefix alike. Whoever
# includes this has set, with the prefix decimesh_: include_directory, shared_library, soname, static_library,
# system_libraries.

add_library(decimesh::decimesh SHARED IMPORTED)
set_target_properties(decimesh::decimesh PROPERTIES
    IMPORTED_LOCATION "${decimesh_shared_library}"
    IMPORTED_SONAME "${decimesh_soname}"
    INTERFACE_INCLUDE_DIRECTORIES "${decimesh_include_directory}")

add_library(decimesh::static STATIC IMPORTED)
set_target_properties(decimesh::static PROPERTIES
    IMPORTED_LOCATION "${decimesh_static_library}"
    INTERFACE_INCLUDE_DIRECTORIES "${decimesh_include_directory}"
    INTERFACE_LINK_LIBRARIES "${decimesh_system_libraries}")
