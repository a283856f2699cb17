# The libraries, made by cargo. Afterwards they lie in ${decimesh_stage}, the shared one under its versioned name
# with the usual links; `decimesh-shared` and `decimesh-static` are the targets that see to it.

find_program(DECIMESH_CARGO cargo HINTS "$ENV{CARGO_HOME}/bin" "$ENV{HOME}/.cargo/bin"
    DOC "cargo, which builds decimesh" REQUIRED)
cmake_path(GET DECIMESH_CARGO PARENT_PATH cargo_directory)
find_program(DECIMESH_RUSTC rustc HINTS "${cargo_directory}" DOC "cargo's rustc" REQUIRED)

set(DECIMESH_CARGO_PROFILE "" CACHE STRING "Cargo profile; if empty, dev for Debug and release for everything else")
set(DECIMESH_CARGO_TARGET_DIR "${CMAKE_CURRENT_BINARY_DIR}/cargo" CACHE PATH "Where cargo keeps what it builds")

if(DECIMESH_CARGO_PROFILE)
    set(decimesh_debug_profile "${DECIMESH_CARGO_PROFILE}")
    set(decimesh_default_profile "${DECIMESH_CARGO_PROFILE}")
else()
    set(decimesh_debug_profile dev)
    set(decimesh_default_profile release)
endif()
set(profile "$<IF:$<CONFIG:Debug>,${decimesh_debug_profile},${decimesh_default_profile}>")
set(decimesh_stage "${CMAKE_CURRENT_BINARY_DIR}/lib/${profile}")
# Cargo's directory for the profile `dev` has another name.
set(cargo_output "${DECIMESH_CARGO_TARGET_DIR}/$<IF:$<STREQUAL:${profile},dev>,debug,${profile}>")

set(shared_plain "libdecimesh${CMAKE_SHARED_LIBRARY_SUFFIX}")
if(APPLE)
    set(shared_major "libdecimesh.${PROJECT_VERSION_MAJOR}.dylib")
    set(shared_full "libdecimesh.${PROJECT_VERSION}.dylib")
    set(decimesh_soname "@rpath/${shared_major}")
else()
    set(shared_major "libdecimesh.so.${PROJECT_VERSION_MAJOR}")
    set(shared_full "libdecimesh.so.${PROJECT_VERSION}")
    set(decimesh_soname "${shared_major}")
endif()

# A project that only uses decimesh builds what it links to; one that installs it builds everything.
if(DECIMESH_INSTALL)
    set(all ALL)
else()
    set(all "")
endif()

# Cargo is asked on every build, since it alone knows what its result depends on. A library that is the same as
# before is left alone, so that nothing is linked anew.
add_custom_target(decimesh-shared ${all}
    COMMAND "${DECIMESH_CARGO}" build --locked --lib --package decimesh --profile "${profile}"
        --manifest-path "${PROJECT_SOURCE_DIR}/Cargo.toml" --target-dir "${DECIMESH_CARGO_TARGET_DIR}"
    COMMAND "${CMAKE_COMMAND}" -E make_directory "${decimesh_stage}"
    COMMAND "${CMAKE_COMMAND}" -E copy_if_different "${cargo_output}/${shared_plain}" "${decimesh_stage}/${shared_full}"
    COMMAND "${CMAKE_COMMAND}" -E create_symlink "${shared_full}" "${decimesh_stage}/${shared_major}"
    COMMAND "${CMAKE_COMMAND}" -E create_symlink "${shared_major}" "${decimesh_stage}/${shared_plain}"
    BYPRODUCTS "${cargo_output}/libdecimesh.a" "${decimesh_stage}/${shared_full}"
    COMMENT "Building decimesh with cargo"
    USES_TERMINAL VERBATIM)

# Cargo's archive holds all of Rust's standard library under global names, and two such archives of different
# compilers cannot be linked into one program. So what the interface needs is linked into one object, in which
# nothing but the interface is global. Without GNU's tools the archive stays as it is.
execute_process(COMMAND "${CMAKE_LINKER}" --version OUTPUT_VARIABLE linker_version ERROR_QUIET)
if(CMAKE_OBJCOPY AND linker_version MATCHES "^GNU ld")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS abi/symbols.txt)
    file(STRINGS abi/symbols.txt roots)
    list(TRANSFORM roots PREPEND "--undefined=")
    set(object "${decimesh_stage}/decimesh.o")
    # --strip-unneeded takes along the debug information (without it, the archive has a twentieth of the size) and
    # the names that only dropped sections used, which objcopy would turn from weak to required. The embedded LLVM
    # bitcode, run together by the linker, would bring down tools that have LLVM's plugin.
    set(make_archive
        COMMAND "${CMAKE_LINKER}" -r --gc-sections --force-group-allocation ${roots}
            "${cargo_output}/libdecimesh.a" -o "${object}"
        COMMAND "${CMAKE_OBJCOPY}" --wildcard "--keep-global-symbol=decimesh_*" --strip-unneeded
            --remove-section=.llvmbc --remove-section=.llvmcmd "${object}"
        COMMAND "${CMAKE_COMMAND}" -E rm -f "${decimesh_stage}/libdecimesh.a"
        COMMAND "${CMAKE_AR}" qcs "${decimesh_stage}/libdecimesh.a" "${object}"
        COMMAND "${CMAKE_COMMAND}" -E rm "${object}")
else()
    message(STATUS "decimesh: no GNU ld and objcopy; the static library keeps the names of Rust's standard library")
    set(make_archive
        COMMAND "${CMAKE_COMMAND}" -E copy "${cargo_output}/libdecimesh.a" "${decimesh_stage}/libdecimesh.a")
endif()
add_custom_command(OUTPUT "${decimesh_stage}/libdecimesh.a"
    ${make_archive}
    DEPENDS "${cargo_output}/libdecimesh.a" abi/symbols.txt
    COMMENT "Building decimesh's static library" VERBATIM)
add_custom_target(decimesh-static ${all} DEPENDS "${decimesh_stage}/libdecimesh.a")
add_dependencies(decimesh-static decimesh-shared)

# What the static library needs of the system, as the compiler says. The driver that links C adds libgcc and libc by
# itself, and knows their static names.
set(probe "${CMAKE_CURRENT_BINARY_DIR}/native_libraries")
file(WRITE "${probe}.rs" "")
execute_process(
    COMMAND "${DECIMESH_RUSTC}" --crate-type staticlib --print native-static-libs -o "${probe}.a" "${probe}.rs"
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}" ERROR_VARIABLE probed COMMAND_ERROR_IS_FATAL ANY)
file(REMOVE "${probe}.rs" "${probe}.a")
string(REGEX MATCH "native-static-libs: ([^\n]*)" probed "${probed}")
separate_arguments(decimesh_system_libraries UNIX_COMMAND "${CMAKE_MATCH_1}")
list(REMOVE_ITEM decimesh_system_libraries -lgcc_s -lc)
