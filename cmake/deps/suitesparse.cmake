# SuiteSparse's CHOLMOD with METIS. Debian ships no CMake config for it.
if(NOT TARGET SuiteSparse::cholmod)
    find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
    find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
    find_library(SUITESPARSE_CONFIG_LIBRARY suitesparseconfig REQUIRED)
    add_library(SuiteSparse::cholmod INTERFACE IMPORTED)
    target_include_directories(SuiteSparse::cholmod INTERFACE "${CHOLMOD_INCLUDE_DIR}")
    target_link_libraries(SuiteSparse::cholmod INTERFACE "${CHOLMOD_LIBRARY}" "${SUITESPARSE_CONFIG_LIBRARY}")
endif()
