# A program outside the tree is built against the installed package.
#
#   cmake -D BUILD=<build folder> -D CONFIGURATION=Release -D GENERATOR=Ninja -D COMPILER=<c++> <step> -P check.cmake
#
#   -D INSTALL=ON                        installs the build into BUILD/consumer/prefix
#   -D NAME=<name> -D SCENE=<scene>      builds main.cpp and runs it on the first frames of a scene
#   -D NAME=<name> -D PAGE=<page.md>     builds the page's first ```cpp block, which must be a complete program

set(prefix "${BUILD}/consumer/prefix")
set(work "${BUILD}/consumer/${NAME}")

# Writes the page's first block of C++ to `file`.
function(write_example page file)
    file(READ "${page}" text)
    string(FIND "${text}" "\n```cpp\n" begin)
    if(begin EQUAL -1)
        message(FATAL_ERROR "${page} has no block that begins with ```cpp; this test compiles its first one")
    endif()
    math(EXPR begin "${begin} + 8")
    string(SUBSTRING "${text}" ${begin} -1 text)
    string(FIND "${text}" "\n```" length)
    if(length EQUAL -1)
        message(FATAL_ERROR "${page}: its block of C++ is not closed by ```")
    endif()
    string(SUBSTRING "${text}" 0 ${length} text)
    if(NOT text MATCHES "#include \"toile.h\"" OR NOT text MATCHES "int main\\(")
        message(FATAL_ERROR "${page}: its first block of C++ is no program with #include \"toile.h\" and main()")
    endif()
    file(WRITE "${file}" "${text}\n")
endfunction()

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

if(INSTALL)
    # Headers that are no longer installed must not be found.
    file(REMOVE_RECURSE "${prefix}")
    run("${CMAKE_COMMAND}" --install "${BUILD}" --config "${CONFIGURATION}" --prefix "${prefix}")
    return()
endif()

set(program "${CMAKE_CURRENT_LIST_DIR}/main.cpp")
if(PAGE)
    set(program "${work}/${NAME}.cpp")
    write_example("${PAGE}" "${program}")
endif()
run("${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}" -B "${work}" -G "${GENERATOR}" -D "PROGRAM=${program}"
    -D "CMAKE_CXX_COMPILER=${COMPILER}" -D "CMAKE_BUILD_TYPE=${CONFIGURATION}" -D "CMAKE_PREFIX_PATH=${prefix}"
    -D "CMAKE_RUNTIME_OUTPUT_DIRECTORY=${work}/$<1:bin>") # the same folder for every configuration
run("${CMAKE_COMMAND}" --build "${work}" --config "${CONFIGURATION}")
if(SCENE)
    # Tables of an earlier run are neither read nor kept.
    run("${CMAKE_COMMAND}" -E env TOILE_CACHE_DIR= "${work}/bin/consumer" "${SCENE}" WORKING_DIRECTORY "${work}")
endif()
