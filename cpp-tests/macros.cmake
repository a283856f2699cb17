# Fails if including decimesh.hpp defines a macro that its own includes do not: only its guard may.
# Run as: cmake -DCOMPILER=c++ -DINCLUDE=dir -DWORK=dir -P macros.cmake

file(READ "${INCLUDE}/decimesh.hpp" wrapper)
string(REGEX MATCHALL "#include [<\"][^>\"]+[>\"]" includes "${wrapper}")
list(JOIN includes "\n" includes)
file(WRITE "${WORK}/without.cpp" "${includes}\n")
file(WRITE "${WORK}/with.cpp" "${includes}\n#include \"decimesh.hpp\"\n")

foreach(kind without with)
    execute_process(
        COMMAND "${COMPILER}" -std=c++17 -dM -E "-I${INCLUDE}" "${WORK}/${kind}.cpp"
        OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
    # A semicolon would be taken for the end of a list's item.
    string(REPLACE ";" " " output "${output}")
    string(REPLACE "\n" ";" ${kind} "${output}")
endforeach()
list(REMOVE_ITEM with ${without})
list(REMOVE_ITEM with "")
list(TRANSFORM with STRIP)
if(NOT with STREQUAL "#define DECIMESH_HPP")
    message(FATAL_ERROR "decimesh.hpp defines: ${with}")
endif()
